// Designs of one box through the batched solver, the scalar solver and general-purpose solvers, in one run on one core:
// processor time per design, ratio to the batched solver and the accuracy that each reached. docs/benchmarks.md has a
// run and its meaning.
//
//   benchmark_peers             4096 designs (fewer for the slow ones)
//   benchmark_peers DESIGNS     another number of designs
//
// Every peer integrates in crank angle, where the period is known, from the same guess; its first iterates are coarse;
// and its tolerance (for AUTO-07p: its number of mesh intervals) is the loosest of a ladder that brings the median lift
// error to 1e-6 and 99 % of the designs within ten times that. SciPy is asked of /usr/bin/python3, or of what
// WINGBEAT_PYTHON names; AUTO-07p is expected where Debian puts it, or in AUTO_DIR. GSL and PETSc take part where they
// were found when this was built.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "peers/arkode.hpp"
#include "peers/equations.hpp"
#include "peers/integrators.hpp"
#include "peers/programs.hpp"
#include "peers/tuning.hpp"
#ifdef WINGBEAT_PEERS_GSL
#include "peers/gsl.hpp"
#endif
#ifdef WINGBEAT_PEERS_PETSC
#include "peers/petsc.hpp"
#endif
#include "vehicle/random_vehicle.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/study/run.hpp"

using namespace wingbeat;
using namespace wingbeat::peers;

namespace {

using SolveOne = std::function<Steady(const Peer&, double)>;

// A method of two states and one of all, made alike.
template <template <std::size_t> class Method, class... Given>
SolveOne stepping(Given... given) {
  return [plain = std::make_shared<Method<2>>(given...), measured = std::make_shared<Method<all_states>>(given...)](
             const Peer& peer, double tolerance) { return by_stepping(*plain, *measured, peer, tolerance); };
}

struct Integrator {
  std::string name;
  SolveOne solve;  // empty: not there when this was built
};

std::vector<Integrator> integrators() {
  std::vector<Integrator> list{
      {"Boost.odeint dopri5", [](const Peer& peer, double tolerance) { return by_odeint<Dopri5>(peer, tolerance); }},
      {"Boost.odeint cash_karp54",
       [](const Peer& peer, double tolerance) { return by_odeint<CashKarp>(peer, tolerance); }},
      {"CVODE, Adams", stepping<Adams>()},
      {"ARKODE, Cash-Karp 5(4)", stepping<ErkStep>(ARKODE_CASH_KARP_6_4_5)},
      {"ARKODE, Dormand-Prince 5(4)", stepping<ErkStep>(ARKODE_DORMAND_PRINCE_7_4_5)},
      {"ARKODE, Verner 6(5)", stepping<ErkStep>(ARKODE_VERNER_8_5_6)},
      {"ARKODE, Fehlberg 8(7)", stepping<ErkStep>(ARKODE_FEHLBERG_13_7_8)}};
#ifdef WINGBEAT_PEERS_GSL
  list.push_back({"GSL msadams", stepping<Gsl>(gsl_odeiv2_step_msadams)});
  list.push_back({"GSL rkck", stepping<Gsl>(gsl_odeiv2_step_rkck)});
  list.push_back({"GSL rk8pd", stepping<Gsl>(gsl_odeiv2_step_rk8pd)});
#else
  list.push_back({"GSL", {}});
#endif
#ifdef WINGBEAT_PEERS_PETSC
  list.push_back({"PETSc TS, Dormand-Prince 5(4)", stepping<TsRk>(TSRK5DP)});
  list.push_back({"PETSc TS, Verner 6(5)", stepping<TsRk>(TSRK6VR)});
  list.push_back({"PETSc TS, Verner 8(7)", stepping<TsRk>(TSRK8VR)});
#else
  list.push_back({"PETSc TS", {}});
#endif
  return list;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::max(1, std::atoi(argv[1])) : 4096;
  const StartUp start_up = start_up_in_time();

  // The designs of the box that flap, with their exact answers.
  std::mt19937_64 random(20222);
  std::vector<EnsembleMember> members;
  std::vector<Steady> exact;
  while (members.size() < count) {
    const Design<double> design = box_design(random);
    const std::vector<EnsembleMember> one{{resolve(design), reporting_of(design)}};
    EnsembleOptions options;
    options.scalar_only = true;
    options.tolerance = 1e-10;
    std::vector<EnsembleOutcome> outcome(1);
    solve_ensemble(one, options, start_up, outcome);
    if (outcome[0].status != FlappingStatus::flapping) continue;
    members.push_back(one[0]);
    exact.push_back(steady_of(outcome[0].metrics));
  }
  std::vector<Peer> peers;
  for (const EnsembleMember& m : members) peers.emplace_back(m.vehicle);

  const auto ours = [&](bool scalar, bool every_metric) {
    return [&, scalar, every_metric](double tolerance) {
      EnsembleOptions options;
      options.tolerance = tolerance;
      options.scalar_only = scalar;
      if (!every_metric) {
        options.metrics.reset();
        for (const Metric m : {Metric::lift_mean, Metric::power_electrical, Metric::frequency})
          options.metrics.set(std::size_t(m));
      }
      std::vector<EnsembleOutcome> outcomes(members.size());
      Answers answers;
      answers.seconds =
          seconds_of([&] { solve_ensemble(members, options, start_up, outcomes); }) / double(members.size());
      answers.exact = exact;
      for (const EnsembleOutcome& out : outcomes) answers.got.push_back(steady_of(out.metrics));
      return answers;
    };
  };
  // One by one: the time per design does not depend on their number.
  const std::size_t some = std::min<std::size_t>(count, 256);
  const auto each = [&](auto solve) {
    return [&, solve](double tolerance) {
      Answers answers;
      answers.exact.assign(exact.begin(), exact.begin() + std::ptrdiff_t(some));
      answers.got.resize(some);
      answers.seconds = seconds_of([&] {
                          for (std::size_t n = 0; n < some; ++n) answers.got[n] = solve(peers[n], tolerance);
                        }) /
                        double(some);
      return answers;
    };
  };

  const Scratch scratch;
  const std::string python = environment("WINGBEAT_PYTHON", "/usr/bin/python3");
  const bool scipy = runs(python + " -c 'from scipy.integrate import odeint'");
  const std::size_t few = std::min<std::size_t>(count, 32), fewer = std::min<std::size_t>(count, 6);
  if (scipy) write_designs(members, few, scratch.path);

#ifdef WINGBEAT_PEERS_PETSC
  const Petsc petsc;
#endif
  std::vector<Rival> rivals;
  rivals.push_back({"wingbeat, batched", "", "tolerance %.0e", {goal}, 40, ours(false, false)});
  rivals.push_back({"wingbeat, batched, tuned alike",
                    "",
                    "tolerance %.0e",
                    {1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, goal},
                    40,
                    ours(false, false)});
  rivals.push_back({"wingbeat, batched, all metrics", "", "tolerance %.0e", {goal}, 20, ours(false, true)});
  rivals.push_back({"wingbeat, scalar orbit", "", "tolerance %.0e", {goal}, 5, ours(true, false)});
  for (const Integrator& integrator : integrators()) {
    rivals.push_back({integrator.name, integrator.solve ? "" : "not installed when this was built", "rtol %.1e",
                      tolerances(), 5, integrator.solve ? each(integrator.solve) : std::function<Answers(double)>()});
  }
  rivals.push_back({"SciPy LSODA", scipy ? "" : "not installed", "rtol %.1e", tolerances(), 2,
                    [&](double tolerance) { return by_lsoda(python, scratch.path, exact, tolerance); }});
  rivals.push_back({"AUTO-07p, per point",
                    build_auto(scratch.path),
                    "NTST %.0f",
                    {10, 14, 20, 28, 40, 56, 80, 112, 160, 224, 320},
                    2,
                    [&](double intervals) {
                      return by_auto({members.begin(), members.begin() + std::ptrdiff_t(fewer)}, int(intervals),
                                     scratch.path, start_up);
                    }});

  std::printf(
      "%zu designs of the reference box that flap (%zu for integrators, %zu for LSODA, %zu branches for AUTO), one "
      "core, %s\n",
      count, some, few, fewer,
      std::string(std::find_if(std::begin(instruction_sets), std::end(instruction_sets),
                               [](const auto& entry) { return entry.second == best_instruction_set(); })
                      ->first)
          .c_str());
  std::printf("errors are relative, against the scalar solver at 1e-10; 'others': worst of power and frequency\n\n");
  std::printf("%-31s %-16s %14s %9s   %8s %8s %8s %8s\n", "method", "tuned to", "us per design", "ratio", "lift 50%",
              "99%", "worst", "others");

  // Tuned first; then timed in turns, so that a busy moment meets all alike. The median of each counts.
  std::vector<Row> rows;
  for (const Rival& rival : rivals) rows.push_back(rival.missing.empty() ? tuned(rival) : Row{});
  std::vector<std::vector<double>> times(rivals.size());
  const int max_rounds =
      std::max_element(rivals.begin(), rivals.end(), [](auto& a, auto& b) { return a.rounds < b.rounds; })->rounds;
  for (int round = 0; round < max_rounds; ++round) {
    for (std::size_t n = 0; n < rivals.size(); ++n) {
      if (round >= rivals[n].rounds || !rivals[n].missing.empty()) continue;
      times[n].push_back(rivals[n].solve(rows[n].setting).seconds);
    }
  }
  for (std::size_t n = 0; n < rivals.size(); ++n) {
    if (times[n].empty()) continue;
    std::sort(times[n].begin(), times[n].end());
    rows[n].answers.seconds = quantile(times[n], 0.5);
  }
  for (std::size_t n = 0; n < rivals.size(); ++n) {
    if (!rivals[n].missing.empty()) {
      std::printf("%-31s %s\n", rivals[n].name.c_str(), rivals[n].missing.c_str());
      continue;
    }
    char setting[64];
    std::snprintf(setting, sizeof setting, rivals[n].setting.c_str(), rows[n].setting);
    const Errors& e = rows[n].errors;
    std::printf("%-31s %-16s %14.2f %9.1f   %8.1e %8.1e %8.1e %8.1e", rivals[n].name.c_str(), setting,
                1e6 * rows[n].answers.seconds, rows[n].answers.seconds / rows[0].answers.seconds, e.median, e.high,
                e.worst, e.others);
    if (e.failed > 0) std::printf("  (%d of %zu without an answer)", e.failed, rows[n].answers.got.size());
    std::printf("\n");
  }
  return 0;
}
