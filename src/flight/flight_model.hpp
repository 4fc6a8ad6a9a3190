// A vehicle that flies, in time: its drives, which a TimeModel each knows, and its body, whose motion the strips of the
// wings feel; model.md section 18.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "flight/drives_on_body.hpp"
#include "time/integrator.hpp"
#include "time/time_model.hpp"
#include "wingbeat/flight/flight_vehicle.hpp"
#include "wingbeat/flight/simulation.hpp"
#include "wingbeat/parts/body.hpp"

namespace wingbeat::detail {

/// Beside its unknowns it integrates FlightTotals.
class FlightModel : public DrivesOnBody<FlightModel, TimeModel> {
 public:
  using Base = DrivesOnBody<FlightModel, TimeModel>;

  struct Now {
    double t = 0.0;
    BodyState body;
    bool stuck = false;        ///< never: a flight goes on while a drive stands
    double impact_loss = 0.0;  ///< of all drives so far [J]
  };

  /// The wind at a time and a place of earth axes, in earth axes [m/s].
  using Wind = std::function<Triple(double t, const Triple& position)>;

  explicit FlightModel(const FlightVehicle& vehicle);
  FlightModel(const FlightModel& other);
  FlightModel& operator=(const FlightModel& other);

  /// From rest, or with the drives as `from` has them.
  void start(const BodyState& body, const std::vector<Coordinates<double>>& from = {});
  void set_controls(const FlightControls& controls);
  const FlightControls& controls() const { return controls_; }

  // What the loop through the events asks beside what the base answers.
  void begin_piece();
  void unknowns(double* y) const;
  void set(double t, const double* y);
  bool rates(double t, const double* y, double* dy) const;
  std::array<double, indicator_count> indicators(double t, const double* y) const;
  void handle(std::size_t indicator);
  bool branch_lost();
  void tolerated(double relative, const double* y, double* errors) const;
  static constexpr double next_switch() { return std::numeric_limits<double>::infinity(); }
  void switch_supply() {}

  TimeModel& drive(std::size_t n) { return drives[n]; }
  const TimeModel& drive(std::size_t n) const { return drives[n]; }
  std::size_t drive_count() const { return drives.size(); }
  void set_flows_now() const { set_flows(now.t, now.body); }

  /// Energy of drives and body, over the height of the origin [J].
  double stored_energy() const;
  /// What acts on the body now, wings and plates.
  BodyLoads loads_now() const;

  FlightVehicle vehicle;
  std::vector<TimeModel> drives;
  bool frozen = false;  ///< the body does not move from where it is, though it has a velocity
  double gravity = standard_gravity;
  Wind wind;
  Now now;
  FlightTotals totals;
  mutable double next_step = 0.0;  ///< with which the next piece begins [s]; 0: not known

 private:
  void own_flows();
  void set_flows(double t, const BodyState& body) const;
  /// Loads of wings and plates; with wings that have mass also the accelerations of the body.
  AirOnBody air_at(double t, const double* y, const BodyState& body) const;
  void sum_impacts();

  DriveFlows flows_;
  FlightControls controls_;
  std::array<double, max_drives> scaled_to_{};  ///< voltage that the sizes of a drive are for [V]
};

/// That of explicit steps.
std::unique_ptr<Integrator> integrator_for(TimeIntegrator which, const FlightModel& model, const double& relative);

}  // namespace wingbeat::detail
