// Designs held at a lift or at a frequency by their voltage, beside the same designs at the voltages they have:
// processor time on one core, in turns, and the answers beside those of the search of one.
//
//   benchmark_hold [COUNT [SECONDS [VEHICLE.toml]]]    COUNT designs of each box (10,000), measured for SECONDS each
//   (1); of a vehicle on a gearbox 100 wing lengths by 100 gear ratios at hover, as in
//   data/studies/hover-gear-wing.toml
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include "ensemble_timing.hpp"
#include "vehicle/kind_boxes.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/study/ensemble_hold.hpp"
#include "wingbeat/study/run.hpp"

namespace {

using namespace wingbeat;

/// Of this thread: others may want the processor, too.
double processor_time() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

template <class F>
double seconds_of(const F& f) {
  const double start = processor_time();
  f();
  return processor_time() - start;
}

struct HeldOutcomes {
  std::vector<EnsembleOutcome> outcomes;
  std::vector<FrequencyOutcome> reached;
};

HeldOutcomes solve_held(std::vector<EnsembleMember> members, const std::vector<Hold>& holds,
                        const EnsembleOptions& options, const StartUp& start_up) {
  HeldOutcomes held{std::vector<EnsembleOutcome>(members.size()), std::vector<FrequencyOutcome>(members.size())};
  solve_ensemble_held(members, holds, options, start_up, held.outcomes, held.reached);
  return held;
}

void measure(const std::string& name, std::vector<EnsembleMember> members, const std::vector<Hold>& lifts,
             const std::vector<Hold>& frequencies, double seconds, const StartUp& start_up);

EnsembleOptions power_and_lift() {
  EnsembleOptions options;
  options.metrics = wanted_sets()[1].metrics;
  return options;
}

/// Random designs of a box, held at lifts and frequencies about their own.
void measure_box(KindBox box, std::size_t count, double seconds, const StartUp& start_up) {
  std::mt19937_64 random(20261126);
  std::uniform_real_distribution<double> log_factor(-0.5, 0.5);
  std::vector<EnsembleMember> members;
  for (std::size_t n = 0; n < count; ++n) {
    const Design<double> design = kind_design(box, random);
    members.push_back({resolve(design), reporting_of(design)});
  }
  std::vector<EnsembleOutcome> free(count);
  solve_ensemble(members, power_and_lift(), start_up, free);
  std::vector<Hold> lifts, frequencies;
  std::size_t kept = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const double lift = free[n].metrics[Metric::lift_mean], frequency = free[n].metrics[Metric::frequency];
    if (!(lift > 0.0)) continue;
    const double factor = std::exp(log_factor(random));
    lifts.push_back({Held::lift, factor * lift});
    frequencies.push_back({Held::frequency, std::sqrt(factor) * frequency});
    members[kept++] = members[n];
  }
  members.resize(kept);
  measure(std::string(kind_box_names[std::size_t(box)]), std::move(members), lifts, frequencies, seconds, start_up);
}

/// The designs of a map over wing length and gear ratio, at hover.
void measure_map(const char* vehicle, double seconds, const StartUp& start_up) {
  constexpr int steps = 100;
  Design<double> design = read_design(vehicle);
  std::vector<EnsembleMember> members;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      design.wing.planform.length = 60e-3 + 50e-3 * i / (steps - 1);
      design.motor.gear_ratio = 6.0 + 14.0 * j / (steps - 1);
      members.push_back({resolve(design), reporting_of(design)});
    }
  }
  const std::vector<Hold> lifts(members.size(), {Held::lift_to_weight, 1.0});
  const std::vector<Hold> frequencies(members.size(), {Held::frequency, 20.0});
  measure("hover map", std::move(members), lifts, frequencies, seconds, start_up);
}

void measure(const std::string& name, std::vector<EnsembleMember> members, const std::vector<Hold>& lifts,
             const std::vector<Hold>& frequencies, double seconds, const StartUp& start_up) {
  const EnsembleOptions options = power_and_lift();
  const std::size_t kept = members.size();
  std::vector<EnsembleOutcome> free(kept);
  double unheld = INFINITY, at_lift = INFINITY, at_frequency = INFINITY, spent = 0.0;
  HeldOutcomes held;
  do {
    const double a = seconds_of([&] { solve_ensemble(members, options, start_up, free); });
    const double b = seconds_of([&] { held = solve_held(members, lifts, options, start_up); });
    const double c = seconds_of([&] { solve_held(members, frequencies, options, start_up); });
    unheld = std::min(unheld, a), at_lift = std::min(at_lift, b), at_frequency = std::min(at_frequency, c);
    spent += a + b + c;
  } while (spent < seconds);

  const std::size_t sample = std::min<std::size_t>(200, kept), apart = std::max<std::size_t>(1, kept / 200);
  int other = 0;
  double worst = 0.0;
  const double one_by_one = seconds_of([&] {
    for (std::size_t k = 0; k < sample; ++k) {
      const std::size_t n = k * apart;
      SteadyOptions steady;
      steady.reporting = members[n].reporting;
      const FrequencySearch one = find_voltage(members[n].vehicle, lifts[n], steady, start_up);
      const bool reached = held.reached[n] == FrequencyOutcome::reached;
      other += reached != (one.outcome == FrequencyOutcome::reached) || held.outcomes[n].status != one.status;
      if (reached) worst = std::max(worst, std::abs(held.outcomes[n].metrics[Metric::voltage] / one.voltage - 1.0));
    }
  });
  std::size_t reached = 0, scalar = 0;
  for (std::size_t n = 0; n < kept; ++n) {
    reached += held.reached[n] == FrequencyOutcome::reached;
    scalar += held.outcomes[n].scalar;
  }
  std::printf("%-12s %9.0f %8.2f %10.2f %11.0f %8.1f %% %8.1f %% | %5d %9.1e\n", name.c_str(), double(kept) / unheld,
              at_lift / unheld, at_frequency / unheld, one_by_one / double(sample) / (at_lift / double(kept)),
              100.0 * double(reached) / double(kept), 100.0 * double(scalar) / double(kept), other, worst);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::size_t(std::atoi(argv[1])) : 10000;
  const double seconds = argc > 2 ? std::atof(argv[2]) : 1.0;
  if (count < 1 || !(seconds >= 0.0)) {
    std::fprintf(stderr, "usage: benchmark_hold [COUNT [SECONDS [VEHICLE.toml]]]\n");
    return 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const StartUp start_up = start_up_in_time();
  std::printf("%zu designs a box, tolerance 1e-6, power and lift, one core; lifts and frequencies about their own\n\n",
              count);
  std::printf("             unheld     held at, times it   one by one,                          | of 200 one by one\n");
  std::printf("box          designs/s     lift  frequency  times batch   reached   by scalar  | other   voltage\n");
  if (argc > 3) measure_map(argv[3], seconds, start_up);
  for (const KindBox box : {KindBox::reference, KindBox::tables, KindBox::pitch_stop, KindBox::pwm, KindBox::coreless,
                            KindBox::four_bar, KindBox::gear_loss}) {
    measure_box(box, count, seconds, start_up);
  }
}
