// Means over a wingbeat of what the air does to a vehicle whose body moves steadily: the averaged model of flight;
// model.md section 18.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "wingbeat/flight/simulation.hpp"

namespace wingbeat {

/// The cycle that one drive settles to on a body in steady motion.
struct DriveCycle {
  Coordinates<double> start;                   ///< at phase 0 of a direct drive, at some angle of a crank
  double period = 0.0;                         ///< [s]
  BodyLoads mean;                              ///< of the air on its wings
  double electrical = 0.0, aerodynamic = 0.0;  ///< mean powers at the terminals, to the air [W]
  double mismatch = 0.0;                       ///< of end and start, of their sizes
};

/// The motion of the body that is held over a cycle: against the air, in body axes.
struct SteadyMotion {
  Triple velocity{};  ///< [m/s]
  Triple rates{};     ///< [rad/s]
};

struct FlightCycleOptions {
  double tolerance = 1e-9;  ///< of a step [1]; cycles close to 100 times that
};

/// What all drives settle to.
struct MeanFlight {
  BodyLoads loads;                 ///< mean of the air on wings, body and plates
  double electrical = 0.0;         ///< mean power of all drives at their terminals [W]
  double aerodynamic = 0.0;        ///< to the air [W]
  std::vector<DriveCycle> cycles;  ///< of each drive
};

/// Cycles of a vehicle's drives, each from where the last one was found.
class AveragedFlight {
 public:
  explicit AveragedFlight(FlightVehicle vehicle, const FlightCycleOptions& options = {});

  /// None where a drive does not settle: it stands, jams or does not repeat.
  std::optional<MeanFlight> at(const FlightControls& controls, const SteadyMotion& motion);

  const FlightVehicle& vehicle() const { return vehicle_; }
  const FlightCycleOptions& options() const { return options_; }

 private:
  std::optional<DriveCycle> cycle_of(std::size_t drive, const FlightControls& controls, const SteadyMotion& motion);

  FlightVehicle vehicle_;
  FlightCycleOptions options_;
  std::vector<FlightVehicle> alone_;  ///< each drive without the other
  std::vector<std::optional<DriveCycle>> last_;
  std::vector<Eigen::MatrixXd> slopes_;  ///< of each drive's mismatch where the last cycle was found
};

}  // namespace wingbeat
