// Where the search for a direct drive's steady flapping starts, and what it means that it finds none: model.md sections
// 6, 12; docs/direct-drive.md.
#pragma once

#include <cmath>
#include <complex>

#include "cycle/flapping_search.hpp"
#include "wingbeat/cycle/direct_balance.hpp"

namespace wingbeat::detail {

template <class System_>
class DirectSearch {
 public:
  using System = System_;
  using State = typename System::State;
  static constexpr long part = pitching_search_work / 8;

  explicit DirectSearch(const Vehicle<double>& vehicle)
      : vehicle_(vehicle), balance_(direct_balance(vehicle)), w_(two_pi * vehicle.drive_frequency) {}

  bool stalls(SteadyFlapping& result) const { return detail::stalls(vehicle_, balance_, result); }

  System system() const {
    // Constant friction that a harmonic motion cannot overcome leaves short slips: their size, from what is left of the
    // drive.
    const double inertia = vehicle_.motor.inertia + vehicle_.wing_count * vehicle_.wing_inertia;
    const double slip_speed = (balance_.drive_torque - balance_.breakaway_torque) / (inertia * w_);
    const double speed = balance_.responses.empty() ? slip_speed : std::abs(balance_.responses.back().speed);
    Coordinates<double> typical{speed / w_, speed, typical_current(vehicle_, balance_)};
    if constexpr (System::on_hinges) {
      add_typical_wings(vehicle_, speed, w_, typical);
      typical.angle += 1e-12, typical.speed += 1e-9, typical.current += 1e-12;
    }
    if constexpr (System::general) {
      typical.tip = typical.angle / vehicle_.piezo.transmission_ratio;
      typical.tip_velocity = w_ * typical.tip;
    }
    return {vehicle_, detail::sizes_of_states<System>(vehicle_, typical)};
  }

  void search(StableOrbits<System>& orbits) const {
    const bool responds = !balance_.responses.empty();
    if constexpr (System::on_hinges) {
      // Where the pitching is lightly damped, the return map does not forget its start, and several responses may be
      // stable.
      orbits.attempt(at_rest(), part);
      const bool hinged = is_hinged(vehicle_);
      for (const double psi : {0.25 * pi, 0.5 * pi}) {
        if (responds && hinged) orbits.attempt(harmonic(psi), part);
      }
      if (responds && !hinged) orbits.attempt(harmonic(0.0), part);
      if (orbits.empty() && orbits.unfinished()) orbits.attempt(*orbits.unfinished());
      orbits.attempt_mirror_image();
    } else {
      if (responds) orbits.attempt(harmonic(0.0));
      if (orbits.empty() && !std::isfinite(orbits.unstable_multiplier())) orbits.attempt(at_rest());
    }
  }

  bool in_doubt(const StableOrbits<System>&) const { return !System::on_hinges && balance_.responses.size() > 1; }

  void explain(const StableOrbits<System>& orbits, SteadyFlapping& result) const {
    using Evidence = StatusEvidence::Kind;
    result.status = FlappingStatus::undecided;
    if (std::isfinite(orbits.unstable_multiplier())) {
      result.evidence = {.kind = Evidence::unstable_response, .multiplier = orbits.unstable_multiplier()};
    } else {
      result.evidence = {.kind = Evidence::no_response, .search = orbits.last().status};
    }
  }

  StatusEvidence evidence(const Metrics<double>& metrics, const Metrics<double>* other, bool) const {
    return {.kind = StatusEvidence::Kind::response,
            .frequency = vehicle_.drive_frequency,
            .stroke_amplitude = metrics[Metric::stroke_amplitude],
            .other_amplitude = other ? (*other)[Metric::stroke_amplitude] : absent};
  }

 private:
  State at_rest() const {
    State y{};
    y[0] = vehicle_.spring.rest_angle;
    return y;
  }
  /// Wings that swing as harmonic balance says and pitch by `amplitude` [rad] against their velocity.
  State harmonic(double amplitude) const {
    const HarmonicResponse& r = balance_.responses.front();
    const std::complex<double> psi = -amplitude * r.speed / std::abs(r.speed);
    const std::complex<double> psi_rate = std::complex<double>(0.0, w_) * psi;
    return System::state_of(
        {vehicle_.spring.rest_angle + r.stroke.imag(), r.speed.imag(), r.current.imag(), psi.imag(), psi_rate.imag()},
        vehicle_);
  }

  const Vehicle<double>& vehicle_;
  DirectBalance balance_;
  double w_;
};

}  // namespace wingbeat::detail
