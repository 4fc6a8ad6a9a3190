// Passive pitching under a stated stroke.
#include <algorithm>
#include <array>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/study/prescribed_flapping.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

using PitchAngles = std::array<double, 2>;  // psi, psi'

constexpr int beat_steps = 96;    // of one wing beat
constexpr int max_beats = 400;    // after which pitching counts as not settled
constexpr double repeats = 1e-8;  // by which two beats may differ [rad], and the same in velocity by the frequency

}  // namespace

PassivePitch passive_pitch(const Vehicle<double>& v, const PeriodicAngle& stroke, double frequency) {
  require(frequency > 0.0 && std::isfinite(frequency), "frequency", "must be > 0", "Hz", frequency);
  if (!pitches(v) || is_clamped(v.pitch.hinge)) {
    throw ParameterError(pitch_key::stiffness.path, "the wings must pitch on a hinge for passive pitching");
  }
  if (has_stop(v.pitch.hinge)) {
    throw ParameterError(pitch_key::stop.path, "passive pitching under a stated stroke has no stops");
  }
  if (has_friction(v.pitch.hinge)) {
    throw ParameterError(pitch_key::friction.path, "passive pitching under a stated stroke has no friction");
  }
  const double inertia = v.wing_count * v.wing_inertia;
  const auto rates = [&](const PitchAngles& x, PitchAngles& rate, double t) {
    const AngleMotion motion = motion_of(stroke, frequency, t);
    const WingsAtPitch<double> wings =
        wings_at_pitch(v.wings, v.pitch, inertia, pitch_state(x[0], x[1], motion.velocity), sign_of(motion.velocity),
                       sign_of(x[1]), 1.0);
    rate = {x[1], wings.free_acceleration + wings.coupling * motion.acceleration};
  };
  boost::numeric::odeint::runge_kutta_fehlberg78<PitchAngles> stepper;
  const double step = 1.0 / (frequency * beat_steps);
  PitchAngles x = {0.0, 0.0};
  PassivePitch pitch;
  for (int beat = 0; beat < max_beats; ++beat) {
    const PitchAngles begin = x;
    double low = x[0], high = x[0], mean = 0.0, sine = 0.0, cosine = 0.0, stroke_sine = 0.0, stroke_cosine = 0.0;
    for (int n = 0; n < beat_steps; ++n) {
      const double t = n * step, angle = two_pi * n / beat_steps;
      const double rate = motion_of(stroke, frequency, t).velocity;
      mean += x[0] / beat_steps;
      sine += x[0] * std::sin(angle);
      cosine += x[0] * std::cos(angle);
      stroke_sine += rate * std::sin(angle);
      stroke_cosine += rate * std::cos(angle);
      const PitchAngles before = x;
      stepper.do_step(rates, x, t, step);
      low = std::min(low, x[0]);
      high = std::max(high, x[0]);
      // The peak between two steps, of the cubic through both ends.
      if ((before[1] > 0.0) != (x[1] > 0.0)) {
        const double share = before[1] / (before[1] - x[1]), s2 = square(share), s3 = s2 * share;
        const double peak = (2.0 * s3 - 3.0 * s2 + 1.0) * before[0] + (s3 - 2.0 * s2 + share) * step * before[1] +
                            (3.0 * s2 - 2.0 * s3) * x[0] + (s3 - s2) * step * x[1];
        low = std::min(low, peak);
        high = std::max(high, peak);
      }
    }
    if (!std::isfinite(x[0]) || !std::isfinite(x[1])) return pitch;
    if (std::abs(x[0] - begin[0]) > repeats || std::abs(x[1] - begin[1]) > repeats * two_pi * frequency) continue;
    pitch.settled = true;
    pitch.amplitude = 0.5 * (high - low);
    pitch.first_harmonic = 2.0 * std::hypot(sine, cosine) / beat_steps;
    pitch.mean = mean;
    // atan2(cosine, sine) is the phase of a sine; the pitch that opposes the velocity has that of its negative.
    pitch.phase = std::remainder(std::atan2(cosine, sine) - std::atan2(-stroke_cosine, -stroke_sine), two_pi);
    break;
  }
  return pitch;
}

}  // namespace wingbeat
