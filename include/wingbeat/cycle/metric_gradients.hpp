// Derivatives of metrics by parameters of a design, as plain numbers; how: cycle/orbit_gradient.hpp.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wingbeat/core/jet_traits.hpp"
#include "wingbeat/cycle/held.hpp"
#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/vehicle/forward.hpp"

namespace wingbeat {

enum class Condition;
struct Drive;
struct SteadyFlapping;

/// Parameters differentiated side by side. A dual number also carries the states: two and the voltage, or the three of
/// a direct drive with inductance. Systems with more states have wider ones of their own (cycle_gradient.hpp).
inline constexpr int gradient_parameters = 5;
inline constexpr int gradient_voltage_slot = 2;
inline constexpr int gradient_first_slot = 3;
inline constexpr int gradient_slots = gradient_first_slot + gradient_parameters;
using GradientJet = Jet<gradient_slots>;

struct GradientOptions {
  Held held = Held::voltage;
  bool peaks = true;  ///< false: the metrics that are peaks (is_peak()) have values alone, their derivatives are absent
  std::span<const double> crank_angles = {};  ///< instants of the cycle wanted, 0 to 2 pi [rad]
  bool angle_held = false;  ///< C_alpha follows, so that the least angle of attack stays; of metric_gradients() alone
};

/// True of metrics whose derivatives cost a search for peaks along the cycle, or as much.
bool is_peak(Metric which, const Drive& drive);

/// A parameter of a design: how to set it for plain and for dual numbers; false if the design has no place for it.
struct DesignParameter {
  std::string key;   ///< as in a vehicle file: "friction.radius"
  std::string unit;  ///< SI
  bool (*set)(Design<double>&, const double&) = nullptr;
  bool (*set_jet)(Design<GradientJet>&, const GradientJet&) = nullptr;
  std::optional<double> (*value)(const Design<double>&) = nullptr;
};

/// Derivatives of all metrics by any number of parameters.
struct MetricGradients {
  std::vector<std::array<double, metric_count>> by_parameter;
  std::array<double, metric_count> by_voltage{};  ///< by the motor's; 0 unless it is held, absent for a direct drive
  bool regular = true;                            ///< as in OrbitGradient
};

/// orbit_gradient() of a design for any number of parameters, gradient_parameters at a time. A parameter that the
/// design has no place or no value for throws ParameterError. The record's voltage replaces the design's. With
/// options.angle_held the design states the C_alpha that was found, and aerodynamics.angle_of_attack is a parameter.
MetricGradients metric_gradients(const Design<double>& design, Condition condition, const SteadyFlapping& orbit,
                                 std::span<const DesignParameter> parameters, const GradientOptions& options = {});

}  // namespace wingbeat
