// The least squares of motor identification, at the sheet's shaft.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "study/motor_data.hpp"

namespace wingbeat::detail {

/// Least squares of the data, as far as they determine the unknowns.
struct MotorFit {
  MotorFit(const MotorDatasheet& sheet, const std::vector<Datum>& data);

  const std::vector<Datum>& data;
  LossScales scales{};
  double x[unknowns] = {};
  double R = 0.0, K = 0.0;         ///< [ohm], [N m/A]
  double speed = 0.0, loss = 0.0;  ///< about the no-load speed [rad/s], and the torque lost there [N m]
  bool electrical = false;         ///< the data determine R and K
  bool has_resistance = false;     ///< or R alone
  // Which losses they determine: constant and viscous ones, one kind, constant ones alone.
  bool both = false, one = false, only_constant = false;
  double birge_ratio = 1.0;

  bool losses_known() const { return both || one || only_constant; }
  double friction_torque() const { return x[friction] * scales.friction; }  ///< [N m]
  double viscous_damping() const { return x[damping] * scales.damping; }    ///< [N m s/rad]
  /// Standard error of an unknown.
  double error(Unknown k) const { return std::sqrt(std::max(covariance_(k, k), 0.0)); }

 private:
  void guess(const MotorDatasheet& sheet);
  void choose_unknowns(const MotorDatasheet& sheet);
  void fit();
  Eigen::MatrixXd sensitivities() const;

  std::vector<int> free_;
  Eigen::MatrixXd covariance_ = Eigen::MatrixXd::Zero(unknowns, unknowns);
};

}  // namespace wingbeat::detail
