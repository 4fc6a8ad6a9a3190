// The batched solver on boxes that differ from the reference box in one kind of part each: designs a second of
// processor time on one core, the share left to the scalar solver, statuses and accuracy.
//
//   benchmark_kinds [SECONDS] [--box NAME] [--count N] [--checked N]
//
// SECONDS: measure each box for that long (default 1), in turns with the reference box, whose time is the unit of
// "ratio". N of --count: designs of a box (8192); of --checked: so many of them are compared with the scalar solver at
// 1e-10 (1024).
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <string_view>
#include <type_traits>

#include "ensemble_timing.hpp"
#include "vehicle/kind_boxes.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/study/run.hpp"

namespace {

using namespace wingbeat;

constexpr double tolerance = 1e-6;

struct Arguments {
  double seconds = 1.0;
  std::size_t count = 8192, checked = 1024;
  std::string_view box;
};

void print_usage() {
  std::printf(
      "usage: benchmark_kinds [SECONDS] [--box NAME] [--count N] [--checked N]\n\n"
      "  SECONDS      measure each box for that long, in turns with the reference box (default 1)\n"
      "  --box NAME   this box alone, one of");
  for (const std::string_view name : kind_box_names) std::printf(" %s", std::string(name).c_str());
  std::printf(
      "\n  --count N    designs of a box (8192)\n"
      "  --checked N  so many of them are compared with the scalar solver at 1e-10 (1024)\n");
}

[[noreturn]] void refuse(const std::string& why) {
  std::fprintf(stderr, "benchmark_kinds: %s\n", why.c_str());
  std::exit(2);
}

/// All of `word` as a number from `least` to 1e9.
template <class Number>
Number number_of(std::string_view name, std::string_view word, Number least) {
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = std::is_integral_v<Number>;
  if (error != std::errc() || end != word.data() + word.size() || !(value >= least && value <= Number(1e9))) {
    refuse(std::string(name) + " takes a " + (whole ? "whole " : "") + "number from " +
           (least > Number(0) ? "1" : "0") + " to 1e9, not \"" + std::string(word) + "\"");
  }
  return value;
}

Arguments read_arguments(int argc, char** argv) {
  Arguments a;
  for (int k = 1; k < argc; ++k) {
    const std::string_view word = argv[k];
    const auto value = [&]() -> std::string_view {
      if (++k == argc) refuse(std::string(word) + " lacks its value");
      return argv[k];
    };
    if (word == "--help" || word == "-h") {
      print_usage();
      std::exit(0);
    } else if (word == "--box") {
      a.box = value();
      if (std::find(kind_box_names.begin(), kind_box_names.end(), a.box) == kind_box_names.end()) {
        refuse("there is no box \"" + std::string(a.box) + "\"; --help names them all");
      }
    } else if (word == "--count") {
      a.count = number_of<std::size_t>(word, value(), 1);
    } else if (word == "--checked") {
      a.checked = number_of<std::size_t>(word, value(), 0);
    } else if (word.starts_with("-")) {
      refuse("unknown option \"" + std::string(word) + "\"; --help names them all");
    } else {
      a.seconds = number_of<double>("SECONDS", word, 0.0);
    }
  }
  return a;
}

std::vector<EnsembleMember> members_of(KindBox box, std::size_t count) {
  std::mt19937_64 random(20225);
  std::vector<EnsembleMember> members;
  for (std::size_t n = 0; n < count; ++n) {
    const Design<double> design = kind_design(box, random);
    members.push_back({resolve(design), reporting_of(design)});
  }
  return members;
}

/// Of this thread: others may want the processor, too.
double processor_time() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

double seconds_to_solve(const std::vector<EnsembleMember>& members, const EnsembleOptions& options,
                        const StartUp& start_up, std::vector<EnsembleOutcome>& outcomes) {
  outcomes.resize(members.size());
  const double start = processor_time();
  solve_ensemble(members, options, start_up, outcomes);
  return processor_time() - start;
}

void measure(KindBox box, const Arguments& arguments, const StartUp& start_up) {
  const std::vector<EnsembleMember> members = members_of(box, arguments.count);
  const std::vector<EnsembleMember> reference = members_of(KindBox::reference, arguments.count);
  const std::vector<EnsembleMember> checked(
      members.begin(), members.begin() + std::ptrdiff_t(std::min(arguments.checked, members.size())));
  std::vector<EnsembleOutcome> outcomes, of_reference, expected, one_by_one;
  EnsembleOptions exact;
  exact.scalar_only = true;
  exact.metrics = wanted_sets()[2].metrics;
  exact.tolerance = 1e-10;
  if (!checked.empty()) seconds_to_solve(checked, exact, start_up, expected);
  exact.tolerance = tolerance;
  const std::vector<EnsembleMember> some(members.begin(),
                                         members.begin() + std::ptrdiff_t(std::min<std::size_t>(256, members.size())));
  const double scalar = seconds_to_solve(some, exact, start_up, one_by_one) / double(some.size());

  EnsembleOptions options;
  options.tolerance = tolerance;
  options.metrics = wanted_sets()[1].metrics;
  double best = INFINITY, best_reference = INFINITY, spent = 0.0;
  do {
    const double time = seconds_to_solve(members, options, start_up, outcomes);
    const double beside = seconds_to_solve(reference, options, start_up, of_reference);
    best = std::min(best, time), best_reference = std::min(best_reference, beside);
    spent += time + beside;
  } while (spent < 2.0 * arguments.seconds);

  options.metrics = exact.metrics;
  seconds_to_solve(checked, options, start_up, one_by_one);
  const Errors errors = errors_of(one_by_one, expected, 1, exact.metrics);
  const auto outside =
      std::count_if(errors.worst.begin(), errors.worst.end(), [](double error) { return error > tolerance; });
  int recomputed = 0, no_flap = 0;
  for (const EnsembleOutcome& out : outcomes) {
    recomputed += out.scalar;
    no_flap += out.status != FlappingStatus::flapping;
  }
  std::printf("%-18s %10.0f %6.2f %8.0f %10d %8d | %7zu %9d %8td  %.1e %.1e %.1e  %.1e\n",
              std::string(kind_box_names[std::size_t(box)]).c_str(), double(members.size()) / best,
              best / best_reference, 1.0 / scalar, recomputed, no_flap, checked.size(), errors.other, outside,
              quantile(errors.lift, 0.5), quantile(errors.lift, 0.99), quantile(errors.worst, 0.99),
              quantile(errors.worst, 1.0));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = read_arguments(argc, argv);
  const StartUp start_up = start_up_in_time();
  std::printf("boxes of %zu designs, tolerance %g, power and lift, one core; errors of all metrics but multipliers\n\n",
              arguments.count, tolerance);
  std::printf("%-18s %10s %6s %8s %10s %8s | %7s %9s %8s  %s\n", "box", "designs/s", "ratio", "scalar/s", "recomputed",
              "no flap", "checked", "statuses", "outside", "lift 50 %, 99 %; worst metric 99 %, 100 %");
  for (std::size_t b = 0; b < kind_box_names.size(); ++b) {
    if (arguments.box.empty() || arguments.box == kind_box_names[b]) measure(KindBox(b), arguments, start_up);
  }
  return 0;
}
