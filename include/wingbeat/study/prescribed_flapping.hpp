// Wings whose stroke and pitch are stated over time: what the blade elements make of motions that were measured,
// without any drive or hinge. And wings whose stroke alone is stated, that pitch passively on their hinge.
#pragma once

#include <string_view>
#include <vector>

#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/parts/blade_element.hpp"
#include "wingbeat/parts/pitching_wings.hpp"
#include "wingbeat/vehicle/forward.hpp"

namespace wingbeat {

/// An angle that repeats with the wing beat, at the frequency f:
/// \f[
/// x(t) = \bar x + \sum_k A_k \sin(2 \pi k f t + \varphi_k), \qquad k = 1, 2, \ldots
/// \f]
struct PeriodicAngle {
  struct Harmonic {
    double amplitude = 0.0;  ///< \f$A_k\f$ [rad]
    double phase = 0.0;      ///< \f$\varphi_k\f$ [rad]
  };
  double mean = 0.0;                ///< [rad]
  std::vector<Harmonic> harmonics;  ///< from the first
};

/// Value [rad], velocity [rad/s] and acceleration [rad/s2] of an angle.
struct AngleMotion {
  double value = 0.0, velocity = 0.0, acceleration = 0.0;
};
/// At a time [s], of an angle that repeats with this frequency [Hz].
AngleMotion motion_of(const PeriodicAngle& angle, double frequency, double time);

struct PrescribedFlapping {
  double frequency = 0.0;  ///< f [Hz], > 0
  PeriodicAngle stroke;    ///< beta
  PeriodicAngle pitch;  ///< psi, as PitchHinge has it: at rest wings that give way to the air have -psi sign(beta') > 0
};

/// How the force on a strip is directed.
enum class StripForceDirection {
  normal,         ///< normal to the chord, as on wings that pitch on a hinge (model.md section 12)
  lift_and_drag,  ///< C_L and C_D apart, as under the pitch law (section 3); translation alone
};

/// The wings, all of them together; of `pitching` the hinge and the inertia play no part.
struct PrescribedWings {
  BladeElement<double> blades;
  PitchingWings<double> pitching;
  StripForceDirection direction = StripForceDirection::normal;
};

/// `count` wings of a planform that has a shape, in air of that density [kg/m3], with a named set of coefficients
/// ("translational-2022", "normal-force-robofly") and, if asked for, the terms of rotation that go with the set
/// (rotation_with()) and added mass. Throws ParameterError for a name that no set has.
PrescribedWings prescribed_wings(const Planform<double>& planform, double count, double air_density,
                                 std::string_view coefficients, bool rotation, bool added_mass);

/// Means over a wing beat of all wings.
struct PrescribedLoads {
  double lift = 0.0;              ///< normal to the stroke plane [N]
  double lift_translation = 0.0;  ///< of it: force of the flapping velocity [N]
  double lift_rotation = 0.0;     ///< of it: rotational lift [N]
  double lift_added_mass = 0.0;   ///< of it: inertia of the air [N]
  /// What the air takes, about both axes [W]; added mass takes none over a whole beat.
  double power = 0.0;
  double power_translation = 0.0;  ///< of it [W]
  double power_rotation = 0.0;     ///< of it: of the rotational lift [W]
  double power_damping = 0.0;      ///< of it: of the rotational damping [W]
};

/// The means over a beat by Gauss's rule between the reversals of stroke and pitch, where the loads have kinks; to
/// about 1e-12 for motions of a few harmonics. Throws ParameterError for a frequency that is not > 0.
PrescribedLoads prescribed_loads(const PrescribedWings& wings, const PrescribedFlapping& flapping);

/// Means over a wing beat of all wings on a body that flies steadily, horizontally ahead.
struct PrescribedFlightLoads {
  double thrust = 0.0;  ///< ahead [N]
  double lift = 0.0;    ///< upwards, against gravity [N]
  double power = 0.0;   ///< what the wings give to the air about stroke and pitch axis [W]
};

/// The means at that speed [m/s], the stroke plane tilted nose up [rad], by the strips of model.md section 18, without
/// added mass; by 4000 points over the beat. Of forces normal to the chord.
PrescribedFlightLoads prescribed_flight_loads(const PrescribedWings& wings, const Planform<double>& planform,
                                              double count, const PrescribedFlapping& flapping, double speed,
                                              double stroke_plane_tilt);

/// Passive pitching under a stated stroke.
struct PassivePitch {
  bool settled = false;            ///< the pitching repeats with the wing beat; all else is absent where it does not
  double amplitude = absent;       ///< half of psi from peak to peak [rad]
  double first_harmonic = absent;  ///< amplitude of its first harmonic [rad]
  double mean = absent;            ///< of psi over time [rad]
  /// By which the first harmonic of the pitching is ahead of the pitch that opposes the first harmonic of the flapping
  /// velocity, as Metric::pitch_phase [rad].
  double phase = absent;
};

/// The pitching of a vehicle's wings under a stated stroke: the equation of motion of the pitch alone (model.md section
/// 12), followed in time until it repeats. Throws ParameterError for wings that do not pitch on a hinge, that twist, or
/// whose hinge has a stop or friction, and for a frequency that is not > 0.
PassivePitch passive_pitch(const Vehicle<double>& vehicle, const PeriodicAngle& stroke, double frequency);

}  // namespace wingbeat
