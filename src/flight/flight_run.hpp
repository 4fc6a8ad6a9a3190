// A flight of a plan, as far as it is asked for: what fly() runs to the end, and the explorer piece by piece.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "flight/flight_loop.hpp"
#include "wingbeat/flight/controller.hpp"
#include "wingbeat/flight/fly.hpp"
#include "wingbeat/flight/simulation.hpp"

namespace wingbeat::detail {

/// A plan with its trim and its controller.
struct ReadyFlight {
  FlightPlan plan;                             ///< with the rate of its controller
  TrimResult trim;                             ///< empty where the plan needs none
  double average = 0.0;                        ///< time over which samples of sensors are averaged [s]
  std::optional<FlightController> controller;  ///< none where there is no trim
};

/// Throws ParameterError for a plan out of range and where no controller can be designed. The vehicle outlives what is
/// made ready.
ReadyFlight ready_flight(const FlightVehicle& vehicle, const FlightPlan& asked);

class FlightRun {
 public:
  using Recorded = std::function<void(const FlightRow&, const FlightSimulation&)>;

  /// Of a flight that has a controller, from time 0. `recorded` is called with each row.
  FlightRun(const FlightVehicle& vehicle, ReadyFlight ready, Recorded recorded);
  FlightRun(const FlightRun&) = delete;
  FlightRun& operator=(const FlightRun&) = delete;

  /// Goes on to the first instant of sensors, control or rows at that time or later, or to the end. False: it has
  /// ended.
  bool fly_to(double until);
  /// The last row, where it is not recorded yet.
  void record_end();

  // What may change on the way.
  /// From where the controller aims now, smoothly to there, at the waypoint's time.
  void go(const Waypoint& there);
  void blow(const Triple& steady_wind);
  void push(const Triple& velocity, const Triple& rates);

  const FlightSimulation& simulation() const { return simulation_; }
  const ReadyFlight& ready() const { return ready_; }
  const BatteryInFlight& battery() const { return battery_; }
  FlightOutcome outcome() const { return outcome_; }
  const std::string& detail() const { return detail_; }  ///< a sentence of a flight that has ended early
  FlightEnergy energy() const;
  FlightReference reference(double t) const;  ///< where the controller aims

 private:
  FlightControls first_controls() const;
  void start();
  void act();
  bool advance(double until);
  bool may_reach_ground(const BodyState& body, double step) const;
  void land(FlightSimulation kept, const FlightState& before, double until);
  bool ends(FlightOutcome outcome, std::string detail);
  void add_row();

  /// Instants that follow each other at a rate; those within rounding of each other count as one.
  struct Clock {
    double period;
    long count = 0;
    double next() const { return double(count) * period; }
    bool due(double time) const { return next() <= time + 1e-9; }
  };

  const FlightVehicle& vehicle_;
  ReadyFlight ready_;
  const FlightPlan& plan_ = ready_.plan;
  Recorded recorded_;
  FlightSimulation simulation_;
  SensorSet sensors_;
  ActuatorSet actuators_;
  BatteryInFlight battery_;
  std::function<Triple(double, const Triple&)> wind_;
  Clock control_clock_, sensor_clock_, row_clock_;
  Triple first_position_{};
  FlightTotals last_;
  double last_row_ = absent, first_stored_ = 0.0, first_body_ = 0.0, by_controls_ = 0.0;
  bool flying_ = true;
  FlightOutcome outcome_ = FlightOutcome::completed;
  std::string detail_;
};

}  // namespace wingbeat::detail
