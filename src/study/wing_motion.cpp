#include "wingbeat/study/wing_motion.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/recorded_cycle.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

/// Loads of wings under the pitch law; `pitch` states another pitch than that of the law.
AirLoads loads_under_law(const Vehicle<double>& v, const AngleMotion& stroke, const AngleMotion* pitch) {
  const double side = sign_of(stroke.velocity), speed = std::abs(stroke.velocity);
  if (!pitch) {
    const AeroLoads<double> loads =
        aero_loads(v.wings, stroke.velocity, side, sign_of(pitch_margin(v.wings, speed)), 1.0, stroke.value);
    return {loads.lift, loads.moment + loads.added_inertia * stroke.acceleration};
  }
  BladeElement<double> held = v.wings;
  const double alpha = 0.5 * pi + side * pitch->value, alpha_rate = side * pitch->velocity;
  held.angle_of_attack_min = alpha;
  const AeroLoads<double> loads = aero_loads(held, stroke.velocity, side, -1.0, 1.0, stroke.value);
  // What the law has in its inertia is here the moment of an air that is turned out of the way (model.md section 10).
  const double turned = v.wings.added_inertia * std::sin(alpha) * std::cos(alpha) * alpha_rate * stroke.velocity;
  return {loads.lift, loads.moment + loads.added_inertia * stroke.acceleration + turned};
}

/// Loads of wings on hinges: of the equations of motion what is left of massless wings that nothing holds.
/// `clap`: the factor of clap and fling.
AirLoads loads_on_hinges(const Vehicle<double>& v, const AngleMotion& stroke, const AngleMotion& pitch,
                         double clap = 1.0) {
  PitchingWings<double> air = v.pitch;
  air.hinge = {};
  air.pitch_inertia = air.mass_product = 0.0;
  const PitchState<double> state = pitch_state(pitch.value, pitch.velocity, stroke.velocity, clap, stroke.value);
  constexpr double held = -1.0;  // the accelerations are stated
  const WingsAtPitch<double> wings =
      wings_at_pitch(v.wings, air, 0.0, state, sign_of(stroke.velocity), sign_of(pitch.velocity), held);
  return {lift_at_pitch(air, wings, state, stroke.acceleration, pitch.acceleration),
          wings.inertia * stroke.acceleration + wings.moment - wings.coupling_moment * pitch.acceleration,
          -(wings.pitching_moment + wings.coupling_moment * stroke.acceleration) + air.air.pp * pitch.acceleration};
}

template <class System>
WingInstant instant_of(const RecordedCycle<System>& recorded, double theta, double time) {
  const System& system = recorded.system;
  const Vehicle<double>& v = system.vehicle;
  const auto& step = solver::step_at(recorded.cycle, theta);
  const auto inside = solver::evaluate_inside<true>(system, recorded.cycle, step, theta);
  const auto m = system.motion(theta, inside.y, step.signs);
  WingInstant wings;
  wings.time = time;
  wings.stroke = {system.stroke_angle(m, inside.y), m.stroke_velocity, m.stroke_acceleration};
  if constexpr (System::on_hinges) {
    if (pitches(v)) {
      const Coordinates<double> c = system.coordinates(theta, inside.y);
      const bool held = step.signs[System::held] < 0.0;
      wings.pitch = {c.pitch_angle, held ? 0.0 : c.pitch_velocity, m.pitch_acceleration};
      if (twists(v.pitch.torsion)) {
        wings.twist = c.twist_angle;
        wings.loads.lift = m.aero.lift;
      } else {
        const double clap = clap_factor(v.wings.clap, wings.stroke.value, sign_of(wings.stroke.velocity));
        wings.loads = loads_on_hinges(v, wings.stroke, wings.pitch, clap);
      }
      return wings;
    }
  }
  const double side = sign_of(wings.stroke.velocity);
  const bool at_bound = pitch_margin(v.wings, std::abs(wings.stroke.velocity)) < 0.0;
  wings.pitch.value = -side * (0.5 * pi - m.aero.angle_of_attack);
  wings.pitch.velocity = at_bound ? 0.0 : -v.wings.pitch_coefficient * wings.stroke.acceleration;
  wings.pitch.acceleration = absent;
  wings.loads.lift = m.aero.lift;
  wings.loads.stroke_moment = m.aero.moment + m.aero.added_inertia * wings.stroke.acceleration;
  return wings;
}

}  // namespace

WingInstant wing_instant(const CycleRecord& cycle, double share) {
  const double period = cycle.period(), time = (share - std::floor(share)) * period;
  const double theta = cycle.phase_at(time);
  WingInstant wings = visit(cycle, [&](const auto& recorded) { return instant_of(recorded, theta, time); });
  wings.cycle = time / period;
  return wings;
}

std::vector<WingInstant> wing_motion(const CycleRecord& cycle, int count) {
  std::vector<WingInstant> wings;
  wings.reserve(std::size_t(count));
  for (int k = 0; k + 1 < count; ++k) wings.push_back(wing_instant(cycle, double(k) / (count - 1)));
  WingInstant end = wings.front();
  end.time = cycle.period();
  end.cycle = 1.0;
  wings.push_back(end);
  return wings;
}

AirLoads air_loads(const Vehicle<double>& v, const AngleMotion& stroke, const AngleMotion* pitch) {
  if (has_induced_velocity(v.wings.wake) || claps(v.wings.clap)) {
    throw ParameterError(
        has_induced_velocity(v.wings.wake) ? induced_velocity_key::share.path : clap_and_fling_key::amplitude.path,
        "follows from a settled cycle, not from a stated motion; compare at the vehicle's own");
  }
  if (!pitches(v)) return loads_under_law(v, stroke, pitch);
  if (twists(v.pitch.torsion)) {
    throw ParameterError("wing.torsion.stiffness", "loads at a stated motion are not known of wings that twist");
  }
  if (!pitch) throw ParameterError("pitch.stiffness", "of wings on hinges the stroke alone does not give the pitch");
  return loads_on_hinges(v, stroke, *pitch);
}

double AngleSeries::at(double cycle) const {
  double x = mean;
  for (std::size_t k = 0; k < cosine.size(); ++k) {
    const double angle = two_pi * double(k + 1) * cycle;
    x += cosine[k] * std::cos(angle) + sine[k] * std::sin(angle);
  }
  return x;
}

PeriodicAngle periodic_angle(const AngleSeries& series) {
  PeriodicAngle angle{series.mean, {}};
  for (std::size_t k = 0; k < series.cosine.size(); ++k) {
    angle.harmonics.push_back(
        {std::hypot(series.cosine[k], series.sine[k]), std::atan2(series.cosine[k], series.sine[k])});
  }
  return angle;
}

namespace {

void note_errors(AngleSeries& series, std::span<const double> values) {
  double squares = 0.0;
  series.error_max = 0.0;
  for (std::size_t n = 0; n < values.size(); ++n) {
    const double error = std::abs(series.at(double(n) / double(values.size())) - values[n]);
    series.error_max = std::max(series.error_max, error);
    squares += square(error);
  }
  series.error_rms = std::sqrt(squares / double(values.size()));
}

void add_harmonic(AngleSeries& series, std::span<const double> values) {
  const double k = double(series.cosine.size() + 1), count = double(values.size());
  double a = 0.0, b = 0.0;
  for (std::size_t n = 0; n < values.size(); ++n) {
    const double angle = two_pi * k * double(n) / count;
    a += values[n] * std::cos(angle);
    b += values[n] * std::sin(angle);
  }
  series.cosine.push_back(2.0 * a / count);
  series.sine.push_back(2.0 * b / count);
}

AngleSeries mean_series(std::span<const double> values) {
  AngleSeries series;
  for (const double x : values) series.mean += x / double(values.size());
  return series;
}

}  // namespace

AngleSeries angle_series(std::span<const double> values, int harmonics) {
  AngleSeries series = mean_series(values);
  for (int k = 0; k < harmonics; ++k) add_harmonic(series, values);
  note_errors(series, values);
  return series;
}

AngleSeries angle_series_within(std::span<const double> values, double error, int harmonics_max) {
  AngleSeries series = mean_series(values);
  do {
    add_harmonic(series, values);
    note_errors(series, values);
  } while (series.error_max > error && int(series.cosine.size()) < harmonics_max);
  return series;
}

}  // namespace wingbeat
