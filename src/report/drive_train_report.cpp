#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/report_tools.hpp"
#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/report/optimise_report.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {
namespace {

using detail::optimum_width, detail::parameter_text, detail::with_unit;
using Outcome = CombinationOutcome;

/// "6 motors, 12 gearboxes and 8 batteries", without those that cannot be used.
std::string counted_parts(const OptimiseFile& file) {
  std::vector<std::string> parts;
  const auto count = [&](const auto& list, const char* one, const char* several) {
    const auto usable = std::count_if(list.begin(), list.end(), [](const auto& p) { return p.refused.empty(); });
    if (usable > 0) parts.push_back(fmt::format("{} {}", usable, usable == 1 ? one : several));
  };
  count(file.motors, "motor", "motors");
  count(file.drive_train.gearboxes, "gearbox", "gearboxes");
  count(file.drive_train.batteries, "battery", "batteries");
  std::string text;
  for (std::size_t n = 0; n < parts.size(); ++n) {
    text += (n == 0 ? "" : n + 1 == parts.size() ? " and " : ", ") + parts[n];
  }
  return text;
}

/// "(3 stalled, 12 unreached)"; empty where there is none.
std::string in_parentheses(const std::vector<std::pair<std::uint64_t, std::string>>& counts) {
  std::string text;
  for (const auto& [count, name] : counts) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
  }
  return text.empty() ? text : "   designs: " + text;
}

template <class Out>
void text_screen(Out& out, const OptimiseFile& file, const DriveTrainScreen& screen) {
  fmt::format_to(out, "{} combinations of {}", screen.combinations.size(), counted_parts(file));
  const std::uint64_t each = screen.combinations.empty() ? 0 : screen.designs / screen.combinations.size();
  if (each > 1) fmt::format_to(out, ", {} designs of each", each);
  fmt::format_to(out, "\n");
  std::vector<std::pair<std::uint64_t, std::string>> still, beyond;
  for (int s = 1; s < sweep_status_count; ++s) {
    still.emplace_back(screen.status[std::size_t(s)], name_of(SweepStatus(s)));
  }
  for (std::size_t k = 0; k < screen.beyond.size(); ++k) {
    beyond.emplace_back(screen.beyond[k], domain_limit_table()[k].key);
  }
  const auto row = [&](const char* what, Outcome outcome, const std::string& why) {
    fmt::format_to(out, "  {:<40}{:>9}{}\n", what, screen.outcomes[std::size_t(outcome)], why);
  };
  row("within every limit", Outcome::within, "");
  row("excluded by a limit", Outcome::excluded, "");
  row("outside the model's domain", Outcome::outside, in_parentheses(beyond));
  row("do not flap, or not as asked for", Outcome::does_not_flap, in_parentheses(still));
  if (!screen.limits.empty()) {
    fmt::format_to(out, "\n{:<42}{:>9}{:>16}\n", "Combinations excluded by", "", "by nothing else");
    for (const LimitCount& l : screen.limits) {
      fmt::format_to(out, "  {:<40}{:>9}{:>16}\n", l.limit, l.excluded, l.alone);
    }
  }
}

/// What the lists lack.
template <class Out>
void text_left_out(Out& out, const OptimiseFile& file) {
  std::string text;
  const auto add = [&](const auto& list) {
    for (const auto& part : list) {
      if (!part.refused.empty()) {
        text += "  " + wrapped(fmt::format("{}: {}", part.model, part.refused), optimum_width - 2, 4) + "\n";
      }
    }
  };
  add(file.motors);
  add(file.drive_train.gearboxes);
  add(file.drive_train.batteries);
  if (!text.empty()) fmt::format_to(out, "\nParts left out\n{}", text);
}

}  // namespace

std::string text_drive_trains(const OptimiseFile& file, const DriveTrainScreen& screen,
                              std::span<const MotorTrial> trials) {
  const OptimiseStudy& study = file.study;
  std::string text;
  auto out = std::back_inserter(text);
  text_screen(out, file, screen);
  text_left_out(out, file);
  const MotorTrial* const best = best_trial(file, trials);
  if (!trials.empty()) {
    fmt::format_to(out, "\n{:<50}{}\n", "Searched, the most promising of the screening",
                   metric_info(study.objective).key);
  }
  const double sign = study.maximise ? -1.0 : 1.0;
  std::vector<const MotorTrial*> order;
  for (const MotorTrial& t : trials) order.push_back(&t);
  const auto found = [](const MotorTrial* t) { return t->result.outcome == OptimiseResult::Outcome::found; };
  std::stable_sort(order.begin(), order.end(), [&](const MotorTrial* a, const MotorTrial* b) {
    if (found(a) != found(b)) return found(a);
    return found(a) &&
           sign * a->result.point.metrics[study.objective] < sign * b->result.point.metrics[study.objective];
  });
  for (const MotorTrial* t : order) {
    std::string what;
    if (found(t)) {
      what = with_unit(t->result.point.metrics[study.objective], metric_info(study.objective).unit);
      for (std::size_t k = 0; k < study.parameters.size(); ++k) {
        const DesignParameter& p = study.parameters[k].parameter;
        what += fmt::format("; {} {}", p.key, parameter_text(t->result.parameters[k], p.unit));
      }
    } else {
      what = describe(nothing_found(trial_study(file, *t), t->result));
    }
    const std::string name = name_of(file, *t);
    if (name.size() > 49) fmt::format_to(out, "{}\n", name);
    // The name's columns are a stand-in while lines are broken.
    fmt::format_to(out, "{:<50}{}\n", name.size() > 49 ? "" : name,
                   wrapped(std::string(50, '_') + what, optimum_width, 50).substr(50));
  }
  if (!best) return text + "\nNo combination meets the constraints.\n";
  OptimiseFile of_best = file;
  of_best.study = trial_study(file, *best);
  fmt::format_to(out, "\nBest: {}\n", name_of(file, *best));
  if (best->gearbox) {
    for (const std::string& assumed : best->gearbox->assumed) fmt::format_to(out, "  its gearbox: {}\n", assumed);
  }
  if (best->motor) {
    for (const std::string& derived : best->motor->derived) fmt::format_to(out, "  its motor: {}\n", derived);
  }
  return text + "\n" + text_optimum(of_best, best->result);
}

}  // namespace wingbeat
