// One design of a study with its exact derivatives.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/cycle/steady_options.hpp"
#include "wingbeat/study/flight_metrics.hpp"
#include "wingbeat/study/frequency_search.hpp"
#include "wingbeat/study/gear_torque.hpp"
#include "wingbeat/study/hold.hpp"
#include "wingbeat/study/sweep_status.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

struct DesignParameter;

struct DesignPointOptions {
  Condition condition = Condition::air;
  std::optional<Hold> hold = {};  ///< the voltage follows
  double tolerance = 1e-6;        ///< of the orbit
  bool peaks = true;              ///< differentiate metrics that are peaks
  FlightMetrics flight = {};      ///< of a vehicle on a battery: Metric::hover, Metric::endurance, too
  bool gear_torque = false;       ///< find out DesignPoint::gear_torque
};

/// What a design does, and how its metrics change with parameters; in words: describe() of report/describe.hpp.
struct DesignPoint {
  SweepStatus status = SweepStatus::invalid;
  StatusEvidence evidence;               ///< what shows the status, unless one of the next two does
  std::optional<SearchFinding> refused;  ///< why a frequency, a lift or a power cannot be held
  std::string error;                     ///< what() of the ParameterError of an invalid design
  Metrics<double> metrics;               ///< all absent unless flapping
  double voltage = absent;               ///< mean one of its supply, or amplitude; what a hold found [V]
  double pitch_coefficient = absent;     ///< C_alpha that was found for an angle of attack that the design states [s]
  DomainStatus domain;                   ///< limits of the model that are exceeded; none unless flapping
  DomainExcess domain_excess{};          ///< by how much; only where flapping
  /// Derivatives of domain_excess by each parameter through the metrics alone (domain_excess_slopes); as `gradients`.
  std::vector<DomainExcess> domain_slopes;
  /// By each parameter, SI; the supply's voltage and duty included. All absent unless flapping and regular.
  std::vector<std::array<double, metric_count>> gradients;
  GearTorque gear_torque;                      ///< where it is asked for
  std::vector<GearTorque> gear_torque_slopes;  ///< by each parameter, SI
};

/// Solves a design by the scalar solver; a design out of its physical range has the status invalid. Throws
/// ParameterError for a parameter without a value in the design. Where the design states an angle of attack C_alpha is
/// found for it, and follows in the derivatives.
DesignPoint design_point(const Design<double>& design, const DesignPointOptions& options,
                         std::span<const DesignParameter> parameters, const StartUp& start_up);

}  // namespace wingbeat
