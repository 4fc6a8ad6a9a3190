// Body and drives of an FMU in co-simulation: what the loop through the events (time/event_loop.hpp) asks of them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "flight/drives_on_body.hpp"
#include "fmu/body_in_time.hpp"
#include "fmu/measured_model.hpp"

namespace wingbeat::fmu {

/// Beside its unknowns it integrates the sums of the drives.
class FlightSteps : public detail::DrivesOnBody<FlightSteps, MeasuredModel> {
 public:
  static constexpr int sum_count = int(max_drives) * detail::quadrature_count;

  struct Now {
    double t = 0.0;
    bool stuck = false;        ///< never: a flight goes on while a drive stands
    double impact_loss = 0.0;  ///< not watched
  };

  /// Of drives at one time. `work`: evaluations of the rates that may follow, after which WorkSpent is thrown.
  FlightSteps(std::vector<MeasuredModel*> drives, BodyInTime& body, std::int64_t work);

  // What the loop through the events asks beside what the base answers.
  void unknowns(double* y) const;
  void set(double t, const double* y);
  bool rates(double t, const double* y, double* dy) const;
  std::array<double, indicator_count> indicators(double t, const double* y) const;
  void tolerated(double relative, const double* y, double* errors) const;
  double next_switch() const;
  void switch_supply();

  MeasuredModel& drive(std::size_t n) { return *drives_[n]; }
  const MeasuredModel& drive(std::size_t n) const { return *drives_[n]; }
  std::size_t drive_count() const { return drives_.size(); }
  void set_flows_now() const { body_.set_flows(body_.state); }

  Now now;

 private:
  detail::AirOnBody air_at(double t, const double* y, const BodyState& body) const;

  std::vector<MeasuredModel*> drives_;
  BodyInTime& body_;
  mutable std::int64_t work_left_;
};

std::unique_ptr<detail::Integrator> integrator_for(TimeIntegrator which, const FlightSteps& model,
                                                   const double& relative);

}  // namespace wingbeat::fmu
