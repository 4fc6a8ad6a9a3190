#include "wingbeat/report/tolerance_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/described.hpp"
#include "report/figure.hpp"
#include "report/layout.hpp"
#include "report/result_schemas.hpp"
#include "report/result_trees.hpp"
#include "report/sweep_scales.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

std::string percent(double x) {
  // Never rounded to certainty.
  if (x > 0.0 && x < 5e-5) return "< 0.01 %";
  if (x < 1.0 && x > 0.99995) return "> 99.99 %";
  return fmt::format("{:.2f} %", 100.0 * x);
}

std::string share_text(double x, double low, double high) {
  return fmt::format("{:5.3f} ({:5.3f} .. {:5.3f})", x, low, high);
}

std::string spread_text(const Distribution& d, bool correlated, const std::string& unit) {
  const std::string u = unit == "1" ? "" : " " + unit;
  std::string text;
  switch (d.kind) {
    case DistributionKind::uniform: return fmt::format("uniform, {:.4g} to {:.4g}{}", d.lower, d.upper, u);
    case DistributionKind::normal: text = fmt::format("normal, {:.4g} +- {:.2g}{}", d.centre, d.spread, u); break;
    case DistributionKind::lognormal:
      text = fmt::format("lognormal, median {:.4g}{}, factor {:.3g}", d.centre, u, std::exp(d.spread));
      break;
  }
  if (std::isfinite(d.lower)) text += fmt::format(", not below {:.4g}", d.lower);
  if (std::isfinite(d.upper)) text += fmt::format(", not above {:.4g}", d.upper);
  return text + (correlated ? ", correlated" : "");
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
  if (study.indices) fmt::format_to(out, ", {} vehicles with those for the indices", result.vehicles);
  if (study.hold) text += "; " + describe(*study.hold);
  fmt::format_to(out, "\n\nUncertain parameters\n");
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    const UncertainParameter& p = study.parameters[k];
    fmt::format_to(out, "  {:<34}{}\n", p.parameter.key,
                   spread_text(p.distribution, is_correlated(study, k), p.parameter.unit));
  }
  for (const Correlation& c : study.correlations) {
    fmt::format_to(out, "  correlation {:.3g} of {} with {}\n", c.value, study.parameters[c.first].parameter.key,
                   study.parameters[c.second].parameter.key);
  }

  fmt::format_to(out, "\nProbability                             95 % interval\n");
  const auto line = [&](const std::string& name, const Probability& p, const std::string& note) {
    fmt::format_to(out, "  {:<24}{:>10}    {} .. {}{}\n", name, percent(p.share), percent(p.lower), percent(p.upper),
                   note.empty() ? "" : "   " + note);
  };
  for (int s = 0; s < sweep_status_count; ++s) {
    const Probability& p = result.status[std::size_t(s)];
    if (p.count > 0 || s <= int(SweepStatus::stalled)) line(name_of(SweepStatus(s)), p, "");
  }
  line("outside the domain", result.outside, result.outside.count == 0 ? "" : limits_beyond(result));
  if (result.hover) {
    line("hovers", *result.hover,
         std::isfinite(result.linear_hover) ? fmt::format("linear prediction {}", percent(result.linear_hover)) : "");
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
    const auto weight = [&](std::size_t i) { return sobol ? o.indices->inputs[i].total : o.linear_share[i]; };
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
      fmt::format_to(out, "{}\n", o.linear_share.empty() ? "-" : fmt::format("{:.3f}", o.linear_share[i]));
    }
    if (sobol) fmt::format_to(out, "  {:<34}{:5.3f}: the rest are interactions and noise\n", "sum of first order", sum);
    if (sobol && o.indices->rows < study.count) {
      fmt::format_to(out, "{}\n",
                     wrapped(fmt::format("  from {} of {} rows: in the others a vehicle does not flap", o.indices->rows,
                                         study.count),
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
  return text;
}

namespace described {
namespace {

/// What a tolerance study's --json is made from.
struct ToleranceFound {
  const ToleranceStudy& study;
  const ToleranceResult& result;
};
struct UncertainKey {
  const ToleranceStudy& study;
  std::size_t place;
  const UncertainParameter& parameter() const { return study.parameters[place]; }
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
    all.push_back({found.factors[i].name, o.linear_share.empty() ? nullptr : &o.linear_share[i],
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
      .always("name", "", "the parameter, or the correlated ones together", &R::name)
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
          .always("mean", "", "of the samples that count; the metric's unit", number(&O::mean))
          .always("deviation", "", "standard deviation", number(&O::deviation))
          .always("least", "", "", number(&O::min))
          .always("percentile_2_5", "", "", number(&O::p025))
          .always("median", "", "", number(&O::median))
          .always("percentile_97_5", "", "", number(&O::p975))
          .always("most", "", "", number(&O::max))
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
  const auto parameters = [](const R& r) {
    std::vector<UncertainKey> all;
    for (std::size_t k = 0; k < r.study.parameters.size(); ++k) all.push_back({r.study, k});
    return all;
  };
  using P = UncertainKey;
  static const Description<P> parameter =
      Description<P>()
          .always("key", "", "of the vehicle file", [](const P& p) { return p.parameter().parameter.key; })
          .always("unit", "", "", [](const P& p) { return p.parameter().parameter.unit; })
          .always(
              "mean", "", "", [](const P& p) { return p.parameter().distribution.mean(); }, schema::any_number)
          .always(
              "deviation", "", "standard deviation",
              [](const P& p) { return std::sqrt(p.parameter().distribution.variance()); }, schema::any_number)
          .always("correlated", "", "varies together with others",
                  [](const P& p) { return is_correlated(p.study, p.place); });
  static const Description<R> description =
      Description<R>()
          .always("title", "", "", [](const R& r) { return r.study.title; })
          .always("method", "", "", [](const R& r) { return r.study.method; })
          .always("samples", "", "vehicles of the plain sample", [](const R& r) { return base_count(r.study); })
          .always("vehicles", "", "solved, those for Sobol indices included",
                  [](const R& r) { return r.result.vehicles; })
          .parts("parameters", "the uncertain ones", parameter, parameters)
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

void plot_tolerance(const ToleranceStudy& study, const SweepColumns& columns, const ToleranceOutput& output,
                    PlotFormat format, const std::filesystem::path& file) {
  std::vector<double> values;
  const auto all = samples_of(study, columns, *output.metric);
  std::size_t outside = 0;
  for (std::size_t n = 0; n < all.size(); ++n) {
    if (!std::isfinite(all[n])) continue;
    if (columns.counts(n, study.allow_extrapolation)) values.push_back(all[n]);
    else ++outside;
  }
  std::sort(values.begin(), values.end());
  const Display display = display_of(*output.metric, std::max(std::abs(values.front()), std::abs(values.back())));
  for (double& x : values) x *= display.factor;
  const double linear_mean = display.factor * output.linear_mean,
               linear_deviation = display.factor * output.linear_deviation;
  // Freedman and Diaconis, 1981; the few samples beyond the drawn range are in the tails.
  const auto quantile = [&](double p) { return values[std::size_t(p * double(values.size() - 1))]; };
  const double low = quantile(0.001), high = quantile(0.999);
  double width = 2.0 * (quantile(0.75) - quantile(0.25)) / std::cbrt(double(values.size()));
  if (!(width > (high - low) / 200.0)) width = (high - low) / 50.0;
  const int bins = std::max(1, int(std::ceil((high - low) / width)));
  std::vector<double> counts(std::size_t(bins), 0.0);
  for (const double x : values) {
    if (x >= low && x <= high) ++counts[std::min(std::size_t(bins - 1), std::size_t((x - low) / width))];
  }

  const auto inputs = factors(study);
  std::vector<std::size_t> order;
  const bool sobol = output.indices && output.indices->rows > 1;
  const auto weight = [&](std::size_t i) {
    return sobol ? output.indices->inputs[i].total : output.linear_share.empty() ? 0.0 : output.linear_share[i];
  };
  for (std::size_t i = 0; i < inputs.size(); ++i) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return weight(a) > weight(b); });
  const bool linear = linear_deviation > 0.0;
  const bool sources = sobol || !output.linear_share.empty();

  const double rows_height = sources ? 0.24 * double(inputs.size()) : 0.0;
  const double inches = 2.55 + (sources ? 0.95 + rows_height : 0.0);
  Figure figure(format, inches);
  const auto y = [&](double from_top) { return 1.0 - from_top / inches; };
  figure.add("$bins << END\n");
  double highest = 0.0;
  for (int b = 0; b < bins; ++b) {
    const double density = counts[std::size_t(b)] / (double(values.size()) * width);
    highest = std::max(highest, density);
    figure.add("{} {}\n", low + (b + 0.5) * width, density);
  }
  figure.add("END\nset multiplot\nset lmargin at screen 0.07\nset rmargin at screen 0.97\n");
  figure.add("set tmargin at screen {}\nset bmargin at screen {}\n", y(0.62), y(2.1));
  const std::string title = study.title.empty() ? "Tolerance" : study.title;
  page_title(figure, title, 0.12);
  std::string drawn = fmt::format("{} vehicles that flap", values.size());
  if (outside > 0) drawn += fmt::format(" ({} outside the domain left out)", outside);
  figure.key_entry(0.07, y(0.32), "lw 5 lc rgb '#cfcfcf'", drawn);
  if (linear) figure.key_entry(0.07, y(0.48), style::second_curve, "linear prediction from the gradient");
  if (output.metric == Metric::lift_to_weight) figure.key_entry(0.6, y(0.32), style::reference_line, "hover");
  const MetricInfo& info = metric_table()[std::size_t(*output.metric)];
  figure.text(info.long_name + display.in_brackets(), 7.5, fmt::format("screen 0.52,{} center", y(2.42)));
  double left = low, right = high;
  if (linear) {
    left = std::min(left, linear_mean - 3.0 * linear_deviation);
    right = std::max(right, linear_mean + 3.0 * linear_deviation);
    highest = std::max(highest, 0.4 / linear_deviation);
  }
  const bool one_inside = output.metric == Metric::lift_to_weight && left < 1.0 && right > 1.0;
  figure.add("unset ytics\nset border 1\nset xrange [{}:{}]\nset yrange [0:{}]\n", left, right, 1.08 * highest);
  figure.add("set style fill solid 1.0 noborder\n");
  if (one_inside) figure.add("set arrow 900 from 1,graph 0 to 1,graph 1 nohead front {}\n", style::reference_line);
  figure.add("set samples 400\nplot $bins using 1:2:({}) with boxes lc rgb '#cfcfcf'", width);
  if (linear) {
    figure.add(", exp(-0.5*((x-{0})/{1})**2)/({1}*sqrt(2*pi)) with lines {2}", linear_mean, linear_deviation,
               style::second_curve);
  }
  figure.add("\n");
  if (sources) {
    figure.next_panel();
    const double top = 2.98, bottom = top + rows_height;
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\nset lmargin at screen 0.46\n", y(top), y(bottom));
    figure.text("share of the variance", 7.5, fmt::format("screen 0.07,{} left", y(top - 0.14)));
    figure.text("first order", style::text_size, fmt::format("screen 0.49,{} left", y(top - 0.14)));
    figure.text("total", style::text_size, fmt::format("screen 0.67,{} left", y(top - 0.14)));
    figure.text("linear", style::text_size, fmt::format("screen 0.82,{} left", y(top - 0.14)));
    figure.add(
        "set label 901 '' at screen 0.475,{0} point pt 7 ps 0.45 lc rgb '#000000'\n"
        "set label 902 '' at screen 0.655,{0} point pt 5 ps 0.45 lc rgb '#707070'\n"
        "set label 903 '' at screen 0.805,{0} point pt 8 ps 0.6 lc rgb '#000000'\n",
        y(top - 0.14));
    figure.add("$sources << END\n");
    double max_share = 0.1;
    for (std::size_t r = 0; r < order.size(); ++r) {
      const std::size_t i = order[r];
      const SobolIndex none{absent, absent, absent, absent, absent, absent};
      const SobolIndex s = sobol ? output.indices->inputs[i] : none;
      figure.add("{} {} {} {} {} {} {} {}\n", -double(r), s.first, s.first_lower, s.first_upper, s.total, s.total_lower,
                 s.total_upper, output.linear_share.empty() ? absent : output.linear_share[i]);
      for (const double x : {s.first_upper, s.total_upper, weight(i)}) {
        if (std::isfinite(x)) max_share = std::max(max_share, x);
      }
    }
    figure.add("END\n");
    for (std::size_t r = 0; r < order.size(); ++r) {
      const double row = top + rows_height * (double(r) + 0.5) / double(order.size());
      fitted_text(figure, words(inputs[order[r]].name), style::text_size, 0.42 * format.width, 0.44 * format.width, row,
                  "right");
    }
    figure.add("set xrange [{}:{}]\nset yrange [{}:0.5]\nset border 3\nset datafile missing 'nan'\n", -0.03 * max_share,
               1.04 * max_share, 0.5 - double(order.size()));
    figure.add(
        "plot $sources using 2:($1+0.22):3:4 with xerrorbars pt 7 ps 0.45 lc rgb '#000000', "
        "$sources using 5:1:6:7 with xerrorbars pt 5 ps 0.45 lc rgb '#707070', "
        "$sources using 8:($1-0.22) with points pt 8 ps 0.6 lc rgb '#000000'\n");
  }

  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
}

}  // namespace wingbeat
