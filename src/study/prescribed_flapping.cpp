#include "wingbeat/study/prescribed_flapping.hpp"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <optional>
#include <string>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/root.hpp"
#include "wingbeat/flight/body_loads.hpp"
#include "wingbeat/parts/coefficient_sets.hpp"

namespace wingbeat {
namespace {

void check_frequency(double frequency) {
  require(frequency > 0.0 && std::isfinite(frequency), "frequency", "must be > 0", "Hz", frequency);
}

/// Times within a period at which an angle turns back.
void add_reversals(const PeriodicAngle& angle, double frequency, std::vector<double>& times) {
  const auto velocity = [&](double t) { return motion_of(angle, frequency, t).velocity; };
  const int steps = 128 * std::max<int>(1, int(angle.harmonics.size()));
  const double step = 1.0 / (frequency * steps);
  double before = velocity(0.0);
  for (int n = 1; n <= steps; ++n) {
    const double after = velocity(n * step);
    if ((before > 0.0) != (after > 0.0)) times.push_back(sign_change(velocity, (n - 1) * step, n * step));
    before = after;
  }
}

/// Loads at one instant.
std::array<double, 6> loads_at(const PrescribedWings& w, const AngleMotion& stroke, const AngleMotion& pitch) {
  const double side = sign_of(stroke.velocity), turn = sign_of(pitch.velocity);
  if (w.direction == StripForceDirection::lift_and_drag) {
    BladeElement<double> held = w.blades;
    held.angle_of_attack_min = 0.5 * pi + side * pitch.value;
    const AeroLoads<double> loads = aero_loads(held, stroke.velocity, side, -1.0);
    return {loads.lift, 0.0, 0.0, loads.power, 0.0, 0.0};
  }
  const PitchState<double> state = pitch_state(pitch.value, pitch.velocity, stroke.velocity);
  PitchingWings<double> part = w.pitching;
  part.rotational_coefficient = part.damping_coefficient = 0.0;
  const PitchAeroLoads<double> translation = aero_loads(w.blades, part, state, side, turn);
  part.rotational_coefficient = w.pitching.rotational_coefficient;
  const PitchAeroLoads<double> with_rotation = aero_loads(w.blades, part, state, side, turn);
  WingsAtPitch<double> all{};
  all.aero = aero_loads(w.blades, w.pitching, state, side, turn);
  const double lift = lift_at_pitch(w.pitching, all, state, stroke.acceleration, pitch.acceleration);
  const double by_translation = -translation.normal_force * state.sin_psi;
  const double by_rotation = -(all.aero.normal_force - translation.normal_force) * state.sin_psi;
  return {by_translation,
          by_rotation,
          lift - by_translation - by_rotation,
          translation.power,
          with_rotation.power - translation.power,
          all.aero.power - with_rotation.power};
}

}  // namespace

AngleMotion motion_of(const PeriodicAngle& angle, double frequency, double time) {
  AngleMotion motion{angle.mean, 0.0, 0.0};
  for (std::size_t n = 0; n < angle.harmonics.size(); ++n) {
    const double rate = two_pi * frequency * double(n + 1);
    const auto& [amplitude, phase] = angle.harmonics[n];
    const double s = amplitude * std::sin(rate * time + phase), c = amplitude * std::cos(rate * time + phase);
    motion.value += s;
    motion.velocity += rate * c;
    motion.acceleration -= square(rate) * s;
  }
  return motion;
}

PrescribedWings prescribed_wings(const Planform<double>& planform, double count, double air_density,
                                 std::string_view coefficients, bool rotation, bool added_mass) {
  const std::optional<ForceCoefficients<double>> named = named_coefficients(coefficients);
  if (!named) throw ParameterError("coefficients", "no set of coefficients is named " + std::string(coefficients));
  PrescribedWings wings;
  const ChordMoments<double> moments = chord_moments(planform, count);
  wings.blades = {air_density, 0.0, moments.s2, moments.s3, *named};
  PitchingWings<double>& p = wings.pitching;
  p.moments = pitch_chord_moments(planform, count);
  const RotationTerms terms = rotation_with(coefficients);
  p.rotational_coefficient = rotation && terms.lift ? rotational_coefficient_of(p.axis) : 0.0;
  p.damping_coefficient = rotation ? terms.damping : 0.0;
  if (coefficients == normal_force_set) p.normal_force = NormalForce::normal_force;
  if (added_mass) p.air = pitch_added_mass(air_density, p.moments, p.axis);
  return wings;
}

PrescribedLoads prescribed_loads(const PrescribedWings& wings, const PrescribedFlapping& flapping) {
  check_frequency(flapping.frequency);
  const double period = 1.0 / flapping.frequency;
  std::vector<double> times = {0.0, period};
  add_reversals(flapping.stroke, flapping.frequency, times);
  add_reversals(flapping.pitch, flapping.frequency, times);
  std::sort(times.begin(), times.end());
  using Rule = boost::math::quadrature::gauss<double, 30>;
  // Panels short enough for the highest harmonic.
  const std::size_t harmonics =
      std::max<std::size_t>({1, flapping.stroke.harmonics.size(), flapping.pitch.harmonics.size()});
  std::array<double, 6> mean{};
  for (std::size_t n = 1; n < times.size(); ++n) {
    const double length = (times[n] - times[n - 1]) / double(harmonics);
    if (!(length > 0.0)) continue;
    for (std::size_t panel = 0; panel < harmonics; ++panel) {
      const double middle = times[n - 1] + (double(panel) + 0.5) * length;
      for (std::size_t k = 0; k < Rule::abscissa().size(); ++k) {
        for (const double side : {-1.0, 1.0}) {
          const double t = middle + 0.5 * side * length * Rule::abscissa()[k];
          const auto loads = loads_at(wings, motion_of(flapping.stroke, flapping.frequency, t),
                                      motion_of(flapping.pitch, flapping.frequency, t));
          for (std::size_t q = 0; q < loads.size(); ++q) {
            mean[q] += 0.5 * length * Rule::weights()[k] * loads[q] / period;
          }
        }
      }
    }
  }
  PrescribedLoads loads;
  loads.lift_translation = mean[0];
  loads.lift_rotation = mean[1];
  loads.lift_added_mass = mean[2];
  loads.lift = mean[0] + mean[1] + mean[2];
  loads.power_translation = mean[3];
  loads.power_rotation = mean[4];
  loads.power_damping = mean[5];
  loads.power = mean[3] + mean[4] + mean[5];
  return loads;
}

PrescribedFlightLoads prescribed_flight_loads(const PrescribedWings& wings, const Planform<double>& planform,
                                              double count, const PrescribedFlapping& flapping, double speed,
                                              double stroke_plane_tilt) {
  check_frequency(flapping.frequency);
  constexpr int points = 4000;
  const auto flow = std::make_shared<OnsetFlow>();
  for (const double side : {1.0, -1.0}) {
    WingMount mount;
    mount.side = side, mount.share = 0.5, mount.tilt = stroke_plane_tilt;
    flow->mounts[flow->count++] = mount;
  }
  flow->velocity = {speed, 0.0, 0.0};
  Vehicle<double> vehicle{};
  vehicle.wings = wings.blades;
  vehicle.wings.wake.strips = wake_strips(planform, count, 1.0);
  vehicle.wings.flow = flow;
  vehicle.pitch = wings.pitching;
  vehicle.pitch.pitch_inertia = 1.0;  // wings that pitch, though by what is stated
  vehicle.pitch.air = {};
  PrescribedFlightLoads mean;
  for (int n = 0; n < points; ++n) {
    const double time = (n + 0.5) / (points * flapping.frequency);
    const AngleMotion stroke = motion_of(flapping.stroke, flapping.frequency, time);
    const AngleMotion pitch = motion_of(flapping.pitch, flapping.frequency, time);
    FullState<double> at{};
    at.configuration.stroke_angle = stroke.value;
    at.pitch_angle = pitch.value, at.pitch_velocity = pitch.velocity;
    PitchMotion<double> moves{};
    moves.stroke_velocity = stroke.velocity;
    Mode<double> mode;
    mode.stroke = sign_of(stroke.velocity), mode.turn = sign_of(pitch.velocity);
    const BodyLoads loads = wing_loads_on_body(vehicle, at, moves, mode);
    const PitchState<double> state = pitch_state(pitch.value, pitch.velocity, stroke.velocity, 1.0, stroke.value);
    mean.thrust += loads.force[0] / points;
    mean.lift -= loads.force[2] / points;
    mean.power += aero_loads(vehicle.wings, vehicle.pitch, state, mode.stroke, mode.turn).power / points;
  }
  return mean;
}

}  // namespace wingbeat
