// Controllers of flight that the program designs from the linear model about a trim; docs/flight.md.
#pragma once

#include <Eigen/Core>
#include <array>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wingbeat/flight/riccati.hpp"
#include "wingbeat/flight/stability.hpp"

namespace wingbeat {

enum class ControllerType {
  none,  ///< controls are held
  lqr,   ///< linear-quadratic regulator
  pid    ///< cascade: position, velocity, attitude, rates
};
template <>
inline constexpr std::pair<const char*, ControllerType> names_of<ControllerType>[] = {
    {"none", ControllerType::none}, {"lqr", ControllerType::lqr}, {"pid", ControllerType::pid}};

/// What a controller steers: each by one control or more.
enum class FlightAxis { climb, pitch, roll, yaw };
inline constexpr std::size_t flight_axis_count = 4;
template <>
inline constexpr std::pair<const char*, FlightAxis> names_of<FlightAxis>[] = {
    {"climb", FlightAxis::climb}, {"pitch", FlightAxis::pitch}, {"roll", FlightAxis::roll}, {"yaw", FlightAxis::yaw}};

/// The state of the linear model that each axis steers: w, q, p, r.
inline constexpr Eigen::Index steered_row[flight_axis_count] = {2, 4, 3, 5};

/// Largest deviations, by which Bryson's rule weighs: each adds 1 to the cost at its size.
struct RegulatorSizes {
  double position = 0.1;   ///< [m]
  double heading = 0.3;    ///< [rad]
  double velocity = 0.3;   ///< [m/s]
  double attitude = 0.2;   ///< roll and pitch [rad]
  double rates = 4.0;      ///< [rad/s]
  double integral = 0.15;  ///< of position [m s]; of the heading in the ratio of their sizes; 0: no integrals
  /// Share of the way from trim to the nearer limit [1]; 0: 0.5, of direct drives, whose waves bear less, 0.1.
  double controls = 0.0;
};

/// Bandwidths of the loops [rad/s]; those not given follow from the wingbeat and the delay.
struct LoopBandwidths {
  std::optional<double> position, velocity, attitude, rates;
};

/// Gains of an innermost loop, from an error of the rate (of climb: of the vertical velocity) to the control.
struct LoopGains {
  std::optional<double> proportional, integral, derivative;
};

struct ControllerOptions {
  ControllerType type = ControllerType::lqr;
  double rate = 0.0;  ///< [Hz]; 0: eight times in a wingbeat
  RegulatorSizes sizes;
  LoopBandwidths bandwidths;
  std::array<LoopGains, flight_axis_count> gains;  ///< in place of those designed
  double max_tilt = 0.5;                           ///< that the cascade asks for [rad]
  double max_speed = 1.5;                          ///< that the cascade asks for [m/s]
};

/// What a controller is designed for.
struct ControlTask {
  const FlightVehicle* vehicle = nullptr;
  TrimResult trim;
  FlightLinearModel linear;
  double delay = 0.0;                                       ///< from a motion to the command that answers it [s]
  std::array<double, flight_control_count> lag{};           ///< time constant of each actuator and its drive [s]
  std::array<double, flight_control_count> actuator_lag{};  ///< that of the actuator alone [s]
  std::array<double, flight_control_count> speed{};  ///< largest rate of each control [1/s of its unit]; 0: no limit
};

/// Where the vehicle is to be, in earth axes.
struct FlightReference {
  Triple position{}, velocity{};
  double yaw = 0.0, yaw_rate = 0.0;
};

/// What sensors say of the body.
struct FlightMeasurement {
  Triple position{};  ///< earth axes [m]
  Triple velocity{};  ///< body axes [m/s]
  Triple angles{};    ///< roll, pitch, yaw [rad]
  Triple rates{};     ///< [rad/s]
};

/// x, y, z, yaw, u, v, w, p, q, r, roll, pitch.
inline constexpr std::size_t regulated_state_count = 12;
inline constexpr std::array<const char*, regulated_state_count> regulated_state_names = {
    "x_m",       "y_m",         "z_m",         "yaw_rad",     "u_m_per_s", "v_m_per_s",
    "w_m_per_s", "p_rad_per_s", "q_rad_per_s", "r_rad_per_s", "roll_rad",  "pitch_rad"};
using RegulatedState = Eigen::Matrix<double, 12, 1>;

/// The linear model of a trim with position and heading, which do not act on the rest.
LinearPlant regulated_plant(const FlightLinearModel& linear, const TrimResult& trim);

/// What was designed.
struct ControllerDesign {
  ControllerType type = ControllerType::none;
  std::vector<FlightControl> controls;  ///< that are used
  std::array<std::optional<FlightControl>, flight_axis_count> by_axis{};
  std::vector<std::string> uncontrolled;  ///< a sentence for each axis without control
  double delay = 0.0;                     ///< taken into account [s]
  // lqr
  Eigen::MatrixXd gains;  ///< of `controls` by the twelve states; 0 for states left alone
  double riccati_residual = absent;
  double spectral_radius = absent;  ///< of the sampled closed loop
  // pid
  double position = absent, velocity = absent, attitude = absent, rates = absent;  ///< bandwidths [rad/s]
  std::array<LoopGains, flight_axis_count> loops{};
};

/// A controller in flight. The controls that step() gives are within their ranges and rates.
class FlightController {
 public:
  /// Throws ParameterError where no controller stabilises the vehicle, in a sentence.
  FlightController(const ControllerOptions& options, ControlTask task);

  /// At one instant of control after another.
  FlightControls step(const FlightMeasurement& measured, const FlightReference& reference);
  const ControllerDesign& design() const { return design_; }

 private:
  void design_regulator();
  LinearPlant plant_with_actuators() const;
  void design_cascade();
  FlightControls regulate(const FlightMeasurement& m, const FlightReference& r);
  FlightControls cascade(const FlightMeasurement& m, const FlightReference& r);
  void drive_axis(FlightAxis axis, double wanted, double measured, FlightControls& controls);
  double limited(FlightControl which, double value) const;

  ControllerOptions options_;
  ControlTask task_;
  ControllerDesign design_;
  FlightControls last_;
  double step_ = 0.0;
  // lqr
  std::vector<Eigen::Index> kept_, integrated_;
  Eigen::MatrixXd K_;
  Eigen::VectorXd integrals_, actuators_;
  std::deque<Eigen::VectorXd> sent_;  ///< commands that do not act yet on what is measured, the newest first
  // pid
  Triple velocity_integral_{};
  std::array<double, flight_axis_count> rate_integral_{};
  std::array<double, flight_axis_count> last_rate_{}, slope_{};
  bool first_ = true;
};

}  // namespace wingbeat
