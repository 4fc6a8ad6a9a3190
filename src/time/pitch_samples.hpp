// What the metrics of a cycle in time need beside its quadratures and extremes where the wings pitch on hinges.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "time/integrator.hpp"
#include "time/time_model.hpp"
#include "wingbeat/cycle/pitch_metrics.hpp"

namespace wingbeat::detail {

/// Samples and integrals of one cycle or several, whose duration is known at their end alone.
class PitchSamples {
 public:
  void begin(const TimeModel& model) {
    metrics_ = {0.0, 0.0, infinity, -infinity, 0.0, 0.0};
    lowest_psi_ = infinity;
    highest_psi_ = -infinity;
    loss_ = -model.now.impact_loss;
    chordwise_ = 0.0;
    points_.clear();
  }

  /// The step from the time `from` [s] to where the model stands: pitch and angle of attack have their extremes at ends
  /// of steps.
  void step_taken(const TimeModel& model, Integrator& steps, double from) {
    constexpr double nodes[] = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831, 0.9061798459386640};
    constexpr double weights[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                  0.2369268850561891};
    const bool plain = !model.further && !has_friction(model.vehicle.pitch.hinge);
    const double half = 0.5 * (model.now.t - from), middle = from + half;
    double sign = 1.0;
    for (int k = 0; k < 5; ++k) {
      const double t = middle + half * nodes[k];
      const double* y = steps.dense(t);
      const Coordinates<double> c = model.indices.coordinates(y);
      const CrankKinematics<double> kinematics = model.kinematics(c.angle);
      const double psi = local_pitch(c), stroke_velocity = kinematics.stroke_slope * c.speed;
      const double stroke = sign_of(stroke_velocity);
      points_.push_back({t, half * weights[k], stroke_angle_at(model.vehicle, kinematics, c.angle), psi});
      if (plain) {
        const double velocity = model.now.held ? 0.0 : c.pitch_velocity;
        const PitchState<double> state = pitch_state<double>(psi, velocity, stroke_velocity);
        loss_ += half * weights[k] * hinge_loads(model.vehicle.pitch.hinge, psi, velocity).loss;
        chordwise_ += half * weights[k] * chordwise_lift(model.vehicle.pitch, state);
      } else {
        const PitchMotion<double> m = model.motion(t, y);
        loss_ += half * weights[k] * m.hinge_loss;
        chordwise_ += half * weights[k] * m.chordwise_lift;
      }
      if (stroke * psi > still_pitch) metrics_.over_rotation += half * weights[k];
      if (k == 2) sign = stroke;
    }
    for (const double t : {from, model.now.t}) {
      const double psi = local_pitch(model.indices.coordinates(steps.dense(t))), alpha = 0.5 * pi + sign * psi;
      lowest_psi_ = std::min(lowest_psi_, psi);
      highest_psi_ = std::max(highest_psi_, psi);
      metrics_.angle_of_attack_min = std::min(metrics_.angle_of_attack_min, alpha);
      metrics_.angle_of_attack_max = std::max(metrics_.angle_of_attack_max, alpha);
    }
  }

  /// After `cycles` cycles between two times [s].
  void finish(const TimeModel& model, double start, double end, int cycles, Metrics<double>& metrics) {
    const double period = (end - start) / cycles;
    std::complex<double> stroke = 0.0, psi = 0.0;
    for (const Point& p : points_) {
      const auto weighted = std::polar(p.weight, -two_pi * (p.time - start) / period);
      stroke += weighted * p.stroke_angle;
      psi += weighted * p.psi;
    }
    metrics_.amplitude = 0.5 * (highest_psi_ - lowest_psi_);
    metrics_.phase = std::arg(psi / (std::complex<double>(0.0, -1.0) * stroke));
    metrics_.hinge_power = (loss_ + model.now.impact_loss) / (end - start);
    metrics_.over_rotation /= end - start;
    metrics_.chordwise = chordwise_ / (end - start);
    set_pitch_metrics(metrics_, model.vehicle.pitch, metrics);
  }

  void add_to(StatusEvidence& evidence, const TimeModel& model) const {
    if (model.vehicle.wings.air_density > 0.0) evidence.over_rotation = metrics_.over_rotation_of_moving();
  }

 private:
  struct Point {
    double time, weight, stroke_angle, psi;
  };
  std::vector<Point> points_;  ///< of Gauss's rule on each step
  PitchMetrics metrics_{};
  double lowest_psi_ = 0.0, highest_psi_ = 0.0;
  double loss_ = 0.0;       ///< in the hinges since begin(), less the impacts before [J]
  double chordwise_ = 0.0;  ///< integral of chordwise_lift() since then [N s]
};

}  // namespace wingbeat::detail
