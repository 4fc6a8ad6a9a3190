// Start-up of a direct drive, for simulate_start_up(): its periods, their settling, the decision.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "time/integrator.hpp"
#include "time/pitch_samples.hpp"
#include "time/recorder.hpp"
#include "time/time_model.hpp"
#include "time/transient_tools.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat::detail {

class DirectStartUp {
 public:
  DirectStartUp(const Vehicle<double>& vehicle, const TransientOptions& options);
  DirectStartUp(const DirectStartUp&) = delete;
  TransientResult run();

 private:
  using Event = TransientEvent::Kind;
  using Evidence = StatusEvidence::Kind;

  std::span<const TimeModel::Indicator> watched(bool measuring) const;
  std::unique_ptr<Integrator> integrator(bool measuring);

  void advance(double until);
  void step_taken(Integrator& steps, double from);
  WaveformRow row(double t, const double* y) const;
  void add_variation();
  void period_done();
  void settle(double closure, double change);
  void changing(const std::function<void()>& change);
  double largest_torque() const;
  bool wings_are_still() const;
  bool rests_for_good();
  bool creeps_to_rest();
  void begin_measuring();
  void take_metrics();
  bool out_of_budget();
  void give_up(StatusEvidence why);
  void event(Event kind) { result_.events.push_back({now_.t, now_.moving.angle, kind}); }

  const TransientOptions& options_;
  TransientResult result_;
  Recorder recorder_{options_, result_};
  TimeModel model_;
  TimeModel::State& now_ = model_.now;
  const double period_ = 1.0 / model_.vehicle.drive_frequency;
  bool stiff_ = false, done_ = false;
  double relative_tolerance_ = 1e-9, tightest_ = 1e-13;
  double quadrature_scale_[quadrature_count] = {};

  double q_[quadrature_count] = {};
  std::unique_ptr<Integrator> plain_, with_quadratures_;

  bool measuring_ = false;
  double last_off_ = infinity;                   ///< how far the last period was from the orbit, relative
  double last_apart_ = infinity;                 ///< that, or how far the last metrics were from those before them
  std::optional<Metrics<double>> last_metrics_;  ///< of the period before, found with the relative tolerance
  double measured_with_ = 0.0;
  int periods_at_tightest_ = 0;
  double variation_ = 0.0, energy_mark_ = 0.0, motor_mark_ = 0.0;
  CycleExtremes<double> extremes_{};
  double swing_ = 0.0;  ///< largest |beta| of this period at the ends of steps
  std::vector<double> swings_;
  double stroke_before_ = 0.0;
  double travel_[2] = {}, last_travel_ = infinity;  ///< of this period: backwards, forwards; the longer of the last
  int creeping_ = 0;                                ///< periods so far
  std::array<double, max_unknowns> before_{};
  CycleIntegrals<double> impulses_mark_{};
  PitchSamples pitching_;
  double stuck_until_ = infinity;  ///< what a shaft has not left by then, it never leaves
  std::vector<double> changes_;
};

}  // namespace wingbeat::detail
