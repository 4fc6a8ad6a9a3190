#include "study/motor_fit.hpp"

// g++ 12 takes Eigen's resizing for a use of freed memory.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuse-after-free"
#endif
#include <ceres/ceres.h>

#include "study/least_squares.hpp"
#include "wingbeat/core/math.hpp"

namespace wingbeat::detail {
namespace {

struct Residuals {
  const std::vector<Datum>& data;
  const LossScales& scales;
  template <class T>
  bool operator()(T const* const* x, T* r) const {
    for (std::size_t n = 0; n < data.size(); ++n) {
      r[n] = (predicted(data[n], x[0], scales) - data[n].value) / (data[n].value * data[n].deviation);
    }
    return true;
  }
};

}  // namespace

MotorFit::MotorFit(const MotorDatasheet& s, const std::vector<Datum>& points) : data(points) {
  guess(s);
  choose_unknowns(s);
  if (electrical) fit();
  // A constant friction that nothing states must stand out of its own error.
  if (both && !s.friction_torque && x[friction] < 2.0 * error(friction)) {
    both = false;
    free_ = {resistance, constant, damping};
    x[friction] = 0.0;
    x[damping] = std::max(x[damping], 1.0);
    fit();
  }
  R = std::exp(x[resistance]);
  K = std::exp(x[constant]);
}

/// First guesses from whatever is there.
void MotorFit::guess(const MotorDatasheet& s) {
  const double v = s.voltage.value_or(1.0);
  R = s.resistance.value_or(s.stall_current ? v / *s.stall_current : 0.0);
  K = s.torque_constant.value_or(s.speed_constant ? 1.0 / *s.speed_constant : 0.0);
  if (!(K > 0.0) && s.stall_torque && s.stall_current) K = *s.stall_torque / *s.stall_current;
  if (!(K > 0.0) && s.no_load_speed) K = 0.95 * v / *s.no_load_speed;
  for (const MotorPoint& p : s.points) {
    if (!(K > 0.0) && p.torque && p.current && *p.current > 0.0) K = *p.torque / *p.current;
    if (!(R > 0.0) && K > 0.0 && p.speed && p.current && *p.current > 0.0) {
      R = std::max((p.voltage.value_or(v) - K * *p.speed) / *p.current, 0.0);
    }
  }
  if (!(R > 0.0) && K > 0.0 && s.stall_torque) R = K * v / *s.stall_torque;
  if (!(K > 0.0) && R > 0.0 && s.stall_torque) K = *s.stall_torque * R / v;
  if (!(R > 0.0)) R = 1.0;
  if (!(K > 0.0)) K = 1e-2;

  speed = s.no_load_speed.value_or(v / K);
  loss = s.no_load_current ? K * *s.no_load_current : s.friction_torque.value_or(0.0);
  if (!(loss > 0.0)) loss = s.viscous_damping ? *s.viscous_damping * speed : 0.02 * K * v / R;
  scales = {loss, loss / speed, s.shaft == Shaft::output ? s.gear_efficiency.value_or(1.0) : 1.0};
}

/// Of the data in their deviations.
Eigen::MatrixXd MotorFit::sensitivities() const {
  Eigen::MatrixXd jacobian(Eigen::Index(data.size()), int(unknowns));
  for (std::size_t row = 0; row < data.size(); ++row) {
    ceres::Jet<double, unknowns> jets[unknowns];
    for (int k = 0; k < unknowns; ++k) jets[k] = {x[k], k};
    const auto p = predicted(data[row], jets, scales);
    for (int k = 0; k < unknowns; ++k) {
      jacobian(Eigen::Index(row), k) = p.v[k] / (data[row].value * data[row].deviation);
    }
  }
  return jacobian;
}

/// Which unknowns the data determine: a column that the others and the data cannot replace.
void MotorFit::choose_unknowns(const MotorDatasheet& s) {
  x[resistance] = std::log(R);
  x[constant] = std::log(K);
  x[friction] = s.friction_torque ? 0.5 : 0.0;
  x[damping] = s.friction_torque ? 0.5 : 1.0;
  if (s.friction_torque) x[friction] = *s.friction_torque / scales.friction;
  if (s.viscous_damping) x[damping] = *s.viscous_damping / scales.damping;
  free_ = {resistance, constant};
  const auto rank_of = [&](const std::vector<int>& columns) {
    if (data.empty()) return Eigen::Index(0);
    const Eigen::MatrixXd all = sensitivities();
    Eigen::MatrixXd chosen(all.rows(), Eigen::Index(columns.size()));
    for (std::size_t c = 0; c < columns.size(); ++c) chosen.col(Eigen::Index(c)) = all.col(columns[c]);
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(chosen);
    qr.setThreshold(1e-4);
    return qr.rank();
  };
  // What friction could explain must not be taken for missing resistance: the electrical constants come first.
  electrical = rank_of({resistance, constant}) == 2;
  has_resistance = electrical || (rank_of({constant}) < rank_of({resistance, constant}) && s.resistance);
  both = electrical && rank_of({resistance, constant, friction, damping}) == 4;
  one = electrical && rank_of({resistance, constant, damping}) == 3;
  only_constant = electrical && !one && rank_of({resistance, constant, friction}) == 3;
  if (both) {
    free_.push_back(friction);
    free_.push_back(damping);
  } else if (only_constant || (one && s.friction_torque)) {
    free_.push_back(friction);
    x[damping] = 0.0;
  } else if (one) {
    free_.push_back(damping);
    x[friction] = 0.0;
  } else {
    // Losses unknown: the fallback or none for the fit of the rest.
    const double b_sheet = typical_motor_damping * (s.shaft == Shaft::output ? square(s.gear_ratio) : 1.0);
    x[friction] = 0.0;
    x[damping] = s.assume_typical_damping ? b_sheet / scales.damping : 0.0;
  }
}

void MotorFit::fit() {
  auto* cost = new ceres::DynamicAutoDiffCostFunction<Residuals, 4>(new Residuals{data, scales});
  cost->AddParameterBlock(unknowns);
  cost->SetNumResiduals(int(data.size()));
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, x);
  for (const int k : {friction, damping}) problem.SetParameterLowerBound(x, k, 0.0);
  std::vector<int> fixed;
  for (int k = 0; k < unknowns; ++k) {
    if (std::find(free_.begin(), free_.end(), k) == free_.end()) fixed.push_back(k);
  }
  if (!fixed.empty()) problem.SetManifold(x, new ceres::SubsetManifold(unknowns, fixed));
  const ceres::Solver::Options options = least_squares(500, 1e-16, 1e-12);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  const Eigen::MatrixXd all = sensitivities();
  Eigen::MatrixXd J(all.rows(), Eigen::Index(free_.size()));
  for (std::size_t c = 0; c < free_.size(); ++c) J.col(Eigen::Index(c)) = all.col(free_[c]);
  const Eigen::MatrixXd inverse = (J.transpose() * J).completeOrthogonalDecomposition().pseudoInverse();
  covariance_.setZero();
  for (std::size_t a = 0; a < free_.size(); ++a) {
    for (std::size_t b = 0; b < free_.size(); ++b) {
      covariance_(free_[a], free_[b]) = inverse(Eigen::Index(a), Eigen::Index(b));
    }
  }
  // Values that scatter more widely than their deviations say are less exact than these say.
  double chi_square = 0.0;
  for (const Datum& d : data) {
    chi_square += square((predicted(d, x, scales) - d.value) / (d.value * d.deviation));
  }
  const double freedom = double(data.size()) - double(free_.size());
  birge_ratio = freedom > 0.0 ? std::max(1.0, std::sqrt(chi_square / freedom)) : 1.0;
  covariance_ *= square(birge_ratio);
}

}  // namespace wingbeat::detail
