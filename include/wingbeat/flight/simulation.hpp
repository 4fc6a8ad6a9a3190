// A vehicle in flight, step by step: body, drives, wind and controls; for controllers, trim and learning.
//
//   FlightSimulation flight(flight_vehicle(design));
//   flight.command({.at = {6.0}});           // controls, indexed by FlightControl
//   flight.step_to(0.05);
//   const FlightState state = flight.state();
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "wingbeat/flight/flight_vehicle.hpp"
#include "wingbeat/parts/body.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/coordinates.hpp"

namespace wingbeat {

/// Integrals over a flight since its start.
struct FlightTotals {
  Triple force{}, moment{};  ///< of the air on wings, body and plates, in body axes [N s], [N m s]
  double electrical = 0.0;   ///< at the motor terminals [J]
  double motor = 0.0;        ///< lost in windings, motor friction and gearboxes [J]
  double friction = 0.0;     ///< lost in the mechanism and in pitch hinges [J]
  double wing_air = 0.0;     ///< that the drives give to the air [J]
  double body_air = 0.0;     ///< that the air does on the body [J]
  double stops = 0.0;        ///< lost in impacts on stops of the pitching [J]
  double residual = 0.0;     ///< what the formulation of a crank fails to conserve [J]

  template <class Self, class Use>
  static void each(Self& self, const Use& use) {
    for (auto& x : self.force) use(x);
    for (auto& x : self.moment) use(x);
    use(self.electrical), use(self.motor), use(self.friction), use(self.wing_air), use(self.body_air);
    use(self.residual);
  }
};
inline constexpr std::size_t flight_total_count = 12;

/// Everything that moves.
struct FlightState {
  double time = 0.0;
  BodyState body;
  std::vector<Coordinates<double>> drives;
};

struct FlightOptions {
  double tolerance = 1e-7;            ///< admissible relative error of a step [1], 1e-12 to 1e-2
  double gravity = standard_gravity;  ///< [m/s2]
  bool frozen = false;                ///< the body keeps its velocity, rates and attitude: a wind tunnel
  std::function<void()> check = {};   ///< called after each piece; what it throws ends the call
};

/// Copies are simulations of their own.
class FlightSimulation {
 public:
  /// At rest, upright, at the origin, drives standing, at the vehicle's stated voltage. Throws ParameterError for
  /// options out of range.
  explicit FlightSimulation(const FlightVehicle& vehicle, const FlightOptions& options = {});
  FlightSimulation(const FlightSimulation&);
  FlightSimulation(FlightSimulation&&) noexcept;
  FlightSimulation& operator=(const FlightSimulation&);
  FlightSimulation& operator=(FlightSimulation&&) noexcept;
  ~FlightSimulation();

  /// Starts from there at time 0, totals included.
  void start(const BodyState& body, const std::vector<Coordinates<double>>& drives = {});
  /// Moves the body alone; drives and time stay.
  void place(const BodyState& body);
  /// From now on. Within the ranges of the vehicle's controls or beyond, as asked.
  void command(const FlightControls& controls);
  const FlightControls& controls() const;
  /// Wind [m/s] in earth axes by time and place; none where empty.
  void blow(std::function<Triple(double time, const Triple& position)> wind);

  /// Goes on to the time [s]. False: a mechanism has jammed, time stands. Throws std::runtime_error where steps fail.
  bool step_to(double until);

  double time() const;
  FlightState state() const;
  const FlightTotals& totals() const;
  /// Of drives and body, over the height of the origin [J].
  double stored_energy() const;
  BodyLoads loads() const;
  /// About the time of a wingbeat of the first drive [s].
  double cycle_time() const;
  const FlightVehicle& vehicle() const;

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace wingbeat
