// What the metrics of a direct drive's period need beside its quadratures and extremes.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>

#include "time/direct_model.hpp"
#include "time/integrator.hpp"
#include "time/pitch_direct_model.hpp"
#include "time/transient_tools.hpp"
#include "wingbeat/cycle/pitch_metrics.hpp"

namespace wingbeat::detail {

template <class Model>
class PeriodAverages;

/// Under the pitch law: nothing.
template <>
class PeriodAverages<DirectModel> {
 public:
  void begin(const DirectModel&) {}
  void add_impulses(const DirectModel&, CycleIntegrals<double>&) const {}
  void step_taken(const DirectModel&, Integrator&, double) {}
  void finish(const DirectModel&, const double*, Metrics<double>&) {}
  void add_to(StatusEvidence&, const DirectModel&) const {}
};

/// How wings that pitch on hinges have pitched.
template <>
class PeriodAverages<PitchDirectModel> {
 public:
  void begin(const PitchDirectModel& model) {
    metrics_ = {0.0, 0.0, infinity, -infinity, 0.0, 0.0};
    lowest_psi_ = infinity;
    highest_psi_ = -infinity;
    impact_mark_ = model.now.impact_loss;
    impulses_mark_ = model.now.impulses;
  }

  /// Adds what impacts of this period add to its integrals; the reactive work has it already.
  void add_impulses(const PitchDirectModel& model, CycleIntegrals<double>& integrals) const {
    for (const Integral which : quadratures) {
      integrals[std::size_t(which)] += model.now.impulses[std::size_t(which)] - impulses_mark_[std::size_t(which)];
    }
  }

  /// The step from the time `from` [s] to where the model stands: pitch and angle of attack have their extremes at ends
  /// of steps.
  void step_taken(const PitchDirectModel& model, Integrator& steps, double from) {
    const double* middle = steps.dense(0.5 * (from + model.now.t));
    const double stroke = sign_of(middle[1]);
    if (stroke * middle[2] > still_pitch) metrics_.over_rotation += (model.now.t - from) / model.period;
    for (const double t : {from, model.now.t}) {
      const double psi = steps.dense(t)[2], alpha = 0.5 * pi + stroke * psi;
      lowest_psi_ = std::min(lowest_psi_, psi);
      highest_psi_ = std::max(highest_psi_, psi);
      metrics_.angle_of_attack_min = std::min(metrics_.angle_of_attack_min, alpha);
      metrics_.angle_of_attack_max = std::max(metrics_.angle_of_attack_max, alpha);
    }
  }

  /// At the period's end, `other` being the model's integrals behind `quadratures`.
  void finish(const PitchDirectModel& model, const double* other, Metrics<double>& metrics) {
    metrics_.amplitude = 0.5 * (highest_psi_ - lowest_psi_);
    metrics_.hinge_power = (other[PitchDirectModel::hinge_work] + model.now.impact_loss - impact_mark_) / model.period;
    const std::complex<double> stroke(other[PitchDirectModel::stroke_cosine], -other[PitchDirectModel::stroke_sine]),
        psi(other[PitchDirectModel::pitch_cosine], -other[PitchDirectModel::pitch_sine]);
    metrics_.phase = std::arg(psi / (std::complex<double>(0.0, -1.0) * stroke));
    metrics_.chordwise = other[PitchDirectModel::chordwise] / model.period;
    set_pitch_metrics(metrics_, model.vehicle.pitch, metrics);
  }

  void add_to(StatusEvidence& evidence, const PitchDirectModel& model) const {
    if (model.vehicle.wings.air_density > 0.0) evidence.over_rotation = metrics_.over_rotation_of_moving();
  }

 private:
  PitchMetrics metrics_{};  ///< of this period, so far
  double lowest_psi_ = 0.0, highest_psi_ = 0.0, impact_mark_ = 0.0;
  CycleIntegrals<double> impulses_mark_{};
};

}  // namespace wingbeat::detail
