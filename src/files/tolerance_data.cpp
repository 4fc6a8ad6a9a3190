#include "wingbeat/files/tolerance_data.hpp"

#include <string>
#include <vector>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/netcdf_results.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
void write_tolerance(const ToleranceStudy& study, const ToleranceResult& result, const SweepColumns& columns,
                     const std::string& input, const std::string& version, const std::filesystem::path& file) {
  NetcdfFile data(file);
  write_provenance(data, {.title = study.title.empty() ? "tolerance study" : study.title,
                          .command = "tolerance",
                          .version = version,
                          .vehicle = write_design(study.design),
                          .study = input,
                          .condition = name_of(study.condition),
                          .tolerance = study.options.tolerance});
  const std::size_t base = std::size_t(base_count(study));
  const auto sample = data.define_dimension("sample", base);
  const Sweep sweep = tolerance_sweep(study);
  for (const SweptQuantity& q : sweep.axes.front().quantities) {
    const auto variable =
        data.define_variable(q.name, {sample}, q.unit, std::string(find_parameter<double>(q.key)->meaning));
    data.set_key(variable, q.key);
    data.write(variable, std::span(q.values).subspan(0, base));
  }
  const std::vector<std::uint32_t> combinations = drawn_combinations(study);
  for (std::size_t k = 0; k < study.choices.size(); ++k) {
    const ModelChoice& choice = study.choices[k];
    const auto variable = data.define_dense("choice_" + choice.name, {sample}, "1", "alternative of the choice",
                                            NetcdfFile::Storage::flag);
    std::vector<std::string> names;
    std::vector<std::int8_t> chosen;
    for (const ModelAlternative& a : choice.alternatives) names.push_back(a.name);
    data.set_flags(variable, names);
    for (std::size_t n = 0; n < base; ++n) {
      chosen.push_back(std::int8_t(alternative_in(study.choices, combinations[n], k)));
    }
    data.write_run(variable, 0, chosen);
  }
  data.write_run(define_status(data, {sample}), 0, std::span(columns.status).subspan(0, base));
  data.write_run(define_domain(data, {sample}), 0, std::span(columns.domain).subspan(0, base));
  for (int m = 0; m < metric_count; ++m) {
    if (!study.options.metrics[std::size_t(m)]) continue;
    data.write(define_metric(data, Metric(m), {sample}), samples_of(study, columns, Metric(m)));
  }

  const auto inputs = factors(study);
  const auto factor = data.define_dimension("factor", inputs.size());
  const auto output = data.define_dimension("output", result.outputs.size());
  std::vector<std::string> labels, units;
  for (const ToleranceFactor& f : inputs) labels.push_back(f.name);
  data.define_texts("factor", factor, labels, "what varies independently");
  labels.clear();
  for (const ToleranceOutput& o : result.outputs) {
    const int metric = metric_index(o.name);
    labels.push_back(o.name);
    units.push_back(metric == metric_count ? "1" : metric_info(Metric(metric)).unit);
  }
  data.define_texts("output", output, labels, "metric, or 0 and 1 for flaps and hovers");
  data.define_texts("output_unit", output, units, "unit of the output");
  const auto table = [&](const char* name, const char* meaning, const auto& value) {
    std::vector<double> values;
    for (const ToleranceOutput& o : result.outputs) {
      for (std::size_t i = 0; i < inputs.size(); ++i) values.push_back(value(o, i));
    }
    data.write(data.define_variable(name, {output, factor}, "1", meaning), values);
  };
  const auto index = [](double SobolIndex::* member) {
    return
        [member](const ToleranceOutput& o, std::size_t i) { return o.indices ? o.indices->inputs[i].*member : absent; };
  };
  table("sobol_first", "Sobol index of first order", index(&SobolIndex::first));
  table("sobol_first_lower", "its 95 % interval, lower end", index(&SobolIndex::first_lower));
  table("sobol_first_upper", "its 95 % interval, upper end", index(&SobolIndex::first_upper));
  table("sobol_total", "total Sobol index", index(&SobolIndex::total));
  table("sobol_total_lower", "its 95 % interval, lower end", index(&SobolIndex::total_lower));
  table("sobol_total_upper", "its 95 % interval, upper end", index(&SobolIndex::total_upper));
  table("linear_share", "share of the variance by the linear prediction",
        [](const ToleranceOutput& o, std::size_t i) { return o.linear_share.empty() ? absent : o.linear_share[i]; });
  const auto row = [&](const char* name, const char* meaning, double ToleranceOutput::* member) {
    std::vector<double> values;
    for (const ToleranceOutput& o : result.outputs) values.push_back(o.*member);
    data.write(data.define_variable(name, {output}, "1", meaning), values);
  };
  row("linear_mean", "value at the parameters' means, unit of the output", &ToleranceOutput::linear_mean);
  row("linear_deviation", "standard deviation by the linear prediction, unit of the output",
      &ToleranceOutput::linear_deviation);
  if (!study.choices.empty()) {
    row("parameter_deviation", "standard deviation by the parameters alone, unit of the output",
        &ToleranceOutput::deviation_by_parameters);
  }
  for (std::size_t k = 0; k < study.choices.size(); ++k) {
    const ModelChoice& choice = study.choices[k];
    const auto alternative = data.define_dimension("alternatives_of_" + choice.name, choice.alternatives.size());
    std::vector<std::string> names;
    std::vector<double> shares;
    for (std::size_t a = 0; a < choice.alternatives.size(); ++a) {
      names.push_back(choice.alternatives[a].name);
      shares.push_back(choice.share(a));
    }
    data.define_texts("alternatives_of_" + choice.name, alternative, names, "alternatives of the choice");
    data.write(
        data.define_variable("share_of_" + choice.name, {alternative}, "1", "share of the samples by the weights"),
        shares);
    const auto conditional = [&](const char* what, const char* meaning, double ConditionalMoments::* member) {
      std::vector<double> values;
      for (const ToleranceOutput& o : result.outputs) {
        for (const ConditionalMoments& m : o.choices[k].alternatives) values.push_back(m.*member);
      }
      data.write(data.define_variable(what + choice.name, {output, alternative}, "1", meaning), values);
    };
    conditional("mean_by_", "mean where it is chosen, unit of the output", &ConditionalMoments::mean);
    conditional("deviation_by_", "standard deviation where it is chosen, unit of the output",
                &ConditionalMoments::deviation);
  }
  data.close();
}

}  // namespace wingbeat
