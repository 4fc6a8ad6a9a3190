#include "flight/periodic_flight.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "wingbeat/solve/eigenvalues.hpp"
#include "wingbeat/vehicle/unknowns.hpp"

namespace wingbeat::detail {
FlightVector states_of(const BodyState& body) {
  FlightVector x;
  const Triple angles = euler_angles(body.attitude);
  x << body.velocity[0], body.velocity[1], body.velocity[2], body.rates[0], body.rates[1], body.rates[2], angles[0],
      angles[1];
  return x;
}
BodyState body_of(const FlightVector& x) {
  BodyState body;
  body.velocity = {x[0], x[1], x[2]};
  body.rates = {x[3], x[4], x[5]};
  body.attitude = attitude_of({x[6], x[7], 0.0});
  return body;
}

namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

constexpr bool is_longitudinal(std::size_t state) { return state == 0 || state == 2 || state == 4 || state == 7; }

}  // namespace

std::string shape_of(const Eigen::VectorXcd& vector, const FlightVector& steps, bool& longitudinal) {
  std::vector<std::pair<double, std::size_t>> sizes;
  double along = 0.0, across = 0.0;
  for (std::size_t k = 0; k < flight_state_count; ++k) {
    const double size = std::abs(vector[Eigen::Index(k)]) / steps[Eigen::Index(k)];
    sizes.push_back({size, k});
    (is_longitudinal(k) ? along : across) += size;
  }
  longitudinal = along >= across;
  std::sort(sizes.rbegin(), sizes.rend());
  std::string names;
  for (const auto& [size, k] : sizes) {
    if (size < 0.3 * sizes[0].first) break;
    const std::string name = flight_state_names[k];
    names += (names.empty() ? "" : ", ") + name.substr(0, name.find('_'));
  }
  return names;
}

namespace {

/// The flight over one wingbeat as a map of drives and body.
class FlightMap {
 public:
  FlightMap(const FlightVehicle& vehicle, const FlightControls& controls, double tolerance)
      : simulation_(vehicle, {.tolerance = tolerance}), crank_(!vehicle.direct) {
    simulation_.command(controls);
    for (const FlightDrive& drive : vehicle.drives) indices_.emplace_back(drive.vehicle);
    if (!crank_) period_ = 1.0 / vehicle.drives[0].vehicle.drive_frequency;
  }

  void command(const FlightControls& controls) { simulation_.command(controls); }

  Eigen::Index count() const {
    Eigen::Index n = Eigen::Index(flight_state_count);
    for (const UnknownIndices& indices : indices_) n += Eigen::Index(indices.count);
    return n;
  }
  bool crank() const { return crank_; }
  double period(const VectorXd& z) const { return crank_ ? z[0] : period_; }

  /// Drives, one after the other, of a crank with the period in the place of its angle, then the body.
  VectorXd start(const TrimResult& steady) {
    VectorXd z(count());
    Eigen::Index next = 0;
    for (std::size_t n = 0; n < indices_.size(); ++n) {
      const DriveCycle& cycle = steady.flight->cycles[n];
      indices_[n].unknowns(cycle.start, z.data() + next);
      angle_ = cycle.start.angle;
      if (crank_) z[next] = cycle.period;
      next += Eigen::Index(indices_[n].count);
    }
    z.tail<8>() = states_of(steady_body(steady.condition, steady.roll, steady.pitch));
    return z;
  }
  /// End less start; of a crank its angle less a turn in the place of the period.
  VectorXd mismatch(const VectorXd& z) {
    std::vector<Coordinates<double>> drives;
    Eigen::Index next = 0;
    VectorXd from = z;
    for (const UnknownIndices& indices : indices_) {
      if (crank_) from[next] = angle_;
      drives.push_back(indices.coordinates(from.data() + next));
      next += Eigen::Index(indices.count);
    }
    simulation_.start(body_of(z.tail<8>()), drives);
    if (!(period(z) > 0.0) || !simulation_.step_to(period(z))) throw std::runtime_error("the mechanism jams");
    const FlightState to = simulation_.state();
    VectorXd end(count());
    next = 0;
    for (std::size_t n = 0; n < indices_.size(); ++n) {
      indices_[n].unknowns(to.drives[n], end.data() + next);
      next += Eigen::Index(indices_[n].count);
    }
    end.tail<8>() = states_of(to.body);
    VectorXd gap = end - from;
    if (crank_) gap[0] -= two_pi;
    return gap;
  }
  /// Mean of the states over a period from z, by Simpson's rule.
  FlightVector mean(const VectorXd& z) {
    constexpr int parts = 64;
    mismatch(z);  // sets the start
    std::vector<Coordinates<double>> drives;
    FlightVector sum = FlightVector::Zero();
    VectorXd from = z;
    Eigen::Index next = 0;
    for (const UnknownIndices& indices : indices_) {
      if (crank_) from[next] = angle_;
      drives.push_back(indices.coordinates(from.data() + next));
      next += Eigen::Index(indices.count);
    }
    simulation_.start(body_of(z.tail<8>()), drives);
    const double T = period(z);
    for (int k = 0; k <= parts; ++k) {
      if (k > 0) simulation_.step_to(T * k / parts);
      const double weight = k == 0 || k == parts ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
      sum += weight / (3.0 * parts) * states_of(simulation_.state().body);
    }
    return sum;
  }

 private:
  FlightSimulation simulation_;
  std::vector<UnknownIndices> indices_;
  bool crank_;
  double period_ = 0.0, angle_ = 0.0;
};

VectorXd sizes_for(const FlightMap& map, const VectorXd& z, const FlightVector& steps) {
  VectorXd sizes(z.size());
  const double rate = two_pi / map.period(z);
  for (Eigen::Index n = 0; n < z.size(); ++n) sizes[n] = std::max(std::abs(z[n]), 1e-3);
  if (map.crank()) sizes[0] = map.period(z);
  for (Eigen::Index n = 1; n < z.size() - 8; ++n) sizes[n] = std::max(sizes[n], 0.01 * rate);
  sizes.tail<8>() = 1e3 * steps;
  return sizes;
}

/// Newton's method for the flight at some controls; slopes that are known serve as long as they do.
class PeriodicSearch {
 public:
  PeriodicSearch(const FlightVehicle& vehicle, const TrimResult& steady, const FlightVector& steps, double tolerance)
      : map_(vehicle, steady.controls, tolerance),
        // Errors of the steps, random from one start to the next, are divided by the differences of the starts.
        fine_(vehicle, steady.controls, std::max(1e-12, 1e-2 * tolerance)),
        steps_(steps),
        tolerance_(tolerance),
        z_(map_.start(steady)) {
    fine_.start(steady);  // sets the crank angle that its cycles start at
  }

  void command(const FlightControls& controls) {
    map_.command(controls);
    fine_.command(controls);
  }

  /// False: none found near where the last one was.
  bool solve() {
    constexpr int max_iterations = 20;
    VectorXd gap = map_.mismatch(z_);
    off_ = infinity;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      const VectorXd sizes = sizes_for(map_, z_, steps_);
      VectorXd scaled = gap.cwiseQuotient(sizes);
      if (map_.crank()) scaled[0] = gap[0] / two_pi;
      const double before = std::exchange(off_, scaled.norm());
      if (off_ <= 100.0 * tolerance_ || (iteration > 3 && off_ > 0.5 * before && off_ < 1e-6)) break;
      if (slopes_.size() == 0 || off_ > 0.2 * before) linearise(map_, 1e-5, &gap);
      VectorXd correction = slopes_.partialPivLu().solve(gap);
      const double longest = correction.cwiseQuotient(sizes).cwiseAbs().maxCoeff();
      if (longest > 0.1) correction *= 0.1 / longest;
      z_ -= correction;
      gap = map_.mismatch(z_);
    }
    return off_ <= 1e-6;
  }
  double period() const { return map_.period(z_); }
  double off() const { return off_; }
  FlightVector mean() { return map_.mean(z_); }
  /// By central differences; of a crank between passages of one crank angle.
  MatrixXd monodromy() {
    linearise(fine_, 1e-3, nullptr);
    const Eigen::Index count = z_.size();
    if (!map_.crank()) return slopes_ + MatrixXd::Identity(count, count);
    // The time to the same crank angle changes with the start.
    const Eigen::Index rest = count - 1;
    return slopes_.bottomRightCorner(rest, rest) + MatrixXd::Identity(rest, rest) -
           slopes_.col(0).tail(rest) * slopes_.row(0).tail(rest) / slopes_(0, 0);
  }

 private:
  /// Slopes of the mismatch: forward differences from a gap that is known, else central ones.
  void linearise(FlightMap& map, double share, const VectorXd* gap) {
    const VectorXd sizes = sizes_for(map, z_, steps_);
    slopes_.resize(z_.size(), z_.size());
    for (Eigen::Index n = 0; n < z_.size(); ++n) {
      VectorXd above = z_, below = z_;
      above[n] += share * sizes[n];
      below[n] -= share * sizes[n];
      if (gap) slopes_.col(n) = (map.mismatch(above) - *gap) / (share * sizes[n]);
      else slopes_.col(n) = (map.mismatch(above) - map.mismatch(below)) / (2.0 * share * sizes[n]);
    }
  }

  FlightMap map_, fine_;
  FlightVector steps_;
  double tolerance_;
  VectorXd z_;
  MatrixXd slopes_;
  double off_ = infinity;
};

/// Mean speed ahead and downwards in earth axes, of the mean states [m/s].
Eigen::Vector2d speeds_of(const FlightVector& mean) {
  const Triple earth = to_earth(attitude_of({mean[6], mean[7], 0.0}), {mean[0], mean[1], mean[2]});
  return {earth[0], earth[2]};
}

/// Slopes of the steady speeds by voltage and control of pitch, by the averaged model; a column for each that the
/// vehicle has.
MatrixXd speed_slopes(const FlightVehicle& vehicle, const FlightLinearModel& model, const FlightVector& trimmed,
                      std::vector<FlightControl>& controls) {
  controls = {FlightControl::voltage};
  if (const auto of_pitch = pitch_control(vehicle)) controls.push_back(*of_pitch);
  MatrixXd slopes(2, Eigen::Index(controls.size()));
  for (std::size_t k = 0; k < controls.size(); ++k) {
    const FlightVector change = -model.A.partialPivLu().solve(model.B.col(model.column_of(controls[k])));
    constexpr double part = 1e-6;
    slopes.col(Eigen::Index(k)) =
        (speeds_of(trimmed + part * change) - speeds_of(trimmed - part * change)) / (2.0 * part);
  }
  return slopes;
}

}  // namespace

std::optional<PeriodicFlight> periodic_flight(const FlightVehicle& vehicle, const TrimResult& steady,
                                              const FlightLinearModel& model, const FlightVector& steps,
                                              double tolerance, std::string& detail) {
  if (!vehicle.direct && vehicle.drives.size() > 1) {
    detail = "the cranks of two motors have no common cycle";
    return std::nullopt;
  }
  try {
    constexpr int max_corrections = 12;
    PeriodicSearch search(vehicle, steady, steps, tolerance);
    std::vector<FlightControl> controls;
    const FlightVector trimmed = states_of(steady_body(steady.condition, steady.roll, steady.pitch));
    const MatrixXd slopes = speed_slopes(vehicle, model, trimmed, controls);
    const Eigen::Vector2d wanted(steady.condition.speed, -steady.condition.climb);
    PeriodicFlight flight;
    flight.controls = steady.controls;
    for (int correction = 0; correction < max_corrections; ++correction) {
      if (!search.solve()) {
        detail = "no flight that repeats with the wingbeat was found near the trim";
        return std::nullopt;
      }
      flight.mean = search.mean();
      const Eigen::Vector2d off = speeds_of(flight.mean) - wanted;
      if (correction == 0) flight.drift = {off[0], off[1]};
      if (off.norm() <= 1e-2 * steps[0]) break;
      const VectorXd change = slopes.completeOrthogonalDecomposition().solve(off);
      for (std::size_t k = 0; k < controls.size(); ++k) flight.controls[controls[k]] -= change[Eigen::Index(k)];
      search.command(flight.controls);
    }
    flight.period = search.period();
    flight.mismatch = search.off();
    const MatrixXd monodromy = search.monodromy();
    const solver::EigenModes found = solver::eigen_modes(monodromy);
    if (!found.found) {
      detail = "the multipliers of the flight over a wingbeat did not converge";
      return std::nullopt;
    }
    for (Eigen::Index n = 0; n < monodromy.rows(); ++n) {
      bool longitudinal = false;
      shape_of(found.vectors.col(n).tail(8), steps, longitudinal);
      flight.multipliers.push_back(found.values[n]);
      flight.longitudinal.push_back(longitudinal);
    }
    return flight;
  } catch (const std::runtime_error&) {
    detail = "the flight over a wingbeat could not be integrated";
    return std::nullopt;
  }
}

}  // namespace wingbeat::detail
