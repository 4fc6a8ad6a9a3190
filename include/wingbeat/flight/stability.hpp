// Small motions about steady flight: linear models and modes by averaging over the wingbeat, and by Floquet theory of
// the whole periodic flight; model.md section 18.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "wingbeat/flight/trim.hpp"

namespace wingbeat {

/// u, v, w [m/s], p, q, r [rad/s], roll and pitch [rad]; position and heading follow from them and act on nothing.
inline constexpr std::size_t flight_state_count = 8;
inline constexpr std::array<const char*, flight_state_count> flight_state_names = {
    "u_m_per_s", "v_m_per_s", "w_m_per_s", "p_rad_per_s", "q_rad_per_s", "r_rad_per_s", "roll_rad", "pitch_rad"};
using FlightVector = Eigen::Matrix<double, 8, 1>;
using FlightMatrix = Eigen::Matrix<double, 8, 8>;

/// u, v and w of the air, along the axes of the body in trim [m/s].
inline constexpr std::array<const char*, 3> wind_input_names = {"wind_u_m_per_s", "wind_v_m_per_s", "wind_w_m_per_s"};

/// Of the states about trim: x' = A x + B u + W w, where w is the velocity of the air.
struct FlightLinearModel {
  FlightMatrix A = FlightMatrix::Zero();
  Eigen::MatrixXd B;  ///< a column for each of `controls`
  Eigen::Matrix<double, 8, 3> W = Eigen::Matrix<double, 8, 3>::Zero();
  std::vector<FlightControl> controls;  ///< those that the vehicle has

  /// The column of a control in B; -1 of one that the vehicle does not have.
  Eigen::Index column_of(FlightControl control) const {
    const auto found = std::find(controls.begin(), controls.end(), control);
    return found == controls.end() ? -1 : Eigen::Index(found - controls.begin());
  }
};

/// One mode by either way, of a complex pair the one of positive imaginary part: within its kind of motion, by
/// averaging and by Floquet theory, each ordered by growth.
struct FlightMode {
  bool longitudinal = false;                     ///< else lateral
  std::optional<std::complex<double>> averaged;  ///< [1/s]
  std::string shape;                             ///< names of the largest states of the averaged mode
  std::optional<std::complex<double>> floquet;   ///< [1/s]; the logarithm of the multiplier over the period

  /// Distance of the two over the averaged one [1]; absent where one is missing, or one oscillates and the other not.
  double apart() const;
  static double doubling_time(std::complex<double> s) { return std::log(2.0) / s.real(); }  ///< < 0: halves
  static double period(std::complex<double> s) { return two_pi / std::abs(s.imag()); }
};

/// The whole flight, drives and body, that repeats with the wingbeat and moves in the mean as a condition has it.
struct PeriodicFlight {
  FlightControls controls;        ///< of which voltage and control of pitch differ from the averaged flight's trim
  std::array<double, 2> drift{};  ///< at the controls of that trim: mean speed ahead and downwards beside it [m/s]
  double period = 0.0;            ///< [s]
  FlightVector mean;              ///< of the states over the period
  std::vector<std::complex<double>> multipliers;
  std::vector<bool> longitudinal;  ///< of each multiplier, by its motion of the body
  double mismatch = 0.0;           ///< of end and start, of their sizes
};

struct StabilityResult {
  TrimResult trim;
  std::optional<FlightLinearModel> model;
  std::vector<FlightMode> modes;  ///< the least stable first
  std::optional<PeriodicFlight> periodic;
  std::string periodic_detail;  ///< why there is no periodic flight
};

/// The states of a trim.
FlightVector steady_states(const TrimResult& steady);

/// The averaged linear model about a trim that has a flight; none where the vehicle does not flap beside it.
std::optional<FlightLinearModel> linear_flight(AveragedFlight& flight, const TrimResult& steady);

/// Modes of the averaged flight alone, the least stable first; none where there is no linear model.
std::vector<FlightMode> averaged_modes(AveragedFlight& flight, const TrimResult& steady);

/// Modes by both ways.
StabilityResult flight_stability(AveragedFlight& flight, const TrimResult& steady);

/// Of the eigenvalue with the largest real part.
struct ModeSensitivity {
  std::string parameter;
  double value = 0.0;               ///< [SI]
  std::complex<double> eigenvalue;  ///< with the parameter 0.5 % larger [1/s]
  double slope = 0.0;               ///< change of the real part over the relative change of the parameter [1/s]
};
/// Central differences over +-0.5 % of these parameters, or of all that are not zero, each vehicle trimmed anew; the
/// largest first.
std::vector<ModeSensitivity> mode_sensitivities(const Design<double>& design, const FlightCondition& condition,
                                                const TrimOptions& options = {},
                                                const std::vector<std::string>& parameters = {});

}  // namespace wingbeat
