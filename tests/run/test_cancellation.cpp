// Whatever is computed ends at a request, soon and with no result: orbits, simulations, searches and studies.
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>

#include "wingbeat/core/cancellation.hpp"
#include "wingbeat/files/bench_file.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/file_record.hpp"
#include "wingbeat/files/optimise_file.hpp"
#include "wingbeat/files/study_file.hpp"
#include "wingbeat/run/parallel.hpp"
#include "wingbeat/run/sweep_run.hpp"
#include "wingbeat/study/control_models.hpp"
#include "wingbeat/study/endurance.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/time/simulation.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

const std::string data = WINGBEAT_DATA;

/// Asks to stop once it has been looked at so many times, by any thread.
class AfterLooks : public Cancellation {
 public:
  explicit AfterLooks(int looks) : left_(looks) {}

 private:
  void look() override {
    if (--left_ <= 0) request();
  }
  std::atomic<int> left_;
};

/// Whether an act ends where a solver looks for the so-manieth time.
template <class Act>
bool ends_after(int looks, const Act& act) {
  AfterLooks cancellation(looks);
  const CancellationScope scope(&cancellation);
  try {
    act();
  } catch (const Cancelled&) {
    return true;
  }
  return false;
}

TEST(Cancelling, EndsOrbitsSimulationsAndSearchesOfEveryDrive) {
  for (const char* name : {"friction2022", "direct-drive", "pitch-hinge", "pitch-hinge-crank"}) {
    const Design<double> design = read_design(data + "/designs/" + name + ".toml");
    for (const Method method : {Method::orbit, Method::transient}) {
      RunOptions options;
      options.method = method;
      EXPECT_TRUE(ends_after(40, [&] { run_design(design, options); })) << name << " " << name_of(method);
      options.lift = 0.01;
      EXPECT_TRUE(ends_after(300, [&] { run_design(design, options); })) << name << " " << name_of(method);
    }
    const Vehicle<double> vehicle = resolve(design);
    for (const TimeIntegrator integrator : {TimeIntegrator::automatic, TimeIntegrator::own_steps}) {
      TransientOptions options;
      options.integrator = integrator;
      EXPECT_TRUE(ends_after(40, [&] { simulate_start_up(vehicle, options); })) << name;
    }
  }
}

TEST(Cancelling, LeavesASteppedSimulationWhereTheCallBegan) {
  Simulation simulation(resolve(read_design(data + "/designs/friction2022.toml")), {SupplyType::constant, 3.0});
  simulation.step_to(0.02);
  const SimulationState before = simulation.save();
  EXPECT_TRUE(ends_after(40, [&] { simulation.step_to(1e4); }));
  EXPECT_EQ(simulation.save(), before);
  simulation.step_to(0.03);
  EXPECT_EQ(simulation.time(), 0.03);
}

TEST(Cancelling, EndsStudiesThroughTheLibrariesThatTheyUse) {
  const Design<double> battery = read_design(data + "/designs/friction2022-battery.toml");
  EXPECT_TRUE(ends_after(1000, [&] { simulate_discharge(battery, {}); }));
  const Design<double> design = read_design(data + "/designs/friction2022.toml");
  EXPECT_TRUE(ends_after(1000, [&] { control_models(design, {}); }));

  const BenchFit bench = read_bench(data + "/bench/flapper.toml");
  EXPECT_TRUE(ends_after(2000, [&] { fit_bench(bench, {}); }));

  OptimiseFile file = read_optimise_study(data + "/studies/optimise-hover.toml");
  file.study.screen = 64;
  // In the screening, and in the local searches by NLopt.
  for (const int looks : {10, 20000}) {
    EXPECT_TRUE(ends_after(looks, [&] { optimise(file.study, start_up_in_time()); })) << looks;
  }
}

TEST(Cancelling, ReachesAllThreads) {
  std::atomic<int> begun = 0;
  EXPECT_TRUE(ends_after(50, [&] {
    for_each_in_parallel(100000, [&](std::size_t) {
      ++begun;
      for (int n = 0; n < 3; ++n) check_cancellation();
    });
  }));
  EXPECT_LT(begun, 50);

  const Study study = read_study(data + "/studies/voltage-crank-radius.toml");
  EXPECT_TRUE(ends_after(20, [&] { solve_sweep(study.sweep, 2); }));
  std::string pattern = testing::TempDir() + "wingbeat-cancel-XXXXXX";
  const std::filesystem::path folder = ::mkdtemp(pattern.data());
  SweepRunOptions options;
  options.output = folder / "sweep.nc";
  EXPECT_TRUE(ends_after(20, [&] { run_sweep(study, options); }));
  EXPECT_FALSE(std::filesystem::exists(options.output));
  // What was interrupted can be taken up again, as by another command.
  FileRecord::of_this_program().clear();
  EXPECT_EQ(run_sweep(study, options).outcome, SweepResult::Outcome::finished);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace wingbeat
