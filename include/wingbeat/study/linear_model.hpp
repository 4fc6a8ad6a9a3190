// Control models of a vehicle at an operating point: the cycle-to-cycle linear model, its modes, its continuous-time
// equivalent and its step responses.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "wingbeat/cycle/cycle_map.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {

/// An eigenvalue \f$\mu\f$ of A. Of a complex pair the one with a positive imaginary part stands for both. With the
/// period T of the orbit:
/// \f[
/// s = \frac{\ln\mu}{T}, \qquad \tau = -\frac{1}{\operatorname{Re} s} = -\frac{T}{\ln|\mu|}, \qquad
/// \omega_\mathrm{n} = |s|, \qquad \zeta = -\frac{\operatorname{Re} s}{|s|}
/// \f]
struct CycleMode {
  std::complex<double> multiplier;
  double time_constant;      ///< \f$\tau\f$, in which it fades to 1/e; negative: it grows [s]
  double natural_frequency;  ///< \f$\omega_\mathrm{n}\f$ [rad/s]
  double damping_ratio;      ///< \f$\zeta\f$ [1]
  bool settled;              ///< fades within a cycle, or alternates: left out of the continuous-time model
};

/// x' = A x + B u, y = C x + D u. Held inputs and outputs sampled every T give the cycle-to-cycle model without its
/// settled modes, whose steady part is in D: y(k T) is the mean of the cycle that begins at k T.
struct ContinuousModel {
  std::vector<CycleSignal> states;  ///< as many of the model's as there are modes left: their unsettled part
  Eigen::MatrixXd a, b, c, d;
};

struct LinearModel {
  CycleMap map;
  std::vector<CycleMode> modes;  ///< the slowest first
  Eigen::MatrixXd steady_gain;   ///< \f$C (I - A)^{-1} B + D\f$; not finite where an eigenvalue is 1
  ContinuousModel continuous;
  /// Of each input, one column for each output: the outputs of cycles 0, 1, ... after a unit step at cycle 0.
  std::vector<Eigen::MatrixXd> step_responses;

  /// A cycle fades to less than this part of a settled mode.
  static constexpr double settled_multiplier = 1e-4;
};

/// The model of a linearised cycle, with step responses of `cycles` cycles; 0: about five of the slowest time constant,
/// 10 to 400.
LinearModel linear_model_of(const CycleMap& map, int cycles = 0);

struct Linearisation {
  RunResult operating_point;         ///< as run_design() gives it, its design with the voltage that was found
  SteadyFlapping orbit;              ///< of that design, to a tolerance of 1e-10
  std::optional<LinearModel> model;  ///< where it flaps in an orbit
};

/// Linearises a validated design at the operating point that `options` asks for (a frequency or a lift instead of the
/// voltage). Method::orbit alone. Throws ParameterError as run_design().
Linearisation linearise(const Design<double>& design, const RunOptions& options = {}, int cycles = 0);

}  // namespace wingbeat
