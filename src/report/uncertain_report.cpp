#include "report/uncertain_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "report/report_tools.hpp"

namespace wingbeat {
namespace {

std::string spread_text(const Distribution& d, bool correlated, const std::string& unit) {
  const detail::ShownUnit shown = detail::shown_unit(unit);
  const std::string u = shown.suffix();
  const double f = shown.factor;
  std::string text;
  switch (d.kind) {
    case DistributionKind::uniform: return fmt::format("uniform, {:.4g} to {:.4g}{}", f * d.lower, f * d.upper, u);
    case DistributionKind::normal:
      text = fmt::format("normal, {:.4g} +- {:.2g}{}", f * d.centre, f * d.spread, u);
      break;
    case DistributionKind::lognormal:
      text = fmt::format("lognormal, median {:.4g}{}, factor {:.3g}", f * d.centre, u, std::exp(d.spread));
      break;
  }
  if (std::isfinite(d.lower)) text += fmt::format(", not below {:.4g}{}", f * d.lower, u);
  if (std::isfinite(d.upper)) text += fmt::format(", not above {:.4g}{}", f * d.upper, u);
  return text + (correlated ? ", correlated" : "");
}

}  // namespace

std::string probability_text(double x) {
  if (x > 0.0 && x < 5e-5) return "< 0.01 %";
  if (x < 1.0 && x > 0.99995) return "> 99.99 %";
  return fmt::format("{:.2f} %", 100.0 * x);
}

std::string text_uncertain(const ToleranceStudy& study) {
  std::string text = fmt::format("Uncertain parameters{}\n", study.choices.empty() ? "" : " and choices of model");
  auto out = std::back_inserter(text);
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    const UncertainParameter& p = study.parameters[k];
    fmt::format_to(out, "  {:<34}{}\n", p.parameter.key,
                   spread_text(p.distribution, is_correlated(study, k), p.parameter.unit));
  }
  for (const Correlation& c : study.correlations) {
    fmt::format_to(out, "  correlation {:.3g} of {} with {}\n", c.value, study.parameters[c.first].parameter.key,
                   study.parameters[c.second].parameter.key);
  }
  return text;
}

std::string probability_line(const char* name, const Probability& p, const std::string& note) {
  return fmt::format("  {:<24}{:>10}    {} .. {}{}\n", name, probability_text(p.share), probability_text(p.lower),
                     probability_text(p.upper), note.empty() ? "" : "   " + note);
}

namespace described {

const Description<Probability>& probability_description() {
  using R = Probability;
  static const Description<R> description =
      Description<R>()
          .always("count", "", "samples", &R::count)
          .always("share", "1", "of all samples", &R::share, schema::any_number)
          .always("lower_95", "1", "lower end of its 95 % interval", &R::lower, schema::any_number)
          .always("upper_95", "1", "upper end", &R::upper, schema::any_number);
  return description;
}

const Description<SampleMoments>& moments_description() {
  using R = SampleMoments;
  static const Description<R> description =
      Description<R>()
          .always("mean", "", "of the samples that count; the unit of the quantity", &R::mean)
          .always("deviation", "", "standard deviation", &R::deviation)
          .always("least", "", "", &R::min)
          .always("percentile_2_5", "", "", &R::p025)
          .always("median", "", "", &R::median)
          .always("percentile_97_5", "", "", &R::p975)
          .always("most", "", "", &R::max);
  return description;
}

std::vector<UncertainKey> uncertain_keys(const ToleranceStudy& study) {
  std::vector<UncertainKey> all;
  for (std::size_t k = 0; k < study.parameters.size(); ++k) all.push_back({study, k});
  return all;
}

const Description<UncertainKey>& uncertain_description() {
  using R = UncertainKey;
  static const Description<R> description =
      Description<R>()
          .always("key", "", "of the vehicle file", [](const R& r) { return r.parameter().parameter.key; })
          .always("unit", "", "", [](const R& r) { return r.parameter().parameter.unit; })
          .always(
              "mean", "", "", [](const R& r) { return r.parameter().distribution.mean(); }, schema::any_number)
          .always(
              "deviation", "", "standard deviation",
              [](const R& r) { return std::sqrt(r.parameter().distribution.variance()); }, schema::any_number)
          .always("correlated", "", "varies together with others",
                  [](const R& r) { return is_correlated(r.study, r.place); });
  return description;
}

}  // namespace described

}  // namespace wingbeat
