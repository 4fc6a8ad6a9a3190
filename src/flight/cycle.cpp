#include "wingbeat/flight/cycle.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "wingbeat/vehicle/unknowns.hpp"

namespace wingbeat {
namespace {

/// What is free of a drive's state where a cycle begins: all but the angle of a crank, whose period is free instead.
class FreeStates {
 public:
  explicit FreeStates(const Vehicle<double>& vehicle) : indices_(vehicle), crank_(drive_of(vehicle).rotates) {}

  Eigen::Index count() const { return Eigen::Index(indices_.count); }
  bool crank() const { return crank_; }
  Eigen::VectorXd of(const Coordinates<double>& place, double period) const {
    Eigen::VectorXd z(count());
    indices_.unknowns(place, z.data());
    if (crank_) z[0] = period;
    return z;
  }
  Coordinates<double> place(Eigen::VectorXd z, double angle) const {
    if (crank_) z[0] = angle;
    return indices_.coordinates(z.data());
  }

 private:
  UnknownIndices indices_;
  bool crank_;
};

/// One cycle of one drive on a body that is held.
class CycleRun {
 public:
  CycleRun(const FlightVehicle& vehicle, const FlightControls& controls, const SteadyMotion& motion, double tolerance)
      : simulation_(vehicle, {.tolerance = tolerance, .frozen = true}), free_(simulation_.vehicle().drives[0].vehicle) {
    simulation_.command(controls);
    body_.velocity = motion.velocity;
    body_.rates = motion.rates;
    if (!free_.crank()) fixed_period_ = 1.0 / vehicle.drives[0].vehicle.drive_frequency;
  }

  const FreeStates& free() const { return free_; }
  double period_of(const Eigen::VectorXd& z) const { return free_.crank() ? z[0] : fixed_period_; }
  double angle = 0.0;  ///< at which a crank's cycle begins

  /// End less start of what is free, of a crank its angle in the place of the period.
  Eigen::VectorXd mismatch(const Eigen::VectorXd& z) {
    const double T = period_of(z);
    if (!(T > 0.0)) throw std::runtime_error("the cycle has no period");
    const Coordinates<double> from = free_.place(z, angle);
    simulation_.start(body_, {from});
    if (!simulation_.step_to(T)) throw std::runtime_error("the mechanism jams");
    const Coordinates<double> to = simulation_.state().drives[0];
    Eigen::VectorXd gap = free_.of(to, to.angle - angle - two_pi) - free_.of(from, 0.0);
    return gap;
  }
  /// From rest for so many cycles, until the cycles repeat about; the free states then.
  std::optional<Eigen::VectorXd> start_up() {
    constexpr int max_cycles = 400, least_cycles = 6;
    constexpr double same = 0.02;
    Coordinates<double> from;
    if (free_.crank()) from.speed = 0.0;
    simulation_.start(body_, {from});
    double chunk = free_.crank() ? simulation_.cycle_time() : fixed_period_, before = 0.0, last = 0.0;
    int alike = 0;
    for (int n = 0; n < max_cycles; ++n) {
      const double begins = simulation_.state().drives[0].angle;
      double largest = 0.0;
      for (int part = 1; part <= 8; ++part) {
        if (!simulation_.step_to(last + chunk * part / 8.0)) return std::nullopt;
        largest = std::max(largest, std::abs(simulation_.state().drives[0].speed));
      }
      last = simulation_.time();
      const Coordinates<double> here = simulation_.state().drives[0];
      if (n >= 40 && largest == 0.0) return std::nullopt;
      const double size = free_.crank() ? (here.angle - begins) / chunk : largest;
      alike = std::abs(size - before) <= same * std::abs(size) && size > 0.0 ? alike + 1 : 0;
      before = size;
      if (free_.crank() && size > 0.0) chunk = two_pi / size;
      if (n >= least_cycles && alike >= 3) {
        angle = std::remainder(here.angle, two_pi);
        return free_.of(here, chunk);
      }
    }
    return std::nullopt;
  }
  const FlightSimulation& simulation() const { return simulation_; }

 private:
  FlightSimulation simulation_;
  FreeStates free_;
  BodyState body_;
  double fixed_period_ = 0.0;
};

/// Typical sizes of what is free, to measure mismatches by.
Eigen::VectorXd sizes_of(const CycleRun& run, const Eigen::VectorXd& z) {
  Eigen::VectorXd sizes(z.size());
  const double T = run.period_of(z), w = two_pi / T;
  for (Eigen::Index n = 0; n < z.size(); ++n) sizes[n] = std::max(std::abs(z[n]), 1e-6);
  if (run.free().crank()) {
    sizes[0] = T;
  } else {
    sizes[0] = std::max(std::abs(z[0]), 0.3);
  }
  sizes[1] = std::max(std::abs(z[1]), w * 0.3);
  const bool current = UnknownIndices(run.simulation().vehicle().drives[0].vehicle).inductive;
  for (Eigen::Index n = 2; n < z.size(); ++n) {
    if (current && n == 2) continue;
    const Eigen::Index of_pair = n - (current ? 3 : 2);
    sizes[n] = std::max(sizes[n], of_pair % 2 == 0 ? 0.3 : 0.3 * w);
  }
  return sizes;
}

/// Mismatch over the sizes.
Eigen::VectorXd scaled_gap(const CycleRun& run, const Eigen::VectorXd& gap, const Eigen::VectorXd& sizes) {
  Eigen::VectorXd scaled = gap.cwiseQuotient(sizes);
  if (run.free().crank()) scaled[0] = gap[0] / two_pi;
  return scaled;
}

/// Slopes of the mismatch by differences.
Eigen::MatrixXd slopes_at(CycleRun& run, const Eigen::VectorXd& z, const Eigen::VectorXd& gap,
                          const Eigen::VectorXd& sizes) {
  Eigen::MatrixXd slopes(z.size(), z.size());
  for (Eigen::Index n = 0; n < z.size(); ++n) {
    const double step = 1e-5 * sizes[n];
    Eigen::VectorXd beside = z;
    beside[n] += step;
    slopes.col(n) = (run.mismatch(beside) - gap) / step;
  }
  return slopes;
}

/// The cycle that was run last, from z.
DriveCycle cycle_from(const CycleRun& run, const Eigen::VectorXd& z, double off) {
  const FlightTotals& totals = run.simulation().totals();
  const double T = run.period_of(z);
  DriveCycle cycle;
  cycle.start = run.free().place(z, run.angle);
  cycle.period = T;
  for (std::size_t k = 0; k < 3; ++k) {
    cycle.mean.force[k] = totals.force[k] / T;
    cycle.mean.moment[k] = totals.moment[k] / T;
  }
  cycle.electrical = totals.electrical / T;
  cycle.aerodynamic = totals.wing_air / T;
  cycle.mismatch = off;
  return cycle;
}

/// Newton's method from z on; slopes that are given serve as long as they bring the mismatch down.
std::optional<DriveCycle> solve_cycle(CycleRun& run, Eigen::VectorXd z, double closes, Eigen::MatrixXd& slopes) {
  constexpr int max_iterations = 40;
  constexpr double largest_step = 0.2, brings_down = 0.3;
  Eigen::VectorXd gap = run.mismatch(z), sizes = sizes_of(run, z);
  double off = scaled_gap(run, gap, sizes).norm();
  bool fresh = false;
  for (int iteration = 0; iteration < max_iterations && off > closes; ++iteration) {
    if (slopes.rows() != z.size()) slopes = slopes_at(run, z, gap, sizes), fresh = true;
    const Eigen::VectorXd correction = slopes.partialPivLu().solve(gap);
    const double longest = correction.cwiseQuotient(sizes).cwiseAbs().maxCoeff();
    double share = longest > largest_step ? largest_step / longest : 1.0;
    bool taken = false;
    for (int halving = 0; halving < (fresh ? 6 : 1) && !taken; ++halving, share *= 0.5) {
      const Eigen::VectorXd next = z - share * correction;
      if (!(run.period_of(next) > 0.0)) continue;
      const Eigen::VectorXd next_gap = run.mismatch(next);
      const double next_off = scaled_gap(run, next_gap, sizes).norm();
      if (!(next_off < (fresh ? 0.95 : brings_down) * off)) continue;
      z = next, gap = next_gap, off = next_off, taken = true;
    }
    if (!taken && fresh) return std::nullopt;
    if (!taken || share < 0.5) slopes.resize(0, 0);
    fresh = false;
    sizes = sizes_of(run, z);
  }
  if (!(off <= closes)) return std::nullopt;
  run.mismatch(z);
  return cycle_from(run, z, off);
}

}  // namespace

AveragedFlight::AveragedFlight(FlightVehicle vehicle, const FlightCycleOptions& options)
    : vehicle_(std::move(vehicle)), options_(options), last_(vehicle_.drives.size()), slopes_(vehicle_.drives.size()) {
  for (const FlightDrive& drive : vehicle_.drives) {
    FlightVehicle alone = vehicle_;
    alone.drives = {drive};
    alone.body.drag_area = {};
    for (Plate& plate : alone.body.plates) plate.area = 0.0;
    alone_.push_back(std::move(alone));
  }
}

std::optional<DriveCycle> AveragedFlight::cycle_of(std::size_t drive, const FlightControls& controls,
                                                   const SteadyMotion& motion) {
  CycleRun run(alone_[drive], controls, motion, options_.tolerance);
  const double closes = 100.0 * options_.tolerance;
  try {
    if (last_[drive]) {
      run.angle = last_[drive]->start.angle;
      if (auto near =
              solve_cycle(run, run.free().of(last_[drive]->start, last_[drive]->period), closes, slopes_[drive])) {
        return near;
      }
    }
    const std::optional<Eigen::VectorXd> z = run.start_up();
    if (!z) return std::nullopt;
    slopes_[drive].resize(0, 0);
    return solve_cycle(run, *z, closes, slopes_[drive]);
  } catch (const std::runtime_error&) {
    return std::nullopt;  // steps that fail: it does not settle
  }
}

std::optional<MeanFlight> AveragedFlight::at(const FlightControls& controls, const SteadyMotion& motion) {
  MeanFlight mean;
  mean.loads = plate_loads(vehicle_.body, motion.velocity, motion.rates);
  for (std::size_t n = 0; n < vehicle_.drives.size(); ++n) {
    std::optional<DriveCycle> cycle = cycle_of(n, controls, motion);
    if (!cycle) return std::nullopt;
    for (std::size_t k = 0; k < 3; ++k) {
      mean.loads.force[k] += cycle->mean.force[k];
      mean.loads.moment[k] += cycle->mean.moment[k];
    }
    mean.electrical += cycle->electrical;
    mean.aerodynamic += cycle->aerodynamic;
    last_[n] = cycle;
    mean.cycles.push_back(*cycle);
  }
  return mean;
}

}  // namespace wingbeat
