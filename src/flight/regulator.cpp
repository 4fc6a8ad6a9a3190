// The linear-quadratic regulator of flight: sampled, with integrals, actuators and delay as states of its own.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/flight/controller.hpp"

namespace wingbeat {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// The states that each axis steers, in the order of regulated_state_names.
constexpr Index states_of_axis[flight_axis_count][4] = {{2, 6, -1, -1}, {0, 4, 8, 11}, {1, 5, 7, 10}, {3, 9, -1, -1}};
/// A position error larger than so many times its size counts as that.
constexpr double largest_error = 5.0;

RegulatedState bryson_sizes(const RegulatorSizes& s) {
  RegulatedState sizes;
  sizes << s.position, s.position, s.position, s.heading, s.velocity, s.velocity, s.velocity, s.rates, s.rates, s.rates,
      s.attitude, s.attitude;
  return sizes;
}

/// Earth axes turned to the heading.
Triple to_heading(double yaw, const Triple& v) {
  const double c = std::cos(yaw), s = std::sin(yaw);
  return {c * v[0] + s * v[1], -s * v[0] + c * v[1], v[2]};
}

/// The deviation of the twelve states from trim and reference.
RegulatedState deviation_from(const FlightMeasurement& m, const FlightReference& r, const TrimResult& trim,
                              double largest_position) {
  RegulatedState e;
  Triple gap{m.position[0] - r.position[0], m.position[1] - r.position[1], m.position[2] - r.position[2]};
  const double far = std::hypot(gap[0], gap[1]), share = far > largest_position ? largest_position / far : 1.0;
  gap[0] *= share, gap[1] *= share;
  gap[2] = std::clamp(gap[2], -largest_position, largest_position);
  const Triple x = to_heading(m.angles[2], gap);
  // At hover along the body axes of trim, whatever the attitude is now.
  const Triple wanted = to_body(attitude_of({m.angles[0], m.angles[1], m.angles[2]}), r.velocity);
  const Triple held = steady_body(trim.condition, trim.roll, trim.pitch).rates;
  e << x[0], x[1], x[2], std::remainder(m.angles[2] - r.yaw, two_pi), m.velocity[0] - wanted[0],
      m.velocity[1] - wanted[1], m.velocity[2] - wanted[2], m.rates[0] - held[0], m.rates[1] - held[1],
      m.rates[2] - held[2] - r.yaw_rate, m.angles[0] - trim.roll, m.angles[1] - trim.pitch;
  return e;
}

/// A sampled plant whose commands act so many steps later: those on their way are states, the newest first.
LinearPlant with_delay(const LinearPlant& once, Index steps) {
  const Index n = once.A.rows(), nu = once.B.cols(), size = n + steps * nu;
  if (steps == 0) return once;
  LinearPlant delayed{MatrixXd::Zero(size, size), MatrixXd::Zero(size, nu)};
  delayed.A.topLeftCorner(n, n) = once.A;
  delayed.A.block(0, size - nu, n, nu) = once.B;
  delayed.B.block(n, 0, nu, nu).setIdentity();
  if (steps > 1) delayed.A.block(n + nu, n, (steps - 1) * nu, (steps - 1) * nu).setIdentity();
  return delayed;
}

}  // namespace

/// States that are kept, integrals, actuators.
LinearPlant FlightController::plant_with_actuators() const {
  const LinearPlant whole = regulated_plant(task_.linear, task_.trim);
  const Index nx = Index(kept_.size()), ni = Index(integrated_.size()), nu = Index(design_.controls.size());
  const Index n = nx + ni + nu;
  LinearPlant plant{MatrixXd::Zero(n, n), MatrixXd::Zero(n, nu)};
  for (Index i = 0; i < nx; ++i) {
    for (Index j = 0; j < nx; ++j) plant.A(i, j) = whole.A(kept_[std::size_t(i)], kept_[std::size_t(j)]);
  }
  for (Index i = 0; i < ni; ++i) plant.A(nx + i, integrated_[std::size_t(i)]) = 1.0;
  for (Index c = 0; c < nu; ++c) {
    const FlightControl which = design_.controls[std::size_t(c)];
    const VectorXd column = whole.B.col(task_.linear.column_of(which));
    const double lag = task_.lag[std::size_t(which)];
    const bool lags = lag > 0.1 * step_;
    for (Index i = 0; i < nx; ++i) {
      (lags ? plant.A(i, nx + ni + c) : plant.B(i, c)) = column[kept_[std::size_t(i)]];
    }
    plant.A(nx + ni + c, nx + ni + c) = -1.0 / std::max(lag, 0.1 * step_);
    plant.B(nx + ni + c, c) = 1.0 / std::max(lag, 0.1 * step_);
  }
  return plant;
}

void FlightController::design_regulator() {
  std::vector<bool> wanted(regulated_state_count, false);
  for (std::size_t a = 0; a < flight_axis_count; ++a) {
    if (!design_.by_axis[a]) continue;
    for (const Index state : states_of_axis[a]) {
      if (state >= 0) wanted[std::size_t(state)] = true;
    }
  }
  const bool integrals = options_.sizes.integral > 0.0;
  for (Index k = 0; k < Index(regulated_state_count); ++k) {
    if (!wanted[std::size_t(k)]) continue;
    if (k < 4 && integrals) integrated_.push_back(Index(kept_.size()));
    kept_.push_back(k);
  }
  const Index nx = Index(kept_.size()), ni = Index(integrated_.size()), nu = Index(design_.controls.size());
  if (nu == 0) throw ParameterError("controller.type", "the vehicle has no control that acts on its flight");
  const Index m = Index(std::lround(task_.delay / step_)), n = nx + ni + nu, size = n + m * nu;
  const LinearPlant delayed = with_delay(sampled(plant_with_actuators(), step_), m);
  const RegulatedState sizes = bryson_sizes(options_.sizes);
  const double share = options_.sizes.controls > 0.0 ? options_.sizes.controls : task_.vehicle->direct ? 0.1 : 0.5;
  MatrixXd Q = MatrixXd::Zero(size, size), R = MatrixXd::Zero(nu, nu);
  for (Index i = 0; i < nx; ++i) Q(i, i) = step_ / square(sizes[kept_[std::size_t(i)]]);
  for (Index i = 0; i < ni; ++i) {
    const Index state = kept_[std::size_t(integrated_[std::size_t(i)])];
    Q(nx + i, nx + i) = step_ / square(options_.sizes.integral * sizes[state] / options_.sizes.position);
  }
  for (Index c = 0; c < nu; ++c) {
    const FlightControl which = design_.controls[std::size_t(c)];
    const ControlRange& range = task_.vehicle->ranges[std::size_t(which)];
    const double trimmed = task_.trim.controls[which], half = 0.5 * (range.high - range.low);
    const double room = std::max(std::min(range.high - trimmed, trimmed - range.low), 0.1 * half);
    R(c, c) = step_ / square(share * room);
  }
  const std::optional<Regulator> found = discrete_regulator(delayed, Q, R);
  if (!found) {
    throw ParameterError("controller.type",
                         detail::format("no regulator stabilises the vehicle at %.4g Hz with a delay of %.3g ms",
                                        options_.rate, 1e3 * task_.delay));
  }
  K_ = found->K;
  design_.riccati_residual = found->residual;
  design_.spectral_radius = spectral_radius(delayed.A - delayed.B * K_);
  design_.gains = MatrixXd::Zero(nu, Index(regulated_state_count));
  for (Index i = 0; i < nx; ++i) design_.gains.col(kept_[std::size_t(i)]) = K_.col(i);
  integrals_ = VectorXd::Zero(ni);
  actuators_ = VectorXd::Zero(nu);
  sent_.assign(std::size_t(m), VectorXd::Zero(nu));
}

FlightControls FlightController::regulate(const FlightMeasurement& m, const FlightReference& r) {
  const Index nx = Index(kept_.size()), ni = integrals_.size(), nu = actuators_.size();
  const RegulatedState all = deviation_from(m, r, task_.trim, largest_error * options_.sizes.position);
  VectorXd z = VectorXd::Zero(K_.cols());
  for (Index i = 0; i < nx; ++i) z[i] = all[kept_[std::size_t(i)]];
  z.segment(nx, ni) = integrals_;
  z.segment(nx + ni, nu) = actuators_;
  for (std::size_t k = 0; k < sent_.size(); ++k) z.segment(nx + ni + nu + Index(k) * nu, nu) = sent_[k];
  const VectorXd asked = -K_ * z;
  FlightControls controls = task_.trim.controls;
  VectorXd given(nu), beyond(nu);
  for (Index c = 0; c < nu; ++c) {
    const FlightControl which = design_.controls[std::size_t(c)];
    const double wanted = task_.trim.controls[which] + asked[c];
    controls[which] = limited(which, wanted);
    given[c] = controls[which] - task_.trim.controls[which];
    beyond[c] = wanted - controls[which];
  }
  // No integral grows that drives a control further beyond its limit.
  for (Index i = 0; i < ni; ++i) {
    const double growth = step_ * z[integrated_[std::size_t(i)]];
    bool winds_up = false;
    for (Index c = 0; c < nu; ++c) {
      winds_up = winds_up || beyond[c] * -K_(c, nx + i) * growth > 0.0;
    }
    if (!winds_up) integrals_[i] += growth;
  }
  const VectorXd acts = sent_.empty() ? given : sent_.back();
  for (Index c = 0; c < nu; ++c) {
    const double lag = std::max(task_.lag[std::size_t(design_.controls[std::size_t(c)])], 0.1 * step_);
    actuators_[c] += (acts[c] - actuators_[c]) * -std::expm1(-step_ / lag);
  }
  if (!sent_.empty()) {
    sent_.push_front(given);
    sent_.pop_back();
  }
  return controls;
}

}  // namespace wingbeat
