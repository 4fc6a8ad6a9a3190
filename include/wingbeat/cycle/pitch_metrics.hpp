// How the wings pitch over a recorded cycle, under either drive (model.md section 12).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/cycle/pitch_stops.hpp"
#include "wingbeat/solve/iterate.hpp"

namespace wingbeat {

/// Wings that pitch by less, to either side of where they stand, stand still but for rounding and what limits of the
/// solvers leave: there is no phase of that [rad].
inline constexpr double still_pitch = 1e-4;

inline constexpr double notable_over_rotation = 0.1;  ///< of the period; some of it lies about every reversal

struct PitchMetrics {
  double amplitude;  ///< half of psi from peak to peak [rad]
  /// Of the first harmonics in time, by how much pitching is ahead of the pitch that opposes the stroke velocity [rad],
  /// -pi to pi: 0 where wings flip symmetrically about the reversal, positive where they flip early (advanced).
  double phase;
  double angle_of_attack_min, angle_of_attack_max;  ///< [rad]; beyond pi/2 the wing over-rotates, its lift is negative
  double hinge_power;                               ///< mean loss in damping and stops of all hinges [W]
  double over_rotation;    ///< share of the period with alpha beyond pi/2 by more than still_pitch, roughly [1]
  double chordwise = 0.0;  ///< mean of chordwise_lift() [N]

  bool stands_still() const { return !(amplitude > still_pitch); }
  /// over_rotation of wings that rotate.
  double over_rotation_of_moving() const { return stands_still() ? 0.0 : over_rotation; }
};

/// Part of a mean lift [N] that the added mass gives, where there is some, `chordwise` being the mean of
/// chordwise_lift() [N]: normal to the chord it gives as much, along it the share that counts takes away (model.md
/// section 12).
/// \f[
/// \frac{(1 - s_\mathrm{L})\, \overline{p_\mathrm{n} \dot\psi \cos\psi}}{\overline{L}}
/// \f]
template <Scalar S>
S added_mass_share(const PitchingWings<S>& p, const S& chordwise, const S& lift) {
  return value_of(p.air.rr) > 0.0 ? S((S(1.0) - p.edge_suction) * chordwise / lift) : S(absent);
}

/// What the metrics of a vehicle with the wings `p` are under the pitch law and, of wings that pitch, are not.
inline void set_pitch_metrics(const PitchMetrics& pitching, const PitchingWings<double>& p, Metrics<double>& m) {
  m[Metric::angle_of_attack_min] = degrees_per_radian * pitching.angle_of_attack_min;
  m[Metric::angle_of_attack_max] = degrees_per_radian * pitching.angle_of_attack_max;
  m[Metric::pitch_amplitude] = degrees_per_radian * pitching.amplitude;
  m[Metric::pitch_phase] = pitching.stands_still() ? absent : degrees_per_radian * pitching.phase;
  m[Metric::power_hinge] = pitching.hinge_power;
  m[Metric::lift_added_mass_share] =
      pitching.stands_still() ? absent : added_mass_share(p, pitching.chordwise, m[Metric::lift_mean]);
}

namespace detail {

/// Gauss's rule of five points on -1 to 1.
inline constexpr std::array gauss_nodes = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                           0.9061798459386640};
inline constexpr std::array gauss_weights = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                             0.4786286704993665, 0.2369268850561891};

/// psi [rad] at the start of step n of a cycle, at its end where there is no step n. Where steps meet at a reversal of
/// a stroke whose velocity is a state, at the reversal itself: switches are located to the square root of the
/// tolerance, which is enough for the solution, but the angle of attack jumps there.
template <class System>
double pitch_at_start(const solver::Iterate<System>& cycle, std::size_t n) {
  if (n == cycle.steps.size()) return System::local_pitch(cycle.end);
  const auto& step = cycle.steps[n];
  if constexpr (!System::turns) {
    if (n > 0 && step.signs[System::velocity] != cycle.steps[n - 1].signs[System::velocity] &&
        step.y[System::shaft] != 0.0) {
      const auto& dy = step.first.dy;
      return System::local_pitch(step.y) - System::local_pitch(dy) * step.y[System::shaft] / dy[System::shaft];
    }
  }
  return System::local_pitch(step.y);
}

/// The polynomial of degree 5 through values and slopes at the ends and in the middle of a step, at gauss_nodes.
struct NodeWeights {
  std::array<std::array<double, 3>, gauss_nodes.size()> value, slope;  ///< slopes are those times the step's length
};
constexpr NodeWeights node_weights() {
  NodeWeights w{};
  for (std::size_t k = 0; k < gauss_nodes.size(); ++k) {
    const double u = 0.5 * (1.0 + gauss_nodes[k]);
    const double lagrange[] = {2.0 * (u - 0.5) * (u - 1.0), -4.0 * u * (u - 1.0), 2.0 * u * (u - 0.5)};
    constexpr double place[] = {0.0, 0.5, 1.0}, lagrange_slope[] = {-3.0, 0.0, 3.0};
    for (std::size_t n = 0; n < 3; ++n) {
      const double square = lagrange[n] * lagrange[n], from = u - place[n];
      w.value[k][n] = (1.0 - 2.0 * lagrange_slope[n] * from) * square;
      w.slope[k][n] = from * square;
    }
  }
  return w;
}

/// A number with its slope by the independent variable.
struct Sloped {
  double value, slope;
};
struct PitchPoint {
  Sloped time;  ///< since the step's start [s]
  Sloped pace;  ///< slope of the time
  Sloped pitch, stroke;
};
template <class System>
PitchPoint pitch_point(const System& system, double x, double time, const typename System::State& y,
                       const typename System::State& dy) {
  const double pace = 1.0 / system.phase_rate(y);
  PitchPoint p{{time, pace}, {pace, 0.0}, {System::local_pitch(y), System::local_pitch(dy)}, {}};
  if constexpr (System::turns) p.pace.slope = -dy[System::shaft] * pace * pace;
  else p.stroke = {system.stroke_angle(x, y), dy[0]};
  return p;
}

/// Calls use(weight [s], time since the cycle's start [s], pitch, stroke angle, signs) at the nodes of Gauss's rule
/// over a cycle, between which and the steps' ends the solution is interpolated: its own values there would each take a
/// step.
template <class System, class Use>
void for_pitch_nodes(const System& system, const solver::Iterate<System>& cycle, const Use& use) {
  static constexpr NodeWeights weights = node_weights();
  double start = 0.0;
  for (std::size_t n = 0; n < cycle.steps.size(); ++n) {
    const auto& step = cycle.steps[n];
    const bool last = n + 1 == cycle.steps.size();
    const auto point = [&](double part) {
      const double x = step.x + part * step.h;
      double time = step.dq[std::size_t(Integral::time)];
      auto y = last ? cycle.end : cycle.steps[n + 1].y;
      // The next step begins elsewhere where the state jumps between them.
      const bool moved = solver::state_jumps<System>() && !last && cycle.steps[n + 1].signs != step.signs;
      if (part < 1.0 || moved) {
        const auto inside = solver::evaluate_inside<System::turns>(system, cycle, step, x);
        y = inside.y;
        if constexpr (System::turns) time = inside.dq[std::size_t(Integral::time)];
      }
      if constexpr (!System::turns) time = (x - step.x) / system.phase_rate();
      return pitch_point(system, x, time, y, system.template rates<false>(x, y, step.signs).dy);
    };
    const PitchPoint points[] = {pitch_point(system, step.x, 0.0, step.y, step.first.dy), point(0.5), point(1.0)};
    for (std::size_t k = 0; k < gauss_nodes.size(); ++k) {
      const auto at_node = [&](Sloped PitchPoint::* number) {
        double sum = 0.0;
        for (std::size_t p = 0; p < 3; ++p) {
          const Sloped& known = points[p].*number;
          sum += weights.value[k][p] * known.value + weights.slope[k][p] * step.h * known.slope;
        }
        return sum;
      };
      double stroke;
      if constexpr (System::turns) stroke = system.stroke_angle(step.x + 0.5 * (1.0 + gauss_nodes[k]) * step.h, step.y);
      else stroke = at_node(&PitchPoint::stroke);
      use(0.5 * step.h * gauss_weights[k] * at_node(&PitchPoint::pace), start + at_node(&PitchPoint::time),
          at_node(&PitchPoint::pitch), stroke, step.signs);
    }
    start += step.dq[std::size_t(Integral::time)];
  }
}

}  // namespace detail

/// Extremes are where the pitch velocity or the stroke velocity changes sign or a stop holds the wings, which is where
/// steps end.
template <class System>
PitchMetrics pitch_metrics(const System& system, const solver::Iterate<System>& cycle) {
  double lowest = infinity, highest = -infinity, period = 0.0;
  PitchMetrics m{0.0, 0.0, infinity, -infinity, 0.0, 0.0};
  for (std::size_t n = 0; n < cycle.steps.size(); ++n) {
    const auto& step = cycle.steps[n];
    for (const double psi : {detail::pitch_at_start(cycle, n), detail::pitch_at_start(cycle, n + 1)}) {
      lowest = std::min(lowest, psi);
      highest = std::max(highest, psi);
      const double alpha = 0.5 * pi + System::stroke_sign(step.signs) * psi;
      m.angle_of_attack_min = std::min(m.angle_of_attack_min, alpha);
      m.angle_of_attack_max = std::max(m.angle_of_attack_max, alpha);
    }
    period += step.dq[std::size_t(Integral::time)];
    m.hinge_power += step.dq[System::hinge_work];
    m.chordwise += step.dq[System::chordwise];
  }
  m.hinge_power /= period;
  m.chordwise /= period;
  m.amplitude = 0.5 * (highest - lowest);

  // Integrals of stroke and pitch times exp(-j w t).
  std::complex<double> stroke = 0.0, pitching = 0.0;
  detail::for_pitch_nodes(system, cycle, [&](double weight, double time, double psi, double beta, const auto& signs) {
    const auto weighted = std::polar(weight, -two_pi * time / period);
    if (system.stroke_sign(signs) * psi > still_pitch) m.over_rotation += std::abs(weighted);
    stroke += weighted * beta;
    pitching += weighted * psi;
  });
  m.over_rotation /= period;
  // The pitch that opposes the stroke velocity is along -j stroke.
  m.phase = std::arg(pitching / (std::complex<double>(0.0, -1.0) * stroke));
  return m;
}

}  // namespace wingbeat
