#include "report/choice_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "report/report_tools.hpp"
#include "report/uncertain_report.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {
namespace {

constexpr std::size_t report_width = 100, first_columns = 2 + 32 + 12 + 12, name_column = 2 + 32;

std::string percent_of(double share) { return fmt::format("{:.4g} %", 100.0 * share); }

std::string number(double x, int digits) { return std::isfinite(x) ? fmt::format("{:.{}g}", x, digits) : "-"; }

std::string moments_text(const ConditionalMoments& m) {
  if (m.count == 0) return "-";
  return fmt::format("{} +- {}", number(m.mean, 4), number(m.deviation, 2));
}

/// Metrics that vary, one in a row; the columns of alternatives go on in further blocks where they are many.
void add_moments(std::string& text, const ToleranceStudy& study, const ToleranceResult& result, std::size_t k) {
  const auto out = std::back_inserter(text);
  const ModelChoice& choice = study.choices[k];
  std::size_t width = 21;
  for (const ModelAlternative& a : choice.alternatives) width = std::max(width, a.name.size() + 2);
  for (std::size_t begin = 0, end = 0; begin < choice.alternatives.size(); begin = end) {
    const std::size_t used = begin == 0 ? first_columns : name_column;
    end = std::min(choice.alternatives.size(), begin + std::max(std::size_t(1), (report_width - used) / width));
    fmt::format_to(out, "\n  {:<32}", "mean +- deviation");
    if (begin == 0) fmt::format_to(out, "{:>12}{:>12}", "difference", "parameters");
    for (std::size_t a = begin; a < end; ++a) fmt::format_to(out, "{:>{}}", choice.alternatives[a].name, width);
    text += "\n";
    for (const ToleranceOutput& o : result.outputs) {
      if (!o.metric || !(o.deviation > 0.0)) continue;
      const ChoiceEffect& effect = o.choices[k];
      fmt::format_to(out, "  {:<32}", o.name);
      if (begin == 0) {
        fmt::format_to(out, "{:>12}{:>12}", number(effect.difference, 3), number(o.deviation_by_parameters, 3));
      }
      for (std::size_t a = begin; a < end; ++a) {
        fmt::format_to(out, "{:>{}}", moments_text(effect.alternatives[a]), width);
      }
      text += "\n";
    }
  }
}

}  // namespace

std::string alternatives_text(const ModelChoice& choice) {
  std::string text;
  for (std::size_t a = 0; a < choice.alternatives.size(); ++a) {
    text += fmt::format("{}{} {}", a == 0 ? "" : ", ", choice.alternatives[a].name, percent_of(choice.share(a)));
  }
  return text;
}

std::string likeliest_text(const ToleranceStudy& study) {
  std::string text;
  for (const ModelChoice& choice : study.choices) {
    text +=
        fmt::format("{}{} ({})", text.empty() ? "" : ", ", choice.alternatives[choice.likeliest()].name, choice.name);
  }
  return text;
}

std::string text_choices(const ToleranceStudy& study, const ToleranceResult& result) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (std::size_t k = 0; k < study.choices.size(); ++k) {
    const ModelChoice& choice = study.choices[k];
    fmt::format_to(out, "\nEffect of the choice of {}\n  {:<46}{:>12}{:>12}{}\n", choice.name, "", "samples",
                   "flapping", result.hover ? "    hovers (95 %)" : "");
    for (std::size_t a = 0; a < choice.alternatives.size(); ++a) {
      const AlternativeSamples& samples = result.choices[k][a];
      fmt::format_to(out, "  {:<46}{:>12}{:>12}", choice.alternatives[a].name, samples.count,
                     samples.count > 0 ? fmt::format("{:.2f} %", 100.0 * samples.flapping.share) : "-");
      if (samples.hover) {
        fmt::format_to(out, "    {:.2f} % ({:.2f} .. {:.2f})", 100.0 * samples.hover->share,
                       100.0 * samples.hover->lower, 100.0 * samples.hover->upper);
      }
      text += "\n";
    }
    add_moments(text, study, result, k);
  }
  if (!study.choices.empty()) {
    text += "\n" +
            wrapped(
                "Difference: between the largest and the smallest mean of an alternative. Parameters: the "
                "standard deviation by parameters only, pooled over the combinations of choices.",
                int(report_width), 0) +
            "\n";
  }
  return text;
}

namespace described {
namespace {

struct AlternativeFound {
  const ChoiceFound& found;
  std::size_t place;
  const ModelAlternative& alternative() const { return found.choice().alternatives[place]; }
  const AlternativeSamples& samples() const { return found.result.choices[found.place][place]; }
};
using Effect = std::pair<const ToleranceOutput*, std::size_t>;  ///< of a choice

Description<ConditionalMoments> conditional_description() {
  using R = ConditionalMoments;
  return Description<R>()
      .always("count", "", "samples with a value", &R::count)
      .always("mean", "", "the metric's unit", &R::mean)
      .always("deviation", "", "standard deviation", &R::deviation);
}

Description<Effect> effect_description() {
  using R = Effect;
  return Description<R>()
      .always("difference", "", "between the largest and the smallest mean of an alternative",
              [](const R& r) { return r.first->choices[r.second].difference; })
      .always("deviation_by_parameters", "",
              "standard deviation by parameters only, pooled over the combinations of choices",
              [](const R& r) { return r.first->deviation_by_parameters; });
}

const Description<AlternativeFound>& alternative_description() {
  using R = AlternativeFound;
  static const Description<R> description =
      Description<R>()
          .always("name", "", "", [](const R& r) { return r.alternative().name; })
          .always(
              "weight", "1", "", [](const R& r) { return r.alternative().weight; }, schema::any_number)
          .always(
              "share", "1", "weight over the sum of weights",
              [](const R& r) { return r.found.choice().share(r.place); }, schema::any_number)
          .always("samples", "", "in which it is chosen", [](const R& r) { return r.samples().count; })
          .part("flapping", "", probability_description(),
                [](const R& r) -> const Probability& { return r.samples().flapping; })
          .part("hover", "lift carries the weight; null without a mass", probability_description(),
                [](const R& r) { return r.samples().hover; })
          .always(
              "outputs", "", "by metric, of these samples",
              [](const R& r) {
                Json all = Json::object();
                for (const ToleranceOutput& o : r.found.result.outputs) {
                  all[o.name] = conditional_description().json(o.choices[r.found.place].alternatives[r.place]);
                }
                return all;
              },
              schema::by_name(conditional_description().schema()));
  return description;
}

}  // namespace

const Description<ChoiceFound>& choice_description() {
  using R = ChoiceFound;
  static const Description<R> description =
      Description<R>()
          .always("name", "", "", [](const R& r) { return r.choice().name; })
          .always("keys", "", "of the vehicle file, that alternatives set", [](const R& r) { return r.choice().keys; })
          .always("linear_alternative", "", "of the vehicle of the linear prediction",
                  [](const R& r) { return r.choice().alternatives[r.choice().likeliest()].name; })
          .parts("alternatives", "", alternative_description(),
                 [](const R& r) {
                   std::vector<AlternativeFound> all;
                   for (std::size_t a = 0; a < r.choice().alternatives.size(); ++a) all.push_back({r, a});
                   return all;
                 })
          .always(
              "outputs", "", "by metric: effect of the choice",
              [](const R& r) {
                Json all = Json::object();
                for (const ToleranceOutput& o : r.result.outputs) {
                  all[o.name] = effect_description().json({&o, r.place});
                }
                return all;
              },
              schema::by_name(effect_description().schema()));
  return description;
}

}  // namespace described

}  // namespace wingbeat
