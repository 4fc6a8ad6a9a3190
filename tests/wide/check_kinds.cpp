// Orbit search, simulation in time and batched solver on the boxes of vehicle/further_boxes.hpp: statuses, metrics,
// energy balances, processor time.
//   check_kinds [COUNT]   vehicles of each box, 1000 unless given
//     --box NAME          that box alone
//     --vehicle N         that vehicle of the box alone, with its file and every metric that differs
//     --first N           numbers from N on
//     --seed S  --threads T
// Exit status 1 if statuses differ, metrics are apart by more than 1e-5, or an energy balance is open by more than ten
// times the tolerance.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "vehicle/further_boxes.hpp"
#include "wide/words.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/vehicle/motion.hpp"

using namespace wingbeat;

namespace {

constexpr double tolerance = 1e-6, metrics_apart = 1e-5, balance_open = 10.0 * tolerance, slow_seconds = 5.0;

struct Arguments {
  std::size_t count = 1000, first = 0;
  int only_box = -1;
  bool one = false;
  std::uint32_t seed = 12;
  unsigned threads = std::thread::hardware_concurrency();
};

enum Solver { by_orbit, in_time, batched, solver_count };
constexpr const char* solver_names[] = {"orbit", "time", "batch"};

struct Answer {
  bool asked = false;
  FlappingStatus status = FlappingStatus::undecided;
  bool settled = true;
  Metrics<double> metrics{};
  std::string detail;
  double seconds = 0.0;
  bool flaps() const { return asked && status == FlappingStatus::flapping; }
};

double thread_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

Answer run(const WideVehicle& vehicle, Method method) {
  Answer answer;
  answer.asked = true;
  RunOptions options;
  options.condition = vehicle.condition;
  options.method = method;
  options.tolerance = tolerance;
  const double start = thread_seconds();
  try {
    const RunResult result = run_design(vehicle.design, options);
    answer.status = result.status;
    answer.settled = result.settled;
    answer.metrics = result.metrics;
    answer.detail = describe(result);
  } catch (const std::exception& error) {
    answer.detail = std::string("threw: ") + error.what();
  }
  answer.seconds = thread_seconds() - start;
  return answer;
}

/// A thousandth of what the blocked motors take [W]: states that are accurate to the tolerance give powers that are
/// accurate to it beside the blocked motor's, and of a vehicle that takes next to nothing those alone can be compared.
double least_power(const WideVehicle& w) {
  const Vehicle<double> v = resolve(w.design, w.condition);
  if (is_given(v.piezo)) {
    const Piezo<double>& p = v.piezo;
    return 1e-3 * square(p.force_per_volt * v.voltage) / std::sqrt(p.stiffness * p.mass);
  }
  return 1e-3 * v.motors * square(v.voltage) / circuit_resistance(v);
}

/// What is left of the input beside the sum of what enters and leaves.
double open_share(const Metrics<double>& m, double least) {
  const EnergyAudit a = energy_audit(m);
  const double size = std::abs(a.electrical) + std::abs(a.copper) + std::abs(a.viscous) + std::abs(a.motor_friction) +
                      std::abs(a.gear) + std::abs(a.friction) + std::abs(a.hinge) + std::abs(a.aerodynamic) +
                      std::abs(a.residual) + least;
  const double share = std::abs(a.imbalance) / size;
  // Motor output is what the input leaves after the motor's own losses and the gearbox; losses are not negative.
  const double motor = a.electrical - a.electronics - a.copper - a.viscous - a.motor_friction - a.gear;
  const double output = std::abs(m[Metric::power_motor] - motor) / size;
  const double negative = -std::min({0.0, a.copper, a.viscous, a.motor_friction, a.gear, a.friction, a.hinge}) / size;
  return std::max({share, output, negative});
}

/// What a difference of a metric is measured by, where error_scale() may still vanish beside what makes it up.
double scale_of(const Metrics<double>& m, Metric which, double least) {
  const double size = error_scale(m, which);
  const double lift = std::max(m[Metric::lift_peak], std::abs(m[Metric::lift_mean]));
  const double input = std::max(
      {std::abs(m[Metric::power_electrical]), std::abs(m[Metric::power_motor]), m[Metric::power_copper], least});
  const double current = std::max(m[Metric::current_peak], least / std::abs(m[Metric::voltage]));
  switch (which) {
    case Metric::power_electrical:
    case Metric::power_copper:
    case Metric::power_motor:
    case Metric::power_motor_reference:
    case Metric::power_gear:
    case Metric::power_loss:
    case Metric::power_hinge:
    case Metric::power_residual: return std::max(size, input);
    case Metric::efficiency_motor:
    case Metric::efficiency_system: return std::max(size, input / std::abs(m[Metric::power_electrical]));
    case Metric::efficiency_mechanism: return std::max(size, input / std::abs(m[Metric::power_motor]));
    // A wing whose lift is downward throughout has a highest lift of nothing.
    case Metric::lift_mean:
    case Metric::lift_peak: return std::max(size, lift);
    case Metric::lift_added_mass_share: return std::max(size, lift / std::abs(m[Metric::lift_mean]));
    case Metric::lift_to_weight: return std::abs(lift * m[which] / m[Metric::lift_mean]);
    case Metric::crank_speed_min: return m[Metric::crank_speed_max];
    case Metric::current_mean: return std::max(size, 0.01 * current);
    case Metric::current_peak:
    case Metric::current_rms: return current;
    default: return size;
  }
}

double apart(const Metrics<double>& a, const Metrics<double>& b, Metric which, double least) {
  if (which == Metric::floquet_multiplier_max || which == Metric::endurance || which == Metric::hover) return 0.0;
  // Of no power within what the states are accurate to, there is no efficiency that could be compared.
  const double beyond = 1e-3 * std::max({least, std::abs(b[Metric::power_electrical]), b[Metric::power_copper]});
  const bool of_nothing = (which == Metric::efficiency_mechanism && std::abs(b[Metric::power_motor]) < beyond) ||
                          (which == Metric::efficiency_system && std::abs(b[Metric::power_electrical]) < beyond) ||
                          (which == Metric::efficiency_motor && std::abs(b[Metric::power_electrical]) < beyond);
  if (of_nothing) return 0.0;
  if (std::isnan(a[which]) != std::isnan(b[which])) return INFINITY;
  const double difference = std::abs(a[which] - b[which]);
  return difference > 0.0 ? difference / scale_of(b, which, least) : 0.0;
}

double apart(const Metrics<double>& a, const Metrics<double>& b, double least, const char*& where) {
  double worst = 0.0;
  for (int k = 0; k < metric_count; ++k) {
    const double off = apart(a, b, Metric(k), least);
    if (off > worst) worst = off, where = metric_info(Metric(k)).key;
  }
  return worst;
}

struct Row {
  std::size_t vehicles = 0, by_status[5] = {}, undecided[solver_count] = {}, differs[solver_count] = {},
              metrics[solver_count] = {}, open[solver_count] = {}, slow[solver_count] = {};
  double apart[solver_count] = {}, imbalance[solver_count] = {}, seconds[solver_count] = {};
};

bool is_direct(const Design<double>& d) { return d.transmission.type == TransmissionType::direct; }
/// No periodic orbit in crank angle.
bool in_time_alone(const Design<double>& d) { return d.supply.type == SupplyType::sine && !is_direct(d); }

Row check(FurtherBox box, const Arguments& arguments) {
  const std::size_t count = arguments.one ? 1 : arguments.count;
  std::vector<WideVehicle> vehicles(count);
  std::vector<std::array<Answer, solver_count>> found(count);
  for (std::size_t n = 0; n < count; ++n) {
    vehicles[n] = further_vehicle(box, std::uint32_t(arguments.first + n), arguments.seed);
  }
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t n = next++; n < count; n = next++) {
      found[n][in_time] = run(vehicles[n], Method::transient);
      if (in_time_alone(vehicles[n].design)) continue;
      found[n][by_orbit] = run(vehicles[n], Method::orbit);
      Answer& answer = found[n][batched];
      answer.asked = true;
      const EnsembleMember member{resolve(vehicles[n].design, vehicles[n].condition), reporting_of(vehicles[n].design)};
      EnsembleOutcome outcome;
      const double start = thread_seconds();
      solve_ensemble({&member, 1}, {}, start_up_in_time(), {&outcome, 1});
      answer.seconds = thread_seconds() - start;
      answer.status = outcome.status;
      answer.metrics = outcome.metrics;
      answer.detail = outcome.scalar ? "by the scalar solver" : "on lanes";
    }
  };
  std::vector<std::thread> threads;
  for (unsigned t = 1; t < arguments.threads; ++t) threads.emplace_back(work);
  work();
  for (std::thread& t : threads) t.join();

  Row row;
  row.vehicles = count;
  for (std::size_t n = 0; n < count; ++n) {
    const auto& outcome = found[n];
    const Answer& reference = outcome[in_time];
    const double least = least_power(vehicles[n]);
    ++row.by_status[std::size_t(reference.status)];
    const bool averages = vehicles[n].design.supply.type == SupplyType::pwm;  // cycles share no period with the supply
    std::string remarks;
    const auto remark = [&](const std::string& text) { remarks += "\n    " + text; };
    for (int s = 0; s < solver_count; ++s) {
      const Answer& a = outcome[std::size_t(s)];
      if (!a.asked) continue;
      const std::string name = solver_names[s];
      row.seconds[s] = std::max(row.seconds[s], a.seconds);
      if (a.seconds > slow_seconds) ++row.slow[s], remark(name + ": " + std::to_string(a.seconds) + " s");
      if (a.status == FlappingStatus::undecided) ++row.undecided[s], remark(name + " undecided: " + a.detail);
      if (a.status != reference.status) {
        ++row.differs[s];
        remark(name + ": " + name_of(a.status) + " (" + a.detail + "), time: " + name_of(reference.status) + " (" +
               reference.detail + ")");
        continue;
      }
      if (!a.flaps()) continue;
      const double open = averages && s == in_time ? 0.0 : open_share(a.metrics, least);
      row.imbalance[s] = std::max(row.imbalance[s], open);
      if (!(open <= balance_open)) ++row.open[s], remark(name + ": energy balance open by " + std::to_string(open));
      if (averages && s == by_orbit) continue;
      const Answer& beside = s == batched ? outcome[by_orbit] : reference;
      const char* where = "";
      const double off = s == in_time || !beside.flaps() ? 0.0 : apart(a.metrics, beside.metrics, least, where);
      if (std::isfinite(off)) row.apart[s] = std::max(row.apart[s], off);
      if (off > metrics_apart) {
        ++row.metrics[s];
        remark(name + ": " + where + " apart by " + std::to_string(off) + (reference.settled ? "" : ", not settled"));
      }
    }
    if (!remarks.empty() || arguments.one) {
      std::printf("%s %zu (%s)%s\n", std::string(further_box_names[std::size_t(box)]).c_str(), arguments.first + n,
                  name_of(reference.status), remarks.c_str());
    }
    if (arguments.one) {
      std::printf("# condition %s\n%s", name_of(vehicles[n].condition), write_design(vehicles[n].design).c_str());
      for (int k = 0; k < metric_count; ++k) {
        std::printf("# %-34s %22.15g %22.15g %22.15g\n", metric_info(Metric(k)).key,
                    outcome[by_orbit].metrics[Metric(k)], outcome[in_time].metrics[Metric(k)],
                    outcome[batched].metrics[Metric(k)]);
      }
    }
    std::fflush(stdout);
  }
  return row;
}

void print(const std::string& name, const Row& r) {
  std::printf("%-16s %5zu | %5zu %5zu %5zu %5zu |", name.c_str(), r.vehicles, r.by_status[0], r.by_status[1],
              r.by_status[2], r.by_status[3]);
  for (int s = 0; s < solver_count; ++s) {
    std::printf(" %4zu %4zu %5zu %7.1e %4zu %7.1e %3zu %5.2f s |", r.undecided[s], r.differs[s], r.metrics[s],
                r.apart[s], r.open[s], r.imbalance[s], r.slow[s], r.seconds[s]);
  }
  std::printf("\n");
}

Arguments read_arguments(int argc, char** argv) {
  Arguments a;
  Words words("check_kinds", argc, argv);
  while (words.next()) {
    if (words.is("--box")) {
      const std::string name = words.value();
      const auto named = std::find(further_box_names.begin(), further_box_names.end(), name);
      if (named == further_box_names.end()) words.refuse("there is no box \"" + name + "\"");
      a.only_box = int(named - further_box_names.begin());
    } else if (words.is("--vehicle")) {
      a.one = true, a.first = words.number();
    } else if (words.is("--first")) {
      a.first = words.number();
    } else if (words.is("--seed")) {
      a.seed = std::uint32_t(words.number());
    } else if (words.is("--threads")) {
      a.threads = unsigned(std::max<std::size_t>(1, words.number()));
    } else if (words.is_option()) {
      words.refuse("unknown option " + words.word());
    } else {
      a.count = words.number_in(words.word());
    }
  }
  return a;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = read_arguments(argc, argv);
  std::vector<std::pair<std::string, Row>> rows;
  for (int b = 0; b < int(further_box_names.size()); ++b) {
    if (arguments.only_box >= 0 && b != arguments.only_box) continue;
    rows.emplace_back(further_box_names[std::size_t(b)], check(FurtherBox(b), arguments));
    print(rows.back().first, rows.back().second);  // kept where a run of hours is ended
    std::fflush(stdout);
  }
  std::printf("%-16s %5s | %5s %5s %5s %5s |", "", "", "flap", "stall", "lock", "jam");
  for (const char* name : solver_names) std::printf(" %-48s |", name);
  std::printf("\n%-16s %5s | %23s |", "box", "count", "by simulation");
  for (int s = 0; s < solver_count; ++s) {
    std::printf(" %4s %4s %5s %7s %4s %7s %3s %7s |", "und", "diff", ">1e-5", "worst", "open", "worst", ">5s", "most");
  }
  std::printf("\n");
  std::size_t wrong = 0;
  for (const auto& [name, row] : rows) {
    print(name, row);
    for (int s = 0; s < solver_count; ++s) wrong += row.differs[s] + row.metrics[s] + row.open[s];
  }
  std::printf(
      "und: undecided; diff: status other than by simulation; > 1e-5: a metric apart by more, of orbits from "
      "simulations, of batches from orbits;\nopen: energy balance, motor output or the sign of a loss off by "
      "more than 1e-5 of all powers; > 5 s: of processor time\n");
  return wrong > 0 ? 1 : 0;
}
