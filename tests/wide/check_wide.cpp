// Batched solver, orbit search and simulation in time against each other on the wide boxes of
// vehicle/wide_boxes.hpp.
//   check_wide [COUNT]            vehicles of each box, 500 unless given
//     --box NAME                  that box alone (after --packs: reference, friction_laws or smooth_direct)
//     --vehicle N                 that vehicle of the box alone, with its file and every decision
//     --model-option NAME         with added_mass, gear, heat, all_options or pitch on top of every vehicle
//     --seed S  --threads T
//   check_wide --model-options [COUNT]  slider-cranks, four-bars, tabulated laws and direct drives with each option
//   check_wide --packs [COUNT]    batched against scalar orbit alone, slider-cranks around the reference and wide and
//                                 smooth direct drives, with and without model options; 10,000 unless given
// Exit status 1 if any two statuses, or the orbits reached, differ.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include "vehicle/direct_design.hpp"
#include "vehicle/model_options.hpp"
#include "vehicle/random_vehicle.hpp"
#include "vehicle/wide_boxes.hpp"
#include "wide/design_options.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/run.hpp"

using namespace wingbeat;

namespace {

constexpr double tolerance = 1e-6, exact = 1e-9;

struct Answer {
  bool asked = false;
  bool decided = true;
  FlappingStatus status = FlappingStatus::stalled;
  Metrics<double> metrics{};
  std::string detail;
  double seconds = 0.0;
  bool scalar = false;

  const char* name() const { return asked ? name_of(status) : "-"; }
};

struct Comparison {
  Answer batched, orbit, transient, reference;
  bool any_flapping() const { return reference.asked && reference.status == FlappingStatus::flapping; }
};

template <class F>
double seconds_of(const F& f) {
  const auto now = [] {  // of this thread: others may want the processor, too
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
  };
  const double start = now();
  f();
  return now() - start;
}

Answer by_run(const WideVehicle& vehicle, Method method, double tolerance_wanted) {
  Answer answer;
  answer.asked = true;
  RunOptions options;
  options.condition = vehicle.condition;
  options.method = method;
  options.tolerance = tolerance_wanted;
  RunResult result;
  try {
    answer.seconds = seconds_of([&] { result = run_design(vehicle.design, options); });
  } catch (const std::exception& error) {
    answer.decided = false;
    answer.status = FlappingStatus::undecided;
    answer.detail = std::string("threw: ") + error.what();
    return answer;
  }
  answer.decided = result.status != FlappingStatus::undecided;
  answer.status = result.status;
  answer.metrics = result.metrics;
  answer.detail = describe(result);
  return answer;
}

/// Whether the motor moves a load: without friction and air, its mean output is what rounding leaves.
bool has_load(const Metrics<double>& m) {
  return std::abs(m[Metric::power_motor]) > 1e-6 * std::abs(m[Metric::power_electrical]);
}

/// What an error of a metric is measured by: the metric, but for those that may vanish.
double scale_of(Metric metric, const Metrics<double>& m) {
  switch (metric) {
    case Metric::power_motor: return std::abs(m[has_load(m) ? metric : Metric::power_electrical]);
    case Metric::efficiency_motor: return has_load(m) ? std::abs(m[metric]) : 1.0;
    case Metric::power_gear:
    case Metric::power_residual:
    case Metric::power_loss: return std::max(std::abs(m[metric]), scale_of(Metric::power_motor, m));
    case Metric::current_mean:  // that of a direct drive alternates
      return std::max(error_scale(m, metric), 0.01 * std::abs(m[Metric::current_peak]));
    case Metric::angle_of_attack_min: return std::max(90.0, std::abs(m[metric]));
    case Metric::crank_speed_min: return std::abs(m[Metric::crank_speed_max]);
    case Metric::lift_mean: return std::abs(m[Metric::lift_peak]);
    case Metric::lift_to_weight:
      return m[Metric::lift_mean] == 0.0 ? 1.0 : std::abs(m[Metric::lift_peak] * m[metric] / m[Metric::lift_mean]);
    default: return std::abs(m[metric]);
  }
}

/// Largest relative error of the metrics, the Floquet multiplier aside; infinite where only one of two is absent.
double largest_error(const Metrics<double>& got, const Metrics<double>& expected, Metric& where) {
  double largest = 0.0;
  for (int k = 0; k < metric_count; ++k) {
    const Metric metric = Metric(k);
    if (metric == Metric::floquet_multiplier_max) continue;
    if (metric == Metric::efficiency_mechanism && !has_load(expected)) continue;  // 0 / 0
    const double difference = std::abs(got[metric] - expected[metric]), scale = scale_of(metric, expected);
    const bool one_absent = std::isnan(got[metric]) != std::isnan(expected[metric]);
    if (!one_absent && !(difference > largest * scale)) continue;
    largest = !one_absent && scale > 0.0 ? difference / scale : INFINITY;
    where = metric;
  }
  return largest;
}

bool on_a_sine(const Design<double>& d) {
  return d.supply.type == SupplyType::sine && d.transmission.type != TransmissionType::direct;
}

/// How many answers are off by more than 1, 10 and 100 times the tolerance, and the most.
struct Errors {
  std::array<int, 3> beyond{};
  double largest = 0.0;

  void add(double error) {
    double limit = tolerance;
    for (int& count : beyond) count += !(error <= limit), limit *= 10.0;
    largest = std::max(largest, error);
  }
  void add(const Errors& other) {
    for (std::size_t n = 0; n < beyond.size(); ++n) beyond[n] += other.beyond[n];
    largest = std::max(largest, other.largest);
  }
};

struct Counts {
  int vehicles = 0, by_status[5] = {}, batched_other = 0, orbit_other = 0, batched_differs = 0, orbit_differs = 0,
      undecided = 0, averages = 0;
  Errors batched, orbit, transient;
  double orbit_seconds = 0.0, transient_seconds = 0.0, batched_seconds = 0.0;
};

bool differs(const Answer& a, const Answer& b) {
  return a.asked && b.asked && (a.decided != b.decided || (a.decided && a.status != b.status));
}

/// Both flap, at frequencies that differ by more than a thousandth: on different orbits.
bool on_another_orbit(const Answer& a, const Answer& b) {
  if (!a.asked || !b.asked || a.status != FlappingStatus::flapping || b.status != FlappingStatus::flapping)
    return false;
  return !(std::abs(a.metrics[Metric::frequency] / b.metrics[Metric::frequency] - 1.0) < 1e-3);
}

void print_header() {
  std::printf("%-24s %5s | %-34s | %-15s | %-15s | %-21s | %s\n", "", "", "by simulation in time", "status differs",
              "another orbit", "metrics off by > 1e-6", "processor time, largest");
  std::printf("%-24s %5s | %5s %6s %5s %4s %10s | %7s %7s | %7s %7s | %7s %6s %6s | %10s %8s %10s\n", "box", "count",
              "flap", "stall", "lock", "jam", "undecided", "batched", "orbit", "batched", "orbit", "batched", "orbit",
              "time", "batch, mean", "orbit", "simulation");
}

void print_row(const std::string& name, const Counts& c) {
  std::printf("%-24s %5d | %5d %6d %5d %4d %10d | %7d %7d | %7d %7d | %7d %6d %6d | %8.2f ms %6.3f s %8.2f s\n",
              name.c_str(), c.vehicles, c.by_status[0], c.by_status[1], c.by_status[2], c.by_status[3], c.by_status[4],
              c.batched_differs, c.orbit_differs, c.batched_other, c.orbit_other, c.batched.beyond[0],
              c.orbit.beyond[0], c.transient.beyond[0], 1e3 * c.batched_seconds / std::max(1, c.vehicles),
              c.orbit_seconds, c.transient_seconds);
}

void add(Counts& to, const Counts& c) {
  to.vehicles += c.vehicles;
  for (int k = 0; k < 5; ++k) to.by_status[k] += c.by_status[k];
  to.batched_differs += c.batched_differs;
  to.orbit_differs += c.orbit_differs;
  to.batched_other += c.batched_other;
  to.orbit_other += c.orbit_other;
  to.undecided += c.undecided;
  to.batched.add(c.batched);
  to.orbit.add(c.orbit);
  to.transient.add(c.transient);
  to.batched_seconds += c.batched_seconds;
  to.orbit_seconds = std::max(to.orbit_seconds, c.orbit_seconds);
  to.transient_seconds = std::max(to.transient_seconds, c.transient_seconds);
}

enum class PacksBox { reference, wide, direct };
constexpr std::array packs_boxes = {std::pair{std::string_view("reference"), PacksBox::reference},
                                    std::pair{std::string_view("friction_laws"), PacksBox::wide},
                                    std::pair{std::string_view("smooth_direct"), PacksBox::direct}};

struct Arguments {
  int count = 500, only_box = -1, only_vehicle = -1, threads = int(std::thread::hardware_concurrency());
  std::uint32_t seed = 12;
  ModelOption option = ModelOption::none;
  bool model_options = false, packs = false;
  std::string_view packs_of = "";  ///< the box alone
};

Arguments read_arguments(int argc, char** argv) {
  Arguments a;
  for (int k = 1; k < argc; ++k) {
    const std::string_view word = argv[k];
    const char* value = k + 1 < argc ? argv[k + 1] : nullptr;
    const auto number = [&] {
      return value ? std::atoi(argv[++k]) : (std::fprintf(stderr, "%s needs a number\n", argv[k]), std::exit(2), 0);
    };
    if (word == "--box" && a.packs) {
      a.packs_of = value ? value : "";
      if (!std::any_of(packs_boxes.begin(), packs_boxes.end(), [&](auto& box) { return box.first == a.packs_of; })) {
        std::fprintf(stderr, "--box: none of that name\n"), std::exit(2);
      }
      ++k;
    } else if (word == "--box") {
      for (std::size_t b = 0; value && b < far_box_names.size(); ++b) {
        if (far_box_names[b] == value) a.only_box = int(b);
      }
      if (a.only_box < 0) std::fprintf(stderr, "--box: none of that name\n"), std::exit(2);
      ++k;
    } else if (word == "--model-option") {
      for (std::size_t r = 0; value && r < model_option_names.size(); ++r) {
        if (model_option_names[r] == value) a.option = ModelOption(r);
      }
      if (a.option == ModelOption::none) std::fprintf(stderr, "--model-option: none of that name\n"), std::exit(2);
      ++k;
    } else if (word == "--model-options") {
      a.model_options = true, a.count = 200;
    } else if (word == "--packs") {
      a.packs = true, a.count = 10000;
    } else if (word == "--vehicle") {
      a.only_vehicle = number();
    } else if (word == "--seed") {
      a.seed = std::uint32_t(number());
    } else if (word == "--threads") {
      a.threads = number();
    } else if ((a.count = std::atoi(argv[k])) < 1) {
      std::fprintf(stderr, "check_wide: what is \"%s\"?\n", argv[k]), std::exit(2);
    }
  }
  return a;
}

Counts check_box(FarBox box, const Arguments& arguments) {
  const bool one = arguments.only_vehicle >= 0;
  const std::size_t count = one ? 1 : std::size_t(arguments.count);
  const auto number_of = [&](std::size_t n) { return std::uint32_t(one ? arguments.only_vehicle : int(n)); };
  std::vector<WideVehicle> vehicles(count);
  for (std::size_t n = 0; n < count; ++n) {
    vehicles[n] = wide_vehicle(box, number_of(n), arguments.seed);
    add_model_option(vehicles[n].design, arguments.option, number_of(n), arguments.seed);
    validate(vehicles[n].design);
  }
  std::vector<Comparison> found(count);

  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t n = next++; n < count; n = next++) {
      Comparison& c = found[n];
      c.transient = by_run(vehicles[n], Method::transient, tolerance);
      if (on_a_sine(vehicles[n].design)) continue;
      c.orbit = by_run(vehicles[n], Method::orbit, tolerance);
      if (c.orbit.status == FlappingStatus::flapping) c.reference = by_run(vehicles[n], Method::orbit, exact);
    }
  };
  std::vector<std::thread> threads;
  for (int t = 1; t < arguments.threads; ++t) threads.emplace_back(work);
  work();
  for (std::thread& t : threads) t.join();

  std::vector<EnsembleMember> members;
  std::vector<std::size_t> member_of;
  for (std::size_t n = 0; n < count; ++n) {
    if (on_a_sine(vehicles[n].design)) continue;
    members.push_back({resolve(vehicles[n].design, vehicles[n].condition), reporting_of(vehicles[n].design)});
    member_of.push_back(n);
  }
  std::vector<EnsembleOutcome> outcomes(members.size());
  Counts c;
  c.batched_seconds = seconds_of([&] { solve_ensemble(members, {}, start_up_in_time(), outcomes); });
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    Answer& a = found[member_of[k]].batched;
    a.asked = true;
    a.status = outcomes[k].status;
    a.decided = a.status != FlappingStatus::undecided;
    a.metrics = outcomes[k].metrics;
    a.scalar = outcomes[k].scalar;
  }

  c.vehicles = int(count);
  for (std::size_t n = 0; n < count; ++n) {
    const Comparison& v = found[n];
    ++c.by_status[std::size_t(v.transient.status)];
    c.undecided += !v.transient.decided;
    const bool batched_differs = differs(v.batched, v.transient), orbit_differs = differs(v.orbit, v.transient);
    const bool averages = vehicles[n].design.supply.type == SupplyType::pwm;  // cycles share no period with the supply
    const bool batched_other = !averages && on_another_orbit(v.batched, v.transient);
    const bool orbit_other = !averages && on_another_orbit(v.orbit, v.transient);
    c.batched_other += batched_other;
    c.orbit_other += orbit_other;
    c.batched_differs += batched_differs;
    c.orbit_differs += orbit_differs;
    c.orbit_seconds = std::max(c.orbit_seconds, v.orbit.seconds);
    c.transient_seconds = std::max(c.transient_seconds, v.transient.seconds);
    const auto compare = [&](const char* name, const Answer& a, Errors& errors) {
      if (!v.any_flapping() || !a.asked || !a.decided || a.status != FlappingStatus::flapping) return;
      Metric where{};
      const double error = largest_error(a.metrics, v.reference.metrics, where);
      errors.add(error);
      if (error <= 100.0 * tolerance) return;
      std::printf("%s %u: %s by %s %.9g, to 1e-9 %.9g, off by %.2g of its scale\n",
                  std::string(far_box_names[std::size_t(box)]).c_str(), number_of(n), metric_info(where).key, name,
                  a.metrics[where], v.reference.metrics[where], error);
    };
    if (!batched_other) compare("batched", v.batched, c.batched);
    if (!orbit_other) compare("orbit", v.orbit, c.orbit);
    if (!averages) compare("transient", v.transient, c.transient);
    const bool slow = v.orbit.seconds > 0.5 || v.transient.seconds > 5.0;
    if (one || batched_differs || orbit_differs || batched_other || orbit_other || !v.transient.decided || slow) {
      std::printf("%s %u: batched %s%s, orbit %s (%.3f s), transient %s (%.2f s)\n    orbit: %s\n    transient: %s\n",
                  std::string(far_box_names[std::size_t(box)]).c_str(), number_of(n), v.batched.name(),
                  v.batched.scalar ? " (recomputed)" : "", v.orbit.name(), v.orbit.seconds, v.transient.name(),
                  v.transient.seconds, v.orbit.detail.c_str(), v.transient.detail.c_str());
    }
    if (one) {
      print_design(vehicles[n]);
      if (v.any_flapping()) {
        for (const auto& [name, answer] :
             {std::pair{"batched", &v.batched}, {"orbit", &v.orbit}, {"transient", &v.transient}}) {
          Metric where{};
          const double error = largest_error(answer->metrics, v.reference.metrics, where);
          std::printf("# %s: largest error %.2g, of %s\n", name, error, metric_info(where).key);
        }
      }
      for (const auto& [name, answer] : {std::pair{"orbit", &v.orbit}, {"transient", &v.transient}}) {
        const Metrics<double>& m = answer->metrics;
        std::printf("# %s: %.8g Hz, crank speed %.8g to %.8g rad/s, multiplier %.6g\n", name, m[Metric::frequency],
                    m[Metric::crank_speed_min], m[Metric::crank_speed_max], m[Metric::floquet_multiplier_max]);
      }
    }
    std::fflush(stdout);
  }
  return c;
}

std::string name_with_option(std::string_view name, ModelOption option) {
  return std::string(name) +
         (option == ModelOption::none ? "" : "+" + std::string(model_option_names[std::size_t(option)]));
}

/// Packs against the scalar orbit search, both at the tolerance; no simulation in time, which the ensemble asks by
/// itself where a start is needed. Returns how many statuses differ.
int check_packs(const Arguments& arguments) {
  std::printf("%-28s %6s %9s | %8s %14s | %s\n", "", "count", "by packs", "statuses", "metrics apart", "largest");
  std::printf("%-28s %6s %9s | %8s %14s | %s\n", "box", "", "", "differ", "> 2e-6", "relative");
  int other = 0;
  for (const auto& [name, kind] : packs_boxes) {
    for (const ModelOption option :
         {ModelOption::none, ModelOption::added_mass, ModelOption::gear, ModelOption::heat, ModelOption::all}) {
      if (!arguments.packs_of.empty() && arguments.packs_of != name) continue;
      if (kind == PacksBox::direct && option == ModelOption::gear) continue;  // no gear efficiency of a direct drive
      const std::string box = name_with_option(name, option);
      std::vector<EnsembleMember> members;
      std::vector<WideVehicle> vehicles;
      std::mt19937_64 random(arguments.seed);
      for (int n = 0; n < arguments.count; ++n) {
        WideVehicle v;
        if (kind == PacksBox::wide) v = wide_vehicle(FarBox::friction_laws, std::uint32_t(n), arguments.seed);
        else v.design = kind == PacksBox::direct ? smooth_direct_design(random) : box_design(random);
        add_model_option(v.design, option, std::uint32_t(n), arguments.seed);
        validate(v.design);
        members.push_back({resolve(v.design, v.condition), reporting_of(v.design)});
        vehicles.push_back(v);
      }
      std::vector<EnsembleOutcome> outcomes(members.size());
      solve_ensemble(members, {}, start_up_in_time(), outcomes);
      std::vector<Answer> scalar(members.size());
      std::atomic<std::size_t> next{0};
      const auto work = [&] {
        for (std::size_t n = next++; n < scalar.size(); n = next++)
          scalar[n] = by_run(vehicles[n], Method::orbit, tolerance);
      };
      std::vector<std::thread> threads;
      for (int t = 1; t < arguments.threads; ++t) threads.emplace_back(work);
      work();
      for (std::thread& t : threads) t.join();
      int by_packs = 0, statuses = 0, apart = 0;
      double largest = 0.0;
      for (std::size_t n = 0; n < scalar.size(); ++n) {
        by_packs += !outcomes[n].scalar;
        if (outcomes[n].status != scalar[n].status) {
          ++statuses;
          std::printf("%s %zu: batched %s, orbit %s: %s\n", box.c_str(), n, name_of(outcomes[n].status),
                      scalar[n].name(), scalar[n].detail.c_str());
        } else if (scalar[n].status == FlappingStatus::flapping) {
          Metric where{};
          const double error = largest_error(outcomes[n].metrics, scalar[n].metrics, where);
          largest = std::max(largest, error);
          if (error <= 2.0 * tolerance) continue;
          ++apart;
          std::printf("%s %zu: %s apart by %.2g\n", box.c_str(), n, metric_info(where).key, error);
        }
      }
      std::printf("%-28s %6d %9d | %8d %14d | %.2g\n", box.c_str(), arguments.count, by_packs, statuses, apart,
                  largest);
      std::fflush(stdout);
      other += statuses;
    }
  }
  return other;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = read_arguments(argc, argv);
  if (arguments.packs) return check_packs(arguments) > 0 ? 1 : 0;
  std::vector<std::pair<std::string, Counts>> rows;
  Counts total;
  const auto start = std::chrono::steady_clock::now();
  const auto check = [&](FarBox box, ModelOption option) {
    Arguments with = arguments;
    with.option = option;
    rows.emplace_back(name_with_option(far_box_names[std::size_t(box)], option), check_box(box, with));
    add(total, rows.back().second);
  };
  if (arguments.model_options) {
    for (const FarBox box : {FarBox::friction_laws, FarBox::four_bar, FarBox::tabulated, FarBox::direct}) {
      for (const ModelOption option :
           {ModelOption::added_mass, ModelOption::gear, ModelOption::heat, ModelOption::all}) {
        if (option != ModelOption::gear || box != FarBox::direct)
          check(box, option);  // no gear efficiency of a direct drive
      }
    }
  } else {
    for (int b = 0; b < int(far_box_names.size()); ++b) {
      if (arguments.only_box < 0 || b == arguments.only_box) check(FarBox(b), arguments.option);
    }
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  print_header();
  for (const auto& [name, counts] : rows) print_row(name, counts);
  if (rows.size() > 1) print_row("all", total);
  for (const auto& [name, errors] :
       {std::pair{"batched", &total.batched}, {"orbit", &total.orbit}, {"simulation", &total.transient}}) {
    std::printf("metrics by %s: off by more than 1e-6 %d, 1e-5 %d, 1e-4 %d; the most %.2g\n", name, errors->beyond[0],
                errors->beyond[1], errors->beyond[2], errors->largest);
  }
  std::printf("%.0f s on %d threads\n", seconds, arguments.threads);
  return total.batched_differs + total.orbit_differs + total.batched_other + total.orbit_other > 0 ? 1 : 0;
}
