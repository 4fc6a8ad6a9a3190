// Small systems with known solutions, in the shape that solve/ integrates.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/solve/iterate.hpp"

namespace wingbeat::solver {

/// What a test system needs besides its rates; members are hidden by those of the system where they differ.
template <class S, std::size_t states, std::size_t integrals = 1, std::size_t switch_count = 1>
struct TestSystem {
  using Real = S;
  using State = std::array<S, states>;
  using Quadrature = std::array<S, integrals>;
  using Switches = std::array<S, switch_count>;
  using Signs = std::array<S, switch_count>;
  static constexpr int state_switches = int(switch_count);
  static constexpr std::array<std::size_t, 1> controlled_integrals = {0};

  static double period() { return two_pi; }
  static const std::array<FixedNode, 0>& fixed_nodes() {
    static constexpr std::array<FixedNode, 0> none = {};
    return none;
  }
  static Signs start_signs() {
    Signs signs;
    signs.fill(S(1.0));
    return signs;
  }
  bool admissible(const State&) const { return true; }
  State error_scale(const State&) const {
    State scale;
    scale.fill(S(1.0));
    return scale;
  }
};

/// x'' + c x' + k x = cos t: everything about it is known.
template <class S>
struct LinearOscillator : TestSystem<S, 2> {
  using Base = TestSystem<S, 2>;
  double damping = 0.5;
  double stiffness = 2.0;
  double scale = 1.0;

  LinearOscillator() = default;
  LinearOscillator(double c, double k, double size = 1.0) : damping(c), stiffness(k), scale(size) {}
  template <class T>
  LinearOscillator<T> cast() const {
    return {damping, stiffness, scale};
  }
  typename Base::State error_scale(const typename Base::State&) const { return {S(scale), S(scale)}; }

  /// Amplitudes of cos t and sin t in the steady state.
  double cosine() const {
    const double detuning = stiffness - 1.0;
    return detuning / (detuning * detuning + damping * damping);
  }
  double sine() const {
    const double detuning = stiffness - 1.0;
    return damping / (detuning * detuning + damping * damping);
  }

  template <bool quadratures>
  Rates<LinearOscillator> rates(const S& t, const typename Base::State& y, const typename Base::Signs&) const {
    using std::cos;
    Rates<LinearOscillator> r;
    r.dy = {y[1], cos(t) - damping * y[1] - stiffness * y[0]};
    r.switches = {S(1.0)};
    if constexpr (quadratures) r.dq = {damping * y[1] * y[1]};
    return r;
  }
};

/// Two bodies: x'' = -x / |x|^3, period 2 pi for a start() of any eccentricity.
template <class S>
struct Kepler : TestSystem<S, 4, 3> {
  using Base = TestSystem<S, 4, 3>;
  static typename Base::State start(double e) { return {1.0 - e, 0.0, 0.0, std::sqrt((1.0 + e) / (1.0 - e))}; }
  /// Half a revolution later.
  static typename Base::State opposite(double e) { return {-1.0 - e, 0.0, 0.0, -std::sqrt((1.0 - e) / (1.0 + e))}; }

  template <bool quadratures>
  Rates<Kepler> rates(const S&, const typename Base::State& y, const typename Base::Signs&) const {
    using std::sqrt;
    const S r2 = y[0] * y[0] + y[1] * y[1];
    const S per_r = S(1.0) / sqrt(r2);
    Rates<Kepler> rates;
    const S attraction = -per_r / r2;
    rates.dy = {y[2], y[3], attraction * y[0], attraction * y[1]};
    rates.switches = {S(1.0)};
    // Integrals over half a revolution: pi, pi / sqrt(1 - e^2), pi (1/2 + 2 e^2).
    if constexpr (quadratures) rates.dq = {per_r, per_r * per_r, y[0] * y[0]};
    return rates;
  }
};

/// x' = -rate (x - cos t) - sin t: follows cos t, however stiff.
template <class S>
struct StiffFollower : TestSystem<S, 1> {
  using Base = TestSystem<S, 1>;
  double rate = 1e6;

  explicit StiffFollower(double lambda) : rate(lambda) {}
  template <class T>
  StiffFollower<T> cast() const {
    return StiffFollower<T>(rate);
  }
  template <bool quadratures>
  Rates<StiffFollower> rates(const S& t, const typename Base::State& y, const typename Base::Signs&) const {
    using std::cos;
    using std::sin;
    Rates<StiffFollower> r;
    r.dy = {-rate * (y[0] - cos(t)) - sin(t)};
    r.switches = {S(1.0)};
    if constexpr (quadratures) r.dq = {y[0] * y[0]};
    return r;
  }
};

/// x'' + c x' + k x = a cos t with another stiffness for x < 0; the integral is that of |x|.
template <class S>
struct BilinearOscillator : TestSystem<S, 2> {
  using Base = TestSystem<S, 2>;
  double damping = 0.0, above = 1.0, below = 4.0, drive = 0.0, length = two_pi;
  long* calls = nullptr;  ///< counts evaluations where given

  template <class T>
  BilinearOscillator<T> cast() const {
    BilinearOscillator<T> other;
    other.damping = damping;
    other.above = above;
    other.below = below;
    other.drive = drive;
    other.length = length;
    return other;
  }
  double period() const { return length; }

  template <bool quadratures>
  Rates<BilinearOscillator> rates(const S& t, const typename Base::State& y, const typename Base::Signs& sign) const {
    using std::cos;
    if (calls) ++*calls;
    const S k = select(sign[0] > S(0.0), S(above), S(below));
    Rates<BilinearOscillator> r;
    r.dy = {y[1], drive * cos(t) - damping * y[1] - k * y[0]};
    r.switches = {y[0]};
    if constexpr (quadratures) r.dq = {sign[0] * y[0]};
    return r;
  }
};

/// x'' + c x' + x + x^3 = a cos t.
template <class S>
struct Duffing : TestSystem<S, 2> {
  using Base = TestSystem<S, 2>;
  double damping = 0.5, drive = 0.8;

  template <class T>
  Duffing<T> cast() const {
    Duffing<T> other;
    other.damping = damping;
    other.drive = drive;
    return other;
  }
  template <bool quadratures>
  Rates<Duffing> rates(const S& t, const typename Base::State& y, const typename Base::Signs&) const {
    using std::cos;
    Rates<Duffing> r;
    r.dy = {y[1], drive * cos(t) - damping * y[1] - y[0] - y[0] * y[0] * y[0]};
    r.switches = {S(1.0)};
    if constexpr (quadratures) r.dq = {damping * y[1] * y[1]};
    return r;
  }
};

/// y' = |s(t)| with s = (t - centre)^2 - half_width^2: leaves its branch twice, at known places.
template <class S>
struct DoubleCrossing : TestSystem<S, 1> {
  using Base = TestSystem<S, 1>;
  double centre, half_width;

  DoubleCrossing(double advance, double half) : centre(advance), half_width(half) {}
  template <class T>
  DoubleCrossing<T> cast() const {
    return DoubleCrossing<T>(centre, half_width);
  }
  double exact() const {
    const auto primitive = [&](double t) {
      const double u = t - centre;
      return u * u * u / 3.0 - half_width * half_width * u;
    };
    return primitive(two_pi) - primitive(0.0) + 8.0 / 3.0 * std::pow(half_width, 3);
  }
  template <bool quadratures>
  Rates<DoubleCrossing> rates(const S& t, const typename Base::State&, const typename Base::Signs& sign) const {
    const S u = t - centre;
    const S s = u * u - half_width * half_width;
    Rates<DoubleCrossing> r;
    r.dy = {sign[0] * s};
    r.switches = {s};
    if constexpr (quadratures) r.dq = {sign[0] * s};
    return r;
  }
};

/// y' = |sin t|, its branch changing at a node known in advance.
template <class S>
struct FixedNodeSystem : TestSystem<S, 1> {
  using Base = TestSystem<S, 1>;
  using Signs = std::array<S, 2>;  ///< of the switch, of sin t
  static const std::array<FixedNode, 1>& fixed_nodes() {
    static constexpr std::array<FixedNode, 1> nodes = {{{pi, 1}}};
    return nodes;
  }
  static Signs start_signs() { return {S(1.0), S(1.0)}; }
  template <bool quadratures>
  Rates<FixedNodeSystem> rates(const S& t, const typename Base::State&, const Signs& sign) const {
    using std::sin;
    Rates<FixedNodeSystem> r;
    r.dy = {sign[1] * sin(t)};
    r.switches = {S(1.0)};
    if constexpr (quadratures) r.dq = {sign[1] * sin(t)};
    return r;
  }
};

}  // namespace wingbeat::solver
