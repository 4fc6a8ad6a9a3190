// Slopes of static maps against cycles beside the operating point, against the points of the maps and against the
// steady gain, on random vehicles of each kind, with stops and without. Exit status 1 if any slope is off by more than
// allowed.
//
//   check_maps [COUNT] [--kind crank|four_bar|tabulated|direct|hinged_crank|hinged_direct] [--stops yes|no] [--seed S]
//              [--vehicle N] [--threads T] [--no-points]
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <thread>

#include "study/slope_differences.hpp"
#include "vehicle/map_vehicles.hpp"
#include "wide/words.hpp"
#include "wingbeat/files/design_file.hpp"

namespace {

using namespace wingbeat;

constexpr double gain_apart = 1e-6;  ///< allowed between lift slope and steady gain, of either

struct Arguments {
  std::size_t count = 50, first = 0;
  int kind = -1, stops = -1;
  bool one = false, points = true;
  std::uint32_t seed = 33;
  unsigned threads = std::thread::hardware_concurrency();
};

struct Checked {
  bool flaps = false;
  SlopeCheck cycles, points;
  double gain = 0.0;
  std::string error;
};

Checked checked(const Design<double>& design, bool points) {
  Checked result;
  try {
    validate(design);
    const Linearisation linearisation = linearise(design);
    if (!linearisation.model) return result;
    result.flaps = true;
    result.cycles = slopes_against_cycles(linearisation.orbit);
    result.gain =
        lift_slope_apart(linearisation, wing_load_slopes(linearisation.orbit.record)[0][std::size_t(WingLoad::lift)]);
    if (points) result.points = slopes_against_points(allocation_maps(linearisation, 4e-3));
  } catch (const ParameterError&) {
  } catch (const std::exception& error) {
    result.error = error.what();
  }
  return result;
}

struct Row {
  std::size_t drawn = 0, vehicles = 0, compared = 0, beyond = 0, points = 0, bent = 0, gains = 0, errors = 0;
  double apart = 0.0, worst = 0.0, gain = 0.0;
};

/// Draws vehicles in order of their numbers until `count` flap.
Row check(MapKind kind, bool stops, const Arguments& arguments) {
  const std::size_t max_drawn = arguments.one ? 1 : 20 * arguments.count;
  std::vector<Checked> found(max_drawn);
  std::atomic<std::size_t> next{0}, flapping{0};
  const auto work = [&] {
    for (std::size_t n = next++; n < max_drawn && flapping < arguments.count; n = next++) {
      found[n] =
          checked(map_vehicle(kind, stops, std::uint32_t(arguments.first + n), arguments.seed), arguments.points);
      if (found[n].flaps) ++flapping;
    }
  };
  std::vector<std::thread> threads;
  for (unsigned t = 1; t < arguments.threads; ++t) threads.emplace_back(work);
  work();
  for (std::thread& t : threads) t.join();

  Row row;
  for (std::size_t n = 0; n < max_drawn && row.vehicles < arguments.count; ++n) {
    const Checked& outcome = found[n];
    ++row.drawn;
    const std::size_t number = arguments.first + n;
    const auto remark = [&](const std::string& text) {
      std::printf("%s %zu%s: %s\n", map_kind_names[std::size_t(kind)].data(), number, stops ? " with stops" : "",
                  text.c_str());
    };
    if (!outcome.error.empty()) ++row.errors, remark("threw: " + outcome.error);
    if (!outcome.flaps) continue;
    ++row.vehicles;
    row.compared += std::size_t(outcome.cycles.compared), row.beyond += std::size_t(outcome.cycles.beyond);
    row.points += std::size_t(outcome.points.compared), row.bent += std::size_t(outcome.points.beyond);
    row.apart = std::max(row.apart, outcome.cycles.apart), row.worst = std::max(row.worst, outcome.cycles.worst);
    row.gain = std::max(row.gain, outcome.gain);
    if (outcome.cycles.beyond > 0)
      remark(outcome.cycles.where + ": " + std::to_string(outcome.cycles.worst) + " times what is allowed");
    if (outcome.gain > gain_apart)
      ++row.gains, remark("lift slope off the steady gain by " + std::to_string(outcome.gain));
    if (arguments.one) {
      remark("from cycles at worst " + std::to_string(outcome.cycles.worst) + " (" + outcome.cycles.where +
             "), from points " + std::to_string(outcome.points.worst) + " (" + outcome.points.where +
             ") times what is allowed");
      std::printf("%s", write_design(map_vehicle(kind, stops, std::uint32_t(number), arguments.seed)).c_str());
    }
  }
  return row;
}

Arguments read_arguments(int argc, char** argv) {
  Arguments a;
  Words words("check_maps", argc, argv);
  while (words.next()) {
    if (words.is("--kind")) {
      const std::string name = words.value();
      const auto named = std::find(map_kind_names.begin(), map_kind_names.end(), name);
      if (named == map_kind_names.end()) words.refuse("there is no kind \"" + name + "\"");
      a.kind = int(named - map_kind_names.begin());
    } else if (words.is("--stops")) {
      const std::string name = words.value();
      if (name != "yes" && name != "no") words.refuse("--stops yes or no");
      a.stops = name == "yes";
    } else if (words.is("--no-points")) {
      a.points = false;
    } else if (words.is("--vehicle")) {
      a.one = true, a.first = words.number();
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
  std::size_t wrong = 0;
  std::string table;
  for (int kind = 0; kind < int(map_kind_names.size()); ++kind) {
    for (const bool stops : {false, true}) {
      if ((arguments.kind >= 0 && arguments.kind != kind) || (arguments.stops >= 0 && arguments.stops != int(stops))) {
        continue;
      }
      const Row r = check(MapKind(kind), stops, arguments);
      char line[200];
      std::snprintf(line, sizeof line, "%-14s %-6s %5zu %5zu | %6zu %6zu %8.1e %7.2f | %8.1e | %6zu %6zu | %4zu\n",
                    map_kind_names[std::size_t(kind)].data(), stops ? "stops" : "", r.vehicles, r.drawn, r.compared,
                    r.beyond, r.apart, r.worst, r.gain, r.points, r.bent, r.errors);
      table += line;
      wrong += r.beyond + r.gains + r.errors;
      if (r.vehicles < arguments.count && !arguments.one) ++wrong;
      std::fflush(stdout);
    }
  }
  std::printf("%-21s %5s %5s | %6s %6s %8s %7s | %8s | %6s %6s | %4s\n%s", "kind", "flap", "drawn", "slopes", "beyond",
              "apart", "worst", "gain", "slopes", "beyond", "err", table.c_str());
  std::printf(
      "first block: slopes against cycles beside the operating point; apart: largest distance over load by input;\n"
      "worst: over what is allowed, the error that the differences show and 1e-5; gain: lift slope off the steady\n"
      "gain; second block: slopes against the points of the maps, beyond their stated error: maps with kinks between\n"
      "points\n");
  return wrong > 0 ? 1 : 0;
}
