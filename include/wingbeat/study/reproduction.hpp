// What the figures of the 2022 friction paper show, computed: scans along the frequency, trends of the mechanism,
// cycles; and the friction laws, each calibrated to one operating point.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/study/for_each.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {

/// A vehicle without and with hinge springs.
using SpringPair = std::array<Design<double>, 2>;

/// Which of the cases of a figure.
struct FlappingCase {
  Formulation formulation = Formulation::rod_force;
  bool springs = false;
  Condition condition = Condition::air;
  bool operator==(const FlappingCase&) const = default;
};

/// The pair's vehicle of that case.
Design<double> design_of(const SpringPair& pair, const FlappingCase& which);

/// Metrics along an axis; all absent where the vehicle does not flap, or not at the frequency.
struct TrendCurve {
  FlappingCase flapping_case;
  double crank_radius = absent;  ///< of the curve [m], where it tells curves apart
  std::vector<Metrics<double>> metrics;
  std::vector<DomainStatus> domain;  ///< of each point; none() where there are no metrics
};
struct TrendSet {
  std::vector<double> axis;  ///< flapping frequency [Hz], crank radius [m], rod length [m] or voltage [V]
  std::vector<TrendCurve> curves;
};

/// A steady cycle in air.
struct CycleCase {
  FlappingCase flapping_case;
  RunResult run;
  /// Power into wings and springs [W] of each row: positive is stored, negative returned. F g beta' - M_aero beta',
  /// which is (N_w J_w beta'' + N_w k beta) beta' of eq (23).
  std::vector<double> stored_power;
};

struct ReproductionOptions {
  bool coarse = false;      ///< few points along each axis, rough cycles: a check rather than figures for reading
  double voltage = 3.0;     ///< of cycles and of the mechanism's trends [V]
  double frequency = 22.0;  ///< of the other cycles [Hz]
  std::vector<double> crank_radii = {3e-3, 5e-3, 7e-3, 9e-3};  ///< of the trend along the voltage [m]
  double max_voltage = 5.0;                                    ///< where that trend ends [V]
};

struct Reproduction {
  ReproductionOptions options;
  TrendSet frequency;                               ///< air, vacuum, wingless without springs; air with them
  TrendSet crank_fixed_hinge;                       ///< crank radius at `voltage`, hinge offset held
  TrendSet crank_fixed_stroke;                      ///< stroke amplitude held
  TrendSet rod;                                     ///< rod length at `voltage`
  TrendSet supply_fixed_hinge;                      ///< voltage, for each of the crank radii, hinge offset held
  TrendSet supply_fixed_stroke;                     ///< stroke amplitude held
  std::vector<CycleCase> at_frequency, at_voltage;  ///< both formulations, springs off and on
};

/// Computes all of it; the result does not depend on for_each. `done` is called now and then, by one thread at a time,
/// with the share that is done. Throws ParameterError for a vehicle that cannot be computed.
Reproduction reproduce(const SpringPair& pair, const ReproductionOptions& options, const ForEach& for_each,
                       const std::function<void(double)>& done = {});

inline constexpr FrictionLaw compared_friction_laws[] = {FrictionLaw::none, FrictionLaw::viscous,
                                                         FrictionLaw::quadratic, FrictionLaw::constant,
                                                         FrictionLaw::load_proportional};

/// A friction law with its coefficient chosen so that the vehicle flaps at a frequency.
struct CalibratedLaw {
  FrictionLaw law;
  Formulation formulation;
  double coefficient = 0.0;   ///< m, N m s/rad, N m s2/rad2 or N m by law; 0 for none, which has nothing to choose
  double frequency = absent;  ///< that it gives [Hz]: the wanted one, or where none would do the nearest
  bool calibrated = false;    ///< false: the law has no coefficient, or no value of it gives the frequency
};

/// The coefficient of `law` with which `design` flaps at `frequency` [Hz] at its own voltage, to 1e-9 relative.
CalibratedLaw calibrate_friction(Design<double> design, FrictionLaw law, double frequency);

/// The factor on S_3 with which `design` flaps at `frequency` [Hz] at its own voltage, to 1e-9 relative; absent where
/// none between 1 and 64 does.
double calibrate_drag(Design<double> design, double frequency);
/// The design with S_3 scaled; its other chord moments stay.
Design<double> with_drag_factor(Design<double> design, double factor);

/// The loss along a spring of growing stiffness, the frequency held: how a law answers to the force in the mechanism.
struct LossCurve {
  std::vector<double> stiffness;         ///< of each hinge [N m/rad]
  std::vector<Metrics<double>> metrics;  ///< absent where the frequency cannot be held
};
LossCurve loss_along_stiffness(const Design<double>& design, double frequency, double max_stiffness, int points);

/// Efficiency of a motor at a voltage [V] under the constant load that is best for it [1].
double best_constant_load_efficiency(const Motor<double>& motor, double voltage);

}  // namespace wingbeat
