#include "wingbeat/cycle/wing_loads.hpp"

#include <cmath>
#include <variant>
#include <vector>

#include "cycle/loads_system.hpp"
#include "wingbeat/cycle/cycle_gradient.hpp"
#include "wingbeat/solve/periodic.hpp"
#include "wingbeat/solve/singular_values.hpp"

namespace wingbeat {
namespace {

using detail::BodyIntegral, detail::LoadsSystem;

/// Means from the integrals over a cycle.
template <class System>
auto means_of(const typename System::Quadrature& totals) {
  using S = typename System::Real;
  const S f = S(1.0) / totals[std::size_t(Integral::time)];
  return std::array<S, wing_load_count>{f * totals[std::size_t(Integral::lift)],
                                        f * totals[System::index_of(BodyIntegral::lift_sideways)],
                                        f * totals[System::index_of(BodyIntegral::lift_forward)],
                                        f * totals[System::index_of(BodyIntegral::moment)],
                                        f * totals[System::index_of(BodyIntegral::moment_sideways)],
                                        f};
}

template <class System>
WingLoads mean_loads(const solver::Iterate<System>& cycle) {
  return means_of<System>(solver::detail::totals_of(cycle));
}

/// dy/dp of the fixed point y = P(y, p), from dP/dy and dP/dp in units of the states' sizes.
class FixedPointSlopes {
 public:
  FixedPointSlopes(const Eigen::MatrixXd& by_state, const Eigen::MatrixXd& by_input)
      : svd_(solver::singular_values(Eigen::MatrixXd::Identity(by_state.rows(), by_state.rows()) - by_state)) {
    const Eigen::Index states = by_state.rows();
    drifts_.assign(std::size_t(by_input.cols()), false);
    slopes_ = Eigen::MatrixXd::Zero(states, by_input.cols());
    const Eigen::MatrixXd along = svd_.U.transpose() * by_input;
    for (Eigen::Index n = 0; n < states; ++n) {
      const double stretch = svd_.sizes[n];
      if (stretch > free) {
        slopes_ += svd_.V.col(n) * along.row(n) / stretch;
        continue;
      }
      free_.push_back(svd_.V.col(n));
      for (Eigen::Index k = 0; k < by_input.cols(); ++k) {
        const double size = by_input.col(k).norm();
        if (std::abs(along(n, k)) > free * size) drifts_[std::size_t(k)] = true;
      }
    }
  }

  /// d/dp of a mean from its own derivatives by states and input k; absent where it has none.
  double total(const Eigen::RowVectorXd& by_state, double by_input, Eigen::Index k) const {
    if (drifts_[std::size_t(k)]) return absent;
    for (const Eigen::VectorXd& direction : free_) {
      if (std::abs(by_state.dot(direction)) > free * by_state.norm()) return absent;
    }
    return by_input + by_state.dot(slopes_.col(k));
  }

 private:
  static constexpr double free = 1e-7;  ///< |1 - multiplier| at which a cycle does not return what drifts
  solver::SingularValues svd_;
  Eigen::MatrixXd slopes_;
  std::vector<Eigen::VectorXd> free_;
  std::vector<bool> drifts_;
};

template <class System>
WingLoadSlopes slopes_of(const RecordedCycle<System>& recorded) {
  using Loaded = LoadsSystem<System>;
  using Gradient = CycleGradient<Loaded>;
  using W = typename Gradient::W;
  constexpr int N = Gradient::N;
  constexpr int first_input = gradient_first_slot + Gradient::shift;
  constexpr auto inputs = Eigen::Index(System::turns ? 1 : drive_input_count);

  RecordedCycle<Loaded> cycle{Loaded{recorded.system, {}}, detail::with_loads(recorded.cycle)};
  if constexpr (!System::turns) {
    for (const double node : nodes_of({})) detail::end_step_at(node, cycle);
  }
  Vehicle<GradientJet> seeded = cast<GradientJet>(recorded.system.vehicle);
  seeded.voltage = gradient_seed(seeded.voltage.a, 0);
  Gradient gradient(cycle, seeded);
  if constexpr (!System::turns) {
    gradient.system().wave = {W(0.0, first_input + int(DriveInput::bias)), W(0.0, first_input + int(DriveInput::split)),
                              W(0.0, first_input + int(DriveInput::cosine_split))};
  }
  gradient.run();  // where an orbit is not isolated, some of its means still have derivatives

  const auto size = recorded.system.error_scale(recorded.cycle.steps.front().y);
  Eigen::MatrixXd by_state(N, N), by_input(N, inputs);
  for (int row = 0; row < N; ++row) {
    const W& end = gradient.end()[std::size_t(row)];
    for (int column = 0; column < N; ++column) {
      by_state(row, column) = end.v[column] * size[std::size_t(column)] / size[std::size_t(row)];
    }
    by_input.row(row) = end.v.segment(first_input, inputs).transpose() / size[std::size_t(row)];
  }
  const FixedPointSlopes orbit(by_state, by_input);
  const auto means = means_of<typename Gradient::Jets>(gradient.totals());
  WingLoadSlopes slopes{};
  for (std::size_t load = 0; load < wing_load_count; ++load) {
    Eigen::RowVectorXd own = means[load].v.template head<N>().transpose();
    for (int n = 0; n < N; ++n) own[n] *= size[std::size_t(n)];
    for (Eigen::Index k = 0; k < inputs; ++k) {
      slopes[std::size_t(k)][load] = orbit.total(own, means[load].v[first_input + k], k);
    }
  }
  return slopes;
}

/// Runs cycles from a state until their means repeat, and returns the last; none where they do not.
template <class Loaded>
std::optional<solver::Iterate<Loaded>> settled_cycle(const Loaded& system, typename Loaded::State y,
                                                     solver::Method method) {
  constexpr int max_cycles = 500;
  constexpr double same = 1e-9;  // change of a mean from cycle to cycle, of the lift or the moment
  const solver::IterateOptions options{.method = method, .tolerance = 1e-10, .max_steps = 20000};
  solver::Iterate<Loaded> cycle;
  WingLoads before{};
  for (int n = 0; n < max_cycles; ++n) {
    solver::run_iterate<true>(system, y, options, cycle);
    if (cycle.status != solver::IterateStatus::complete) return std::nullopt;
    const WingLoads now = mean_loads(cycle);
    double change = 0.0;
    for (std::size_t k = 0; k < wing_load_count; ++k) {
      const bool is_moment = k == std::size_t(WingLoad::moment) || k == std::size_t(WingLoad::moment_sideways);
      const double scale = is_moment ? cycle.integral_scale[Loaded::index_of(BodyIntegral::moment)] * now.back()
                                     : std::abs(now[k == std::size_t(WingLoad::frequency) ? k : 0]);
      change = std::max(change, std::abs(now[k] - before[k]) / std::max(scale, 1e-300));
    }
    if (n > 0 && change < same) return cycle;
    before = now;
    y = cycle.end;
  }
  return std::nullopt;
}

/// The stable orbit near a state.
template <class Loaded>
std::optional<solver::Iterate<Loaded>> orbit_near(const Loaded& system, const typename Loaded::State& y,
                                                  solver::Method first_method) {
  for (const auto method : {solver::Method::explicit_pair, solver::Method::radau}) {
    if (first_method == solver::Method::radau && method != first_method) continue;
    solver::PeriodicOptions options{.tolerance = 1e-10, .max_iterates = 60, .method = method, .max_steps = 2000};
    options.near = true;
    solver::Iterate<Loaded> cycle;
    const solver::PeriodicSummary summary = solver::solve_periodic(system, y, options, cycle);
    if (summary.status == solver::PeriodicStatus::converged && summary.floquet_multiplier_max < 1.0) return cycle;
  }
  return std::nullopt;
}

template <class System>
std::optional<LoadsUnderWave> loads_of_wave(const RecordedCycle<System>& recorded, const DriveWave<double>& wave,
                                            const std::vector<double>& near) {
  if constexpr (System::turns) {
    return std::nullopt;
  } else {
    using Loaded = LoadsSystem<System>;
    if (!(recorded.system.vehicle.spring.stiffness > 0.0)) return std::nullopt;  // it drifts
    const Loaded system{recorded.system, wave};
    const typename System::State from_orbit = recorded.cycle.steps.front().y;
    typename System::State start = from_orbit;
    if (near.size() == start.size()) std::copy(near.begin(), near.end(), start.begin());
    const solver::Method method = recorded.cycle.method;
    std::optional<solver::Iterate<Loaded>> cycle = orbit_near(system, start, method);
    if (!cycle) cycle = settled_cycle(system, from_orbit, method);
    if (!cycle) return std::nullopt;
    const typename System::State& found = cycle->steps.front().y;
    return LoadsUnderWave{mean_loads(*cycle), {found.begin(), found.end()}};
  }
}

/// visit() with a cycle of which loads on a body are known.
template <class Result, class Use>
Result visit_for_loads(const CycleRecord& orbit, const Use& use) {
  return visit(orbit, [&](const auto& recorded) -> Result {
    if constexpr (std::remove_cvref_t<decltype(recorded.system)>::general) {
      throw ParameterError("vehicle",
                           "loads on a body are not known of a piezo, of wings that twist and of electronics "
                           "that limit the current");
    } else {
      return use(recorded);
    }
  });
}

}  // namespace

WingLoads wing_loads(const CycleRecord& orbit) {
  return visit_for_loads<WingLoads>(orbit, [](const auto& recorded) {
    using Loaded = LoadsSystem<std::remove_cvref_t<decltype(recorded.system)>>;
    typename Loaded::Quadrature totals{};
    const solver::Iterate<Loaded> cycle = detail::with_loads(recorded.cycle);
    solver::repeat_iterate<true>(Loaded{recorded.system, {}}, cycle.steps.front().y, cycle, &totals);
    return means_of<Loaded>(totals);
  });
}

WingLoadSlopes wing_load_slopes(const CycleRecord& orbit) {
  return visit_for_loads<WingLoadSlopes>(orbit, [](const auto& recorded) { return slopes_of(recorded); });
}

std::optional<LoadsUnderWave> loads_under_wave(const CycleRecord& orbit, const DriveWave<double>& wave,
                                               const std::vector<double>& near) {
  return visit_for_loads<std::optional<LoadsUnderWave>>(
      orbit, [&](const auto& recorded) { return loads_of_wave(recorded, wave, near); });
}

}  // namespace wingbeat
