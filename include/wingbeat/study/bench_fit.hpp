// Fitting a vehicle's parameters to bench measurements: weighted, bounded, robust least squares with exact derivatives
// through the orbit, and what the data can and cannot tell.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/study/for_each.hpp"
#include "wingbeat/study/frequency_search.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

/// Quantities of a waveform.
enum class WaveformQuantity {
  crank_speed,
  current,
  flapping_velocity,
  lift,
  rod_force,
  motor_torque,
  stroke_angle,
  pitch_angle,
  voltage,
  balance_force  ///< what a balance reads of the lift, see Balance
};
inline constexpr int waveform_quantity_count = 10;
/// The name outside the program ("crank_speed") and the SI unit.
const char* name_of(WaveformQuantity quantity);
const char* unit_of(WaveformQuantity quantity);

/// What a column of a log holds: a metric of the cycle, or a quantity at a crank angle.
struct MeasuredQuantity {
  bool waveform = false;
  Metric metric = Metric::frequency;
  WaveformQuantity quantity = WaveformQuantity::current;
  auto operator<=>(const MeasuredQuantity&) const = default;
};
std::string name_of(const MeasuredQuantity& quantity);
const char* unit_of(const MeasuredQuantity& quantity);

/// What was set on the bench; the other one follows.
enum class Given { voltage, frequency };
template <>
inline constexpr std::pair<const char*, Given> names_of<Given>[] = {{"voltage", Given::voltage},
                                                                    {"frequency", Given::frequency}};

/// One row of a log; of a waveform log, one instant of the cycle.
struct BenchRow {
  int line = 0;        ///< in its file
  double given = 0.0;  ///< voltage [V] or frequency [Hz]
  /// Of a waveform log: the crank angle (direct drive: phase of its supply), or the time in a log in time, as share of
  /// the period times 2 pi [rad].
  double crank_angle = 0.0;
  std::vector<double> values;           ///< SI, one per column; NaN where none was measured
  std::vector<double> deviations = {};  ///< their standard deviations where the log shows them; else empty or NaN
  int burst = 0;                        ///< of a waveform log: rows of one burst are of one operating point
  double drive_frequency = absent;      ///< of a direct drive, where the log shows it [Hz]
};

/// A balance on which the vehicle stands: a mass on a damped spring. Mass and damping are those of all that moves with
/// its spring.
struct Balance {
  double mass = 0.0;       ///< [kg]
  double stiffness = 0.0;  ///< [N/m]
  double damping = 0.0;    ///< [N s/m]
};

/// One number of a balance, as bench files name it in [balance].
struct BalanceNumber {
  const char *key, *unit;
  double Balance::* number;
  bool may_be_zero;
};
inline constexpr BalanceNumber balance_numbers[] = {{"mass", "kg", &Balance::mass, false},
                                                    {"stiffness", "N/m", &Balance::stiffness, false},
                                                    {"damping", "N s/m", &Balance::damping, true}};

struct BenchLog {
  std::string file;
  Condition condition = Condition::air;
  bool springs = false;  ///< false: the vehicle's springs are taken off
  Given given = Given::voltage;
  bool waveform = false;          ///< rows are instants of one cycle for each burst
  bool in_time = false;           ///< of a waveform: rows are at shares of the period
  bool phase_known = false;       ///< of a log in time: its zero is the crank angle 0
  bool frequency_stated = false;  ///< of a log in time: the bench file says about which frequency the cycle has
  std::vector<WaveformQuantity> unknown_zeros = {};  ///< quantities measured from a zero that is not known
  std::vector<MeasuredQuantity> columns;
  std::vector<BenchRow> rows;
  int values_left_out = 0;         ///< cells without a value
  std::vector<int> rows_left_out;  ///< their lines
  /// Of a direct drive whose frequency is given: the amplitude of its supply [V]; the vehicle's where it is empty.
  std::optional<double> amplitude = {};
};

/// Standard deviation of a column's values.
struct Deviation {
  /// `scatter`: each value has its own, of its log.
  enum class Kind { absolute, relative, estimated, scatter } kind = Kind::estimated;
  double value = 0.0;  ///< SI, or a fraction
};

/// A number of the bench that is fitted beside the vehicle's parameters.
struct BenchUnknown {
  enum class Kind {
    balance,  ///< a number of it
    phase,    ///< of a log in time: the cycle's where its burst has the phase 0 [rad]
    zero      ///< of a column of a log: what it shows at 0 [SI]
  } kind;
  std::size_t log = 0;                                         ///< of a phase or zero
  int burst = 0;                                               ///< of a phase
  WaveformQuantity quantity = WaveformQuantity::stroke_angle;  ///< of a zero
  const BalanceNumber* of_balance = nullptr;
};

struct FreeParameter {
  DesignParameter parameter;   ///< of a number of the bench key and unit alone
  double lower, upper, start;  ///< SI
  std::optional<BenchUnknown> of_bench = {};
};

/// A number of the balance by its key, "balance.mass"; empty for any other key.
std::optional<BenchUnknown> balance_unknown(const std::string& key);

enum class Loss { none, huber, soft_l1, cauchy };
template <>
inline constexpr std::pair<const char*, Loss> names_of<Loss>[] = {
    {"none", Loss::none}, {"huber", Loss::huber}, {"soft-l1", Loss::soft_l1}, {"cauchy", Loss::cauchy}};

/// Where a robust loss may turn from square to robust [standard deviations]: further in too few values carry the fit,
/// further out outliers do.
inline constexpr double min_loss_scale = 1.0, max_loss_scale = 4.0;

struct BenchFit {
  Design<double> design;  ///< with the springs of the logs that have them
  std::vector<BenchLog> logs;
  std::map<MeasuredQuantity, Deviation> deviations;
  std::vector<FreeParameter> parameters;
  std::optional<Balance> balance;  ///< needed where a log has its readings
  Loss loss = Loss::none;
  double loss_scale = 1.5;  ///< where the loss turns from square to robust, in standard deviations
  int starts = 1;           ///< the given start, and starts - 1 points of a Latin hypercube within the bounds
  std::uint64_t seed = 1;
  bool profiles = true;
  double tolerance = 1e-7;  ///< of the orbits
};

/// Why the data do not determine a parameter.
enum class Undetermined {
  no,                 ///< they do
  without_influence,  ///< no measured quantity depends on it
  free_with_others    ///< changes of it and others together leave all measured quantities as they are
};

/// A parameter as the data see it.
struct FittedParameter {
  std::string key, unit;
  enum class Of { vehicle, balance, log } of = Of::vehicle;  ///< what it is a number of
  std::optional<double> value;                               ///< empty: the data do not determine it
  double kept = 0.0;                                         ///< what the fitted vehicle has
  double standard_error = absent;
  double lower_95 = absent, upper_95 = absent;                  ///< from the standard error
  double profile_lower_95 = absent, profile_upper_95 = absent;  ///< from the loss's profile; absent where not computed
  double quantile_95 =
      absent;  ///< of its error, in standard errors: normal, or Student's where a deviation is estimated
  double profile_rise_95 = absent;  ///< of the loss, at the ends of the profile's interval
  bool at_bound = false;
  Undetermined undetermined = Undetermined::no;
  struct ProfilePoint {
    double value, excess;  ///< rise of the loss (without a robust one -2 ln L) over its least, the others free
  };
  std::vector<ProfilePoint> profile;
};

template <>
inline constexpr std::pair<const char*, FittedParameter::Of> names_of<FittedParameter::Of>[] = {
    {"vehicle", FittedParameter::Of::vehicle},
    {"balance", FittedParameter::Of::balance},
    {"log", FittedParameter::Of::log}};

/// One thing that the data tell of parameters, or cannot tell; in words: describe() of report/fit_report.hpp.
struct FitFinding {
  enum class Kind {
    without_influence,   ///< no measured quantity depends on the parameters
    left_free,           ///< a direction of which the data know nothing, or less than its own size
    known_roughly,       ///< a direction that the data fix to no better than a fifth
    determined,          ///< the parameters
    most_correlated,     ///< of those determined the two with the strongest correlation, the number
    determined_by,       ///< the condition alone determines the parameters
    narrowed_by,         ///< without the condition the intervals would be wider, by the numbers' factors
    product_of_friction  ///< the parameter is a product that no such measurement takes apart
  };
  Kind kind;
  std::vector<std::string> parameters = {};  ///< keys; of a direction by the size of their share in it
  std::vector<double> numbers = {};          ///< one for each parameter: of a direction its components
  double relative_error = absent;            ///< of a direction: standard error along it [1], may be infinite
  std::string condition = {};                ///< "air", "air with springs"
};

/// A direction in parameter space (relative changes) and how well the data fix it.
struct FitDirection {
  std::vector<double> components;  ///< of unit length, one per parameter
  double relative_error;           ///< standard error along it [1]; infinity where nothing is known
};

struct FitPoint {
  std::size_t log, row, column;
  double measured, fitted, deviation;  ///< SI; fitted is absent where the model does not reach the row
  double weight = 1.0;                 ///< under the robust loss, 0 to 1
  double residual() const { return (measured - fitted) / deviation; }
};

/// A row that the fitted model does not reach; in words: describe() of report/describe.hpp.
struct UnreachedRow {
  std::size_t log, row;
  FlappingStatus status;
  StatusEvidence evidence;               ///< what shows the status, unless a frequency is refused
  std::optional<SearchFinding> refused;  ///< why the frequency cannot be reached
};

/// The fitted model's course of one quantity over the cycle of a waveform.
struct FittedCycle {
  std::size_t log, row, column;  ///< the first row of its burst
  bool in_time = false;          ///< values are equally spaced in time; else by the crank angle
  double phase = 0.0;            ///< of the cycle where the log's phase is 0 [rad]
  std::vector<double> values;    ///< from phase 0 to 2 pi, both ends included [SI]
};

/// What one condition contributes.
struct ConditionShare {
  std::string name;  ///< "air", "air with springs"
  int points = 0;
  double rms = 0.0;                   ///< of its residuals, in standard deviations
  std::vector<double> share;          ///< of the information on each parameter, the others known [1]
  std::vector<double> error_without;  ///< standard error of each parameter without this condition; infinity: lost
};

/// What is left of one measured quantity beside the fitted model.
struct QuantityResiduals {
  MeasuredQuantity quantity;
  int values = 0;
  bool estimated = false;                ///< the deviation is that of the residuals themselves
  double rms = 0.0;                      ///< of the residuals, in standard deviations
  double unexplained = absent;           ///< sum of squares of the residuals over that about the values' mean [1]
  double relative = absent;              ///< rms of the residuals over that of the values [1]
  double measured_over_fitted = absent;  ///< median
};

/// How a fitted model misses the data.
struct Misfit {
  QuantityResiduals worst;  ///< the quantity whose residuals say so, or say it most
  /// Of the values with stated deviations, under a robust loss of residuals bounded to 1.5; absent where
  /// `worst.estimated`.
  double chi_square = absent;
  double freedom = absent;         ///< degrees of freedom that it is to be compared with
  double spread = absent;          ///< standard deviation of chi square, of a model that describes the data
  double rms_deviations = absent;  ///< rms of those residuals in their stated deviations
};

/// [fit] starts at most.
inline constexpr int max_fit_starts = 1000;

struct FitResult {
  bool converged = false;
  std::string message;
  /// Where the fitted model does not describe the data. Standard errors, intervals, covariances and findings are absent
  /// then: they suppose a model that the data obey.
  std::optional<Misfit> misfit;
  double p_value = absent;  ///< chance of residuals as large under the stated deviations
  std::vector<QuantityResiduals> quantities;
  Design<double> design;                        ///< fitted; parameters not determined keep their start
  std::vector<FittedParameter> parameters;      ///< those of the fit, then phases and zeros of the logs
  std::vector<std::vector<double>> covariance;  ///< SI; rows of parameters not determined are absent (NaN)
  std::vector<std::vector<double>> correlation;
  std::vector<FitDirection> directions;  ///< best known first
  std::vector<FitFinding> findings;
  std::vector<ConditionShare> conditions;
  std::vector<FitPoint> points;
  std::vector<FittedCycle> cycles;  ///< of the waveforms that the model reaches
  std::vector<UnreachedRow> unreached;
  std::map<MeasuredQuantity, double> estimated_deviations;  ///< SI
  double deviance = 0.0;                                    ///< -2 ln L up to a constant that only depends on the data
  double chi_square = 0.0;                                  ///< of the points reached
  int degrees_of_freedom = 0;
  double aicc = 0.0;         ///< corrected Akaike information criterion
  int starts_converged = 0;  ///< starts that ended in the same least
  int starts_elsewhere = 0;  ///< starts that ended in a higher one
  int evaluations = 0;       ///< orbits computed
};

/// Throws ParameterError for parameters without a place in the design, bounds out of order, quantities that the design
/// does not have. `progress` is called now and then with what is under way, by one thread at a time. Rows, starts and
/// profiles are solved by `for_each`; what is found does not depend on it.
FitResult fit_bench(const BenchFit& fit, const std::function<void(const std::string&)>& progress = {},
                    const ForEach& for_each = {});

/// One friction law fitted to the same data.
struct FrictionCandidate {
  FrictionLaw law;
  FitResult result;
  double aicc_excess = 0.0;  ///< over the best law's
  /// Condition left out -> rms of its prediction errors in standard deviations; infinity: a row is not reached.
  std::vector<std::pair<std::string, double>> left_out;
  double prediction_error = 0.0;  ///< rms over all of them
  // With and without the design's springs at `spring_frequency`, air; absent without springs or where not reached.
  double spring_frequency = absent, power_springs_off = absent, power_springs_on = absent;
};

/// Fits every law in place of the free friction parameter; best AICc first. Throws ParameterError unless a friction
/// parameter is free.
std::vector<FrictionCandidate> compare_friction(const BenchFit& fit,
                                                const std::function<DesignParameter(const std::string&)>& parameter_of,
                                                const std::function<void(const std::string&)>& progress = {},
                                                const ForEach& for_each = {});

/// "air", "vacuum with springs".
std::string condition_name(Condition condition, bool springs);

}  // namespace wingbeat
