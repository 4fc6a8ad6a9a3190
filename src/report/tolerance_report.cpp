#include "wingbeat/report/tolerance_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/choice_report.hpp"
#include "report/described.hpp"
#include "report/result_schemas.hpp"
#include "report/result_trees.hpp"
#include "report/uncertain_report.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

std::string share_text(double x, double low, double high) {
  return fmt::format("{:5.3f} ({:5.3f} .. {:5.3f})", x, low, high);
}

/// "12 angle_of_attack, 3 stroke"
std::string limits_beyond(const ToleranceResult& result) {
  std::string text;
  for (std::size_t k = 0; k < result.beyond.size(); ++k) {
    if (result.beyond[k] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", result.beyond[k], domain_limit_table()[k].key);
  }
  return text;
}

}  // namespace

const ToleranceOutput* main_output(const ToleranceResult& result) {
  for (const char* name : {"lift_to_weight", "lift_mean_n"}) {
    const ToleranceOutput* output = result.find(name);
    if (output && output->deviation > 0.0) return output;
  }
  for (const ToleranceOutput& output : result.outputs) {
    if (output.metric && output.deviation > 0.0) return &output;
  }
  return nullptr;
}

std::string text_tolerance(const ToleranceStudy& study, const ToleranceResult& result) {
  std::string text;
  auto out = std::back_inserter(text);
  if (!study.title.empty()) fmt::format_to(out, "{}\n", wrapped(study.title, 100, 0));
  const char* method = study.method == ToleranceMethod::sobol ? "scrambled Sobol" : "Monte Carlo";
  fmt::format_to(out, "{} {} samples", base_count(study), method);
  if (study.indices) fmt::format_to(out, ", {} vehicles including those for the indices", result.vehicles);
  if (study.hold) text += "; " + describe(*study.hold);
  text += "\n\n" + text_uncertain(study);
  for (const ModelChoice& choice : study.choices) {
    constexpr int column = 36;
    std::string alternatives = wrapped("choice, " + alternatives_text(choice), 100 - column, 8);
    for (std::size_t at_end = 0; (at_end = alternatives.find('\n', at_end)) != std::string::npos; ++at_end) {
      alternatives.insert(at_end + 1, column, ' ');
    }
    fmt::format_to(out, "  {:<34}{}\n", choice.name, alternatives);
  }

  text += probability_head;
  const auto line = [&](const char* name, const Probability& p, const std::string& note) {
    text += probability_line(name, p, note);
  };
  for (int s = 0; s < sweep_status_count; ++s) {
    const Probability& p = result.status[std::size_t(s)];
    if (p.count > 0 || s <= int(SweepStatus::stalled)) line(name_of(SweepStatus(s)), p, "");
  }
  line("outside the domain", result.outside, result.outside.count == 0 ? "" : limits_beyond(result));
  if (result.hover) {
    line("hovers", *result.hover,
         std::isfinite(result.linear_hover) ? fmt::format("linear prediction {}", probability_text(result.linear_hover))
                                            : "");
  }
  if (result.outside.count > 0) {
    const char* what = study.allow_extrapolation ? "Samples outside the model's domain count: extrapolation is allowed."
                                                 : "Samples outside the model's domain neither hover nor count below.";
    fmt::format_to(out, "{}\n", wrapped(what, 100, 2));
  }
  if (result.centre.domain.any()) {
    const std::string reason =
        fmt::format("{}t the parameters' means the vehicle is outside the model's domain: {}",
                    study.allow_extrapolation ? "A" : "No linear prediction: a", name_of(result.centre.domain));
    fmt::format_to(out, "{}\n", wrapped(reason, 100, 2));
  }
  if (result.centre.status != SweepStatus::flapping) {
    const std::string reason = fmt::format("No linear prediction: at the parameters' means the vehicle is {}: {}",
                                           name_of(result.centre.status), describe(result.centre));
    fmt::format_to(out, "{}\n", wrapped(reason, 100, 2));
  }

  if (!study.choices.empty() && result.centre.status == SweepStatus::flapping) {
    const std::string reason = fmt::format(
        "The linear prediction is that of the most likely alternatives, {}. It has no "
        "share for a choice.",
        likeliest_text(study));
    fmt::format_to(out, "{}\n", wrapped(reason, 100, 2));
  }

  fmt::format_to(out, "\n{:<34}{:>11}{:>11}{:>11}{:>11} {:>11}{:>11}\n", "Metric (those that flap)", "mean",
                 "deviation", "2.5 %", "97.5 %", "lin. mean", "lin. dev.");
  const auto cell = [](double x) { return std::isfinite(x) ? fmt::format("{:.4g}", x) : std::string("-"); };
  for (const ToleranceOutput& o : result.outputs) {
    if (!o.metric || !(o.deviation > 0.0)) continue;
    fmt::format_to(out, "  {:<32}{:>11}{:>11}{:>11}{:>11} {:>11}{:>11}\n", o.name, cell(o.mean), cell(o.deviation),
                   cell(o.p025), cell(o.p975), cell(o.linear_mean), cell(o.linear_deviation));
  }

  const auto inputs = factors(study);
  const auto sources = [&](const ToleranceOutput& o) {
    const bool sobol = o.indices && o.indices->rows > 1;
    if (!sobol && o.linear_share.empty()) return;
    fmt::format_to(out, "\nWhere the variance of {} comes from\n  {:<34}", o.name, "");
    if (sobol) fmt::format_to(out, "{:<26}{:<26}", "first order (95 %)", "total (95 %)");
    fmt::format_to(out, "linear\n");
    std::vector<std::size_t> order(inputs.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto weight = [&](std::size_t i) {
      if (sobol) return o.indices->inputs[i].total;
      return inputs[i].choice ? -1.0 : o.linear_share[i];
    };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return weight(a) > weight(b); });
    double sum = 0.0;
    for (const std::size_t i : order) {
      fmt::format_to(out, "  {:<34}", inputs[i].name);
      if (sobol) {
        const SobolIndex& s = o.indices->inputs[i];
        sum += s.first;
        fmt::format_to(out, "{:<26}{:<26}", share_text(s.first, s.first_lower, s.first_upper),
                       share_text(s.total, s.total_lower, s.total_upper));
      }
      const bool linear = !o.linear_share.empty() && !inputs[i].choice;
      fmt::format_to(out, "{}\n", linear ? fmt::format("{:.3f}", o.linear_share[i]) : "-");
    }
    if (sobol) fmt::format_to(out, "  {:<34}{:5.3f}: the rest are interactions and noise\n", "sum of first order", sum);
    if (sobol && o.indices->rows < study.count) {
      fmt::format_to(
          out, "{}\n",
          wrapped(fmt::format("  from {} of {} rows: in the others a vehicle does not flap{}", o.indices->rows,
                              study.count, study.choices.empty() ? "" : " or has no such metric"),
                  100, 2));
    }
  };
  if (const ToleranceOutput* o = main_output(result)) sources(*o);
  for (const char* name : {"hovers", "flaps", "power_electrical_w"}) {
    if (const ToleranceOutput* o = result.find(name)) sources(*o);
  }
  for (const ToleranceFactor& factor : inputs) {
    if (factor.parameters.size() < 2) continue;
    std::string names;
    for (const std::size_t k : factor.parameters) {
      names += (names.empty() ? "" : ", ") + study.parameters[k].parameter.key;
    }
    const std::string sentence = fmt::format(
        "{} stands for {}: they are correlated, so they vary together and share one index.", factor.name, names);
    fmt::format_to(out, "\n{}\n", wrapped(sentence, 100, 0));
  }
  return text + text_choices(study, result);
}

namespace described {

namespace {

/// What a tolerance study's --json is made from.
struct ToleranceFound {
  const ToleranceStudy& study;
  const ToleranceResult& result;
};
struct OutputFound {
  const ToleranceOutput& output;
  const std::vector<ToleranceFactor>& factors;
};
/// What a factor contributes to an output's variance; each where it was computed.
struct Contribution {
  std::string name;
  const double* linear_share;
  const SobolIndex* index;
};

std::vector<Contribution> contributions(const OutputFound& found) {
  const ToleranceOutput& o = found.output;
  std::vector<Contribution> all;
  if (o.linear_share.empty() && !o.indices) return all;
  for (std::size_t i = 0; i < found.factors.size(); ++i) {
    all.push_back({found.factors[i].name,
                   o.linear_share.empty() || found.factors[i].choice ? nullptr : &o.linear_share[i],
                   o.indices ? &o.indices->inputs[i] : nullptr});
  }
  return all;
}

Description<Contribution> contribution_description() {
  using R = Contribution;
  const auto indexed = [](auto value) {
    using V = decltype(value(SobolIndex{}));
    return [value](const R& r) { return r.index ? std::optional<V>(value(*r.index)) : std::nullopt; };
  };
  using Interval = std::array<double, 2>;
  return Description<R>()
      .always("name", "", "the parameter, the correlated ones together, or the choice", &R::name)
      .sometimes("linear_share", "1", "share of the variance, from the gradient", &R::linear_share)
      .sometimes("first", "1", "Sobol index of first order", indexed([](const SobolIndex& s) { return s.first; }))
      .sometimes("first_95", "1", "95 % interval",
                 indexed([](const SobolIndex& s) { return Interval{s.first_lower, s.first_upper}; }))
      .sometimes("total", "1", "total Sobol index", indexed([](const SobolIndex& s) { return s.total; }))
      .sometimes("total_95", "1", "95 % interval",
                 indexed([](const SobolIndex& s) { return Interval{s.total_lower, s.total_upper}; }));
}

const Description<OutputFound>& output_description() {
  using R = OutputFound;
  const auto number = [](double ToleranceOutput::* member) {
    return [member](const R& r) { return r.output.*member; };
  };
  using O = ToleranceOutput;
  static const Description<R> description =
      Description<R>()
          .all_of(moments_description(), [](const R& r) -> SampleMoments { return r.output; })
          .always("linear_mean", "", "predicted from the gradient at the parameters' means", number(&O::linear_mean))
          .always("linear_deviation", "", "the same of the standard deviation", number(&O::linear_deviation))
          .sometimes(
              "factors", "", "where the variance comes from",
              [](const R& r) {
                const auto all = contributions(r);
                return all.empty() ? std::nullopt : std::optional(contribution_description().list(all));
              },
              schema::listed(contribution_description().schema()))
          .sometimes("rows", "", "rows of the sample behind the Sobol indices", [](const R& r) {
            return r.output.indices ? std::optional(r.output.indices->rows) : std::nullopt;
          });
  return description;
}

Description<ToleranceResult> probabilities_description() {
  using R = ToleranceResult;
  Description<R> d;
  for (int s = 0; s < sweep_status_count; ++s) {
    d.part(name_of(SweepStatus(s)), "", probability_description(),
           [s](const R& r) -> const Probability& { return r.status[std::size_t(s)]; });
  }
  return d.part("outside_domain", "flapping, but outside the model's domain", probability_description(), &R::outside)
      .part("hover", "lift carries the weight; null without a mass", probability_description(), &R::hover)
      .always("hover_linear", "1", "the share predicted from the gradient", &R::linear_hover);
}

Description<ToleranceResult> limits_description() {
  Description<ToleranceResult> d;
  for (std::size_t k = 0; k < domain_limit_table().size(); ++k) {
    d.always(domain_limit_table()[k].key, "", domain_limit_table()[k].meaning,
             [k](const ToleranceResult& r) { return r.beyond[k]; });
  }
  return d;
}

const Description<ToleranceFound>& tolerance_description() {
  using R = ToleranceFound;
  const auto result = [](const R& r) -> const ToleranceResult& { return r.result; };
  static const Description<R> description =
      Description<R>()
          .always("title", "", "", [](const R& r) { return r.study.title; })
          .always("method", "", "", [](const R& r) { return r.study.method; })
          .always("samples", "", "vehicles of the plain sample", [](const R& r) { return base_count(r.study); })
          .always("vehicles", "", "solved, those for Sobol indices included",
                  [](const R& r) { return r.result.vehicles; })
          .parts("parameters", "the uncertain ones", uncertain_description(),
                 [](const R& r) { return uncertain_keys(r.study); })
          .sometimes(
              "choices", "", "of model, where the study has some",
              [](const R& r) {
                std::vector<ChoiceFound> all;
                for (std::size_t k = 0; k < r.study.choices.size(); ++k) all.push_back({r.study, r.result, k});
                return all.empty() ? std::nullopt : std::optional(choice_description().list(all));
              },
              schema::listed(choice_description().schema()))
          .part("probability", "", probabilities_description(), result)
          .part("outside_domain", "samples outside each limit of the model's domain", limits_description(), result)
          .always("allow_extrapolation", "", "samples outside the domain count",
                  [](const R& r) { return r.study.allow_extrapolation; })
          .always(
              "outputs", "", "by metric; flaps and hovers are 0 or 1",
              [](const R& r) {
                const auto inputs = factors(r.study);
                Json outputs = Json::object();
                for (const ToleranceOutput& o : r.result.outputs) {
                  outputs[o.name] = output_description().json({o, inputs});
                }
                return outputs;
              },
              schema::by_name(output_description().schema()));
  return description;
}

}  // namespace

Json tolerance_schema() { return tolerance_description().schema(); }

}  // namespace described

detail::Json detail::tolerance_tree(const ToleranceStudy& study, const ToleranceResult& result) {
  return described::tolerance_description().json({study, result});
}

std::string json_tolerance(const ToleranceStudy& study, const ToleranceResult& result) {
  return detail::dumped(detail::tolerance_tree(study, result));
}

}  // namespace wingbeat
