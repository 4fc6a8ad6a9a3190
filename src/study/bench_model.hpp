// The model at every operating point of a bench, with derivatives by the parameters that are fitted.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/study/bench_fit.hpp"
#include "wingbeat/study/for_each.hpp"
#include "wingbeat/study/frequency_search.hpp"

namespace wingbeat {

/// One operating point of the bench with everything measured there.
struct OperatingPoint {
  Condition condition;
  bool springs;
  Given given;
  double value;
  std::size_t log, row;                        ///< of its first measurement
  std::vector<double> crank_angles = {};       ///< of a waveform, as BenchRow has them [rad]
  std::vector<std::size_t> observations = {};  ///< indices
  bool peaks = false;
  bool in_time = false;                   ///< crank_angles are shares of the period
  bool on_balance = false;                ///< its readings are among the measurements
  double drive_frequency = absent;        ///< of a direct drive, where the log shows it [Hz]
  std::optional<std::size_t> phase = {};  ///< the free parameter that is added to crank_angles
};

struct Observation {
  std::size_t log, row, column;
  MeasuredQuantity quantity;
  std::size_t point;
  std::size_t instant = 0;  ///< index of its crank angle at the point
  double measured;
  double deviation = absent;             ///< as its log has it
  std::optional<std::size_t> zero = {};  ///< the free parameter that is added to it
};

struct Prediction {
  bool reached = false;
  FlappingStatus status = FlappingStatus::stalled;
  StatusEvidence evidence;
  std::optional<SearchFinding> refused;
};

/// The model at all points of the bench, with derivatives; remembers the last parameters it was asked for. What it
/// finds depends on what it (or the model it is a copy of) was asked for before, not on threads.
class BenchModel {
 public:
  /// Keeps a reference to the fit. The points are solved by `for_each`.
  explicit BenchModel(const BenchFit& fit, const ForEach& for_each = {});

  const BenchFit& fit() const { return fit_; }
  const std::vector<OperatingPoint>& points() const { return points_; }
  const std::vector<Observation>& observations() const { return observations_; }
  const std::vector<Prediction>& predictions() const { return predictions_; }
  /// By observation [SI].
  const std::vector<double>& fitted() const { return fitted_; }
  /// d fitted / d parameter, SI; rows of points not reached are zero.
  const Eigen::MatrixXd& jacobian() const { return jacobian_; }
  /// The parameters last asked for [SI].
  const std::vector<double>& x() const { return x_; }
  /// Orbits computed so far.
  int evaluations() const;

  /// The fit's design with the free parameters at x [SI].
  Design<double> design_at(const std::vector<double>& x) const;
  void evaluate(const std::vector<double>& x, bool derivatives);

  /// The parameters x with the phases of logs in time where their courses are most alike the model's.
  std::vector<double> aligned(std::vector<double> x);
  /// The courses of the waveforms reached, at `count` instants each.
  std::vector<FittedCycle> cycles(int count) const;

 private:
  SteadyFlapping orbit(std::size_t n, Vehicle<double>& vehicle, double voltage, const Reporting& reporting);
  /// `refused`: the search, where the frequency cannot be reached.
  SteadyFlapping orbit_at_frequency(std::size_t n, Vehicle<double>& vehicle, const Reporting& reporting,
                                    std::optional<SearchFinding>& refused);
  void evaluate_point(std::size_t n, Design<double> design);
  /// By the vehicle's parameters `which`, in the order of the dual number's slots.
  void differentiate_point(std::size_t n, const Design<GradientJet>& seeded, std::span<const std::size_t> which);
  Balance balance_at(const std::vector<double>& x) const;
  /// Of a log in time: the time of an instant as share of the period, 0 to 1.
  double periods(const OperatingPoint& point, std::size_t instant) const;
  /// The time of an instant of any waveform as share of the period, 0 to 1.
  double instant_periods(std::size_t n, std::size_t instant) const;
  void place_instants(std::size_t n);
  /// A waveform as it would be measured from a known zero, at times in periods (or crank angles in turns).
  std::vector<double> course(std::size_t n, WaveformQuantity quantity, std::span<const double> places) const;

  const BenchFit& fit_;
  ForEach for_each_;
  std::vector<OperatingPoint> points_;
  std::vector<Observation> observations_;
  std::vector<Prediction> predictions_;
  std::vector<SteadyFlapping> orbits_;
  /// By point: crank angles of its instants, behind them those of the balance's; harmonics of the lift.
  std::vector<std::vector<double>> thetas_;
  std::vector<std::vector<std::complex<double>>> lifts_;
  // Of points whose frequency is set: the voltage last found, df/dv there, and the voltage's gradient with the voltage
  // and the parameters it belongs to.
  struct VoltageSlopes {
    double voltage = absent;
    std::vector<double> x, by_parameter;
  };
  std::vector<double> voltages_, frequency_slopes_;
  std::vector<VoltageSlopes> voltage_slopes_;
  std::vector<double> fitted_, x_;
  Eigen::MatrixXd jacobian_;
  bool derivatives_known_ = false;
  std::vector<int> evaluations_;  ///< by point
};

}  // namespace wingbeat
