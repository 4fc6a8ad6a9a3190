// Measured sets of vehicles beside what the model says of them: with nothing fitted, with one parameter fitted, with
// those that a fit may touch. The rows are split by rule into fitted ones and predicted ones.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "wingbeat/study/allocation.hpp"
#include "wingbeat/study/bench_fit.hpp"
#include "wingbeat/study/flight_numbers.hpp"
#include "wingbeat/study/prescribed_flapping.hpp"

namespace wingbeat {

/// What computes the numbers to be compared.
enum class ValidationModel {
  none,               ///< nothing can be predicted
  prescribed,         ///< mean lift along a stated stroke and pitch
  bench,              ///< a metric of steady flapping over voltage, or over voltage and frequency
  passive_pitch,      ///< pitch under a stated stroke
  ratios,             ///< exponents and ratios of a vehicle near hover
  prescribed_flight,  ///< mean loads along a stated stroke and pitch in forward flight
  flight,             ///< trim, modes and maps of a vehicle with a body in hover
  maps,               ///< lift and moments over what commands the drives
  resistance          ///< a battery's resistance, one number at every frequency
};
template <>
inline constexpr std::pair<const char*, ValidationModel> names_of<ValidationModel>[] = {
    {"none", ValidationModel::none},
    {"prescribed", ValidationModel::prescribed},
    {"bench", ValidationModel::bench},
    {"passive-pitch", ValidationModel::passive_pitch},
    {"ratios", ValidationModel::ratios},
    {"prescribed-flight", ValidationModel::prescribed_flight},
    {"flight", ValidationModel::flight},
    {"maps", ValidationModel::maps},
    {"resistance", ValidationModel::resistance}};

/// Which rows a fit may see.
enum class ValidationSplit {
  alternate,  ///< the first, third, fifth, ... operating point in the order of what was set; the others are predicted
  amplitude,  ///< of one operating point: amplitudes; phases are predicted
  none        ///< nothing is fitted
};
template <>
inline constexpr std::pair<const char*, ValidationSplit> names_of<ValidationSplit>[] = {
    {"alternate", ValidationSplit::alternate},
    {"amplitude", ValidationSplit::amplitude},
    {"none", ValidationSplit::none}};

/// One measured number.
struct ValidationPoint {
  std::string label;         ///< what was set: "180 V, 160 Hz"
  double position = absent;  ///< along the horizontal axis of figures
  std::size_t quantity = 0;
  double measured = absent;  ///< in the quantity's unit
  bool fitted = false;       ///< a fit sees it
};

struct ComparedQuantity {
  std::string name, unit;
  bool has_size = true;  ///< differences may be counted in shares of it; not of a phase
};

/// One wing or more along the motion of each point; lift in `unit` newtons.
struct PrescribedProblem {
  Planform<double> planform;
  double count = 1.0;
  double air_density = absent;  ///< [kg/m3]
  std::vector<PrescribedFlapping> motions;
  double unit = 1.0;  ///< [N]
};
/// Wings along one motion in steady flight ahead; each point is one of these.
struct PrescribedFlightProblem {
  Planform<double> planform;
  double count = 2.0;
  double air_density = absent;  ///< [kg/m3]
  PrescribedFlapping motion;
  double speed = 0.0;              ///< [m/s]
  double stroke_plane_tilt = 0.0;  ///< nose up [rad]
  std::vector<double PrescribedFlightLoads::*> gives;
};
struct BenchProblem {
  Design<double> design;
  Metric metric = Metric::lift_mean;
  double metric_per_value = 1.0;    ///< SI value of the metric over the measured number
  std::vector<double> voltages;     ///< of each point, amplitude of a sine [V]
  std::vector<double> frequencies;  ///< of each point [Hz]; absent: the design's
  std::vector<FreeParameter> parameters;
  std::size_t one = 0;  ///< the parameter that is fitted alone
};
/// The points are in degrees; those of quantity 0 are amplitudes, those of quantity 1 phases.
struct PassivePitchProblem {
  Design<double> design;
  double frequency = absent;     ///< [Hz]
  std::vector<double> strokes;   ///< of each point, amplitude [rad]
  bool first_harmonics = false;  ///< amplitudes are those of first harmonics, else half of psi from peak to peak
  std::vector<FreeParameter> parameters;
  std::size_t one = 0;
};
/// Of a vehicle at hover; each point is one of these.
struct RatiosProblem {
  enum class Kind {
    lift_exponent,  ///< d ln(lift) / d ln(frequency), the voltage following
    damping_ratio   ///< of the forces along x by u and along z by w
  };
  Design<double> design;
  std::vector<Kind> kinds;
};
/// Static maps about the operating point of a vehicle whose sides are alike.
struct MapsProblem {
  /// What a quantity of the set is.
  struct Map {
    AllocationInput input = AllocationInput::voltage;
    double AllocationPoint::* gives = &AllocationPoint::lift;
    double per_value = 1.0;  ///< SI value of the map over the measured number; < 0 where the source counts it opposite
  };
  Design<double> design;
  double hinge_offset = 0.0;   ///< [m]
  std::vector<Map> maps;       ///< by quantity
  std::vector<double> inputs;  ///< of each point, of its map [V] or [1]
};
struct ResistanceProblem {};
/// Of a vehicle with a body in hover: the first quantities are its numbers, the others its maps.
struct FlightProblem {
  struct Map {
    FlightControl control = FlightControl::voltage;
    FlightLoad load = FlightLoad::lift;
    std::vector<double> settings;  ///< of each point
  };
  FlightVehicle vehicle;
  std::vector<FlightNumber> numbers;
  std::vector<Map> maps;
  std::vector<double> per_value;  ///< of each quantity: SI value over the measured number
};

using ValidationProblem =
    std::variant<std::monostate, PrescribedProblem, BenchProblem, PassivePitchProblem, RatiosProblem, MapsProblem,
                 ResistanceProblem, PrescribedFlightProblem, FlightProblem>;

/// A measured set and what is to be computed of it.
struct ValidationSet {
  std::string name, vehicle, source, licence, measured, uncertainty, unknown, remarks;
  ValidationModel model = ValidationModel::none;
  ValidationSplit split = ValidationSplit::alternate;
  std::vector<std::string> operating_point;  ///< columns that make it
  std::string reason;                        ///< why nothing can be predicted
  std::vector<std::string> assumes, not_predicted;
  int rows = 0;                                               ///< of the data
  std::string vehicle_file;                                   ///< without folder; empty: none
  std::vector<std::pair<std::string, std::string>> settings;  ///< keys of the vehicle file that are set, and to what
  std::vector<ComparedQuantity> quantities;
  std::string position_name;  ///< of the horizontal axis, with unit
  std::vector<ValidationPoint> points;
  ValidationProblem problem;
};

/// Marks the points that a fit may see by the rule `alternate`: `operating_points` holds the number of each point's
/// operating point in the order of what was set, from 0.
void split_alternately(ValidationSet& set, const std::vector<std::size_t>& operating_points);

/// How far a model is off on rows of one kind.
struct ValidationMiss {
  std::size_t quantity = 0;
  bool fitted = false;       ///< of the rows that fits see, or of those that they do not
  int points = 0;            ///< reached by the model
  int unreached = 0;         ///< points without a computed number
  double rms = absent;       ///< of computed minus measured, in the quantity's unit
  double mean = absent;      ///< of the same
  double relative = absent;  ///< rms over the rms of the measured numbers [1]
};

/// The model with nothing fitted, or after one fit.
struct ValidationStage {
  std::string name;                         ///< "nothing fitted", "force_per_volt fitted"
  std::string variant;                      ///< of the model: coefficients and terms; empty where there is one
  std::vector<FittedParameter> parameters;  ///< what was fitted
  bool converged = true;
  std::optional<Misfit> misfit;   ///< why a fit has no intervals
  std::vector<double> predicted;  ///< by point, in its unit; absent where the model does not reach it
  std::vector<ValidationMiss> misses;
};

struct ValidationResult {
  std::vector<ValidationStage> stages;
};

/// Computes all stages of a set. Orbits are found by `for_each`; the result does not depend on it. `progress` is called
/// with what is under way. Throws ParameterError for designs that cannot be computed.
ValidationResult validate_set(const ValidationSet& set, const std::function<void(const std::string&)>& progress = {},
                              const ForEach& for_each = {});

}  // namespace wingbeat
