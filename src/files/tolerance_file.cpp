#include "wingbeat/files/tolerance_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "files/choice_sections.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat {
namespace {

namespace fs = std::filesystem;
using detail::Kind, detail::reason_of;

class ToleranceReader : public detail::ChoiceSections {
 public:
  ToleranceReader(const fs::path& file, std::string_view text, std::span<const std::string> overrides)
      : ChoiceSections(input_name(file), text, overrides, {"samples", "parameter", "fit", "choice"}, {"condition"}),
        folder_(file.parent_path()) {}

  ToleranceStudy read() {
    ToleranceStudy study;
    study_result_ = &study;
    attempt([&] { study.title = read_title(); });
    attempt([&] { study.condition = read_condition(); });
    attempt([&] { read_tolerance(study.options); });
    attempt([&] { study.allow_extrapolation = read_allow_extrapolation(); });
    attempt([&] { read_metrics(study.options); });
    attempt([&] { read_samples(); });
    // The rest is read for these vehicles.
    if (!read_choices(study.choices) || !read_combinations(study, folder_)) finish();
    std::vector<const Design<double>*> designs = {&study.design};
    for (const Design<double>& design : study.combinations) designs.push_back(&design);
    complete_metrics(study.options, designs);
    if (study.design.mass) study.options.metrics.set(std::size_t(Metric::lift_to_weight));
    attempt([&] { study.hold = read_hold(study.design); });
    attempt([&] { check_combinations(study); });
    attempt([&] {
      if (const TomlNode* fit = root_.find("fit")) read_fit(*fit);
    });
    attempt([&] { read_parameters(); });
    finish();
    read_correlations();
    for (const ModelChoice& choice : study.choices) {
      if (choice.name == study.covariance_name) {
        refuse(*root_.find("choice"), "choice.name", fmt::format("{} is the name of the fit", in_quotes(choice.name)));
      }
    }
    const std::size_t inputs = study.parameters.size() + study.choices.size();
    if (inputs == 0) {
      refuse(*study_, "study", "nothing is uncertain; give [[parameter]] or [[choice]] sections or [fit]");
    }
    const std::size_t dimensions = (study.indices ? 2 : 1) * inputs;
    if (dimensions > ScrambledSobol::max_dimensions) {
      refuse(*study_, "parameter",
             fmt::format("{} parameters{} are more than a study can vary at once ({})", inputs,
                         study.choices.empty() ? "" : " and choices",
                         ScrambledSobol::max_dimensions / (study.indices ? 2 : 1)));
    }
    if (study.choices.empty()) check_means(study.design, "", places_.at(study.parameters.front().parameter.key));
    for (std::size_t v = 0; v < study.combinations.size(); ++v) {
      const std::string with = fmt::format("with {}, ", in_words(study, v));
      check_means(study.combinations[v], with, place_of_combination(study, v));
    }
    return study;
  }

 private:
  void read_samples() {
    ToleranceStudy& study = *study_result_;
    const TomlNode* node = root_.find("samples");
    if (!node) return;
    must_be_section(*node, "samples");
    known_keys(*node, "samples", {"method", "count", "seed", "indices", "resamples"});
    if (const TomlNode* method = node->find("method")) {
      study.method = one_of<ToleranceMethod>(*method, "samples.method");
    }
    if (const TomlNode* count = node->find("count")) study.count = whole_number(*count, "samples.count", 2, 1000000);
    if (const TomlNode* seed = node->find("seed")) {
      study.seed = whole_number(*seed, "samples.seed", 0, std::uint64_t(1) << 53);
    }
    if (const TomlNode* indices = node->find("indices")) {
      study.indices = boolean(*indices, "samples.indices");
    }
    if (const TomlNode* n = node->find("resamples")) {
      study.resamples = int(whole_number(*n, "samples.resamples", 2, 100000));
    }
  }

  void read_parameters() {
    for (const TomlNode& node : sections_of("parameter")) attempt([&] { read_parameter(node); });
  }

  void read_parameter(const TomlNode& node) {
    known_keys(node, "parameter",
               {"key", "distribution", "mean", "median", "deviation", "relative_deviation", "geometric_deviation",
                "lower", "upper", "correlation"});
    UncertainParameter p;
    const TomlNode& key = need(node, "parameter", "key", "a vehicle-file key");
    p.parameter = parameter_named(key, "parameter.key", study_result_->design);
    add_key(key, "parameter.key", p.parameter.key);
    const std::string& unit = p.parameter.unit;
    const double present = *p.parameter.value(study_result_->design);
    const TomlNode& kind = need(node, "parameter", "distribution", "\"normal\", \"uniform\" or \"lognormal\"");
    const std::string name = name_of(one_of<DistributionKind>(kind, "parameter.distribution"));
    const auto not_with = [&](std::initializer_list<const char*> keys) {
      for (const char* other : keys) {
        if (const TomlNode* given = node.find(other)) {
          refuse(*given, fmt::format("parameter.{}", other),
                 fmt::format("does not apply with distribution = \"{}\"", name));
        }
      }
    };
    const auto optional = [&](const char* what, std::string_view in, double& x) {
      const TomlNode* given = node.find(what);
      if (given) x = quantity(*given, fmt::format("parameter.{}", what), in);
      return given;
    };
    Distribution& d = p.distribution;
    optional("lower", unit, d.lower);
    const TomlNode* upper = optional("upper", unit, d.upper);
    if (upper && !(d.upper > d.lower)) refuse(*upper, "parameter.upper", "must exceed parameter.lower");
    if (name == "uniform") {
      d.kind = DistributionKind::uniform;
      not_with({"mean", "median", "deviation", "relative_deviation", "geometric_deviation"});
      for (const char* bound : {"lower", "upper"}) need(node, "parameter", bound, quantity_example(unit));
    } else if (name == "normal") {
      not_with({"median", "geometric_deviation"});
      d.centre = present;
      optional("mean", unit, d.centre);
      const TomlNode* absolute = optional("deviation", unit, d.spread);
      const TomlNode* relative = optional("relative_deviation", "1", d.spread);
      if (bool(absolute) == bool(relative)) {
        refuse(node, "parameter.deviation", "give one of deviation and relative_deviation");
      }
      if (relative && d.centre == 0.0) {
        refuse(*relative, "parameter.relative_deviation", "the mean is 0; give deviation instead");
      }
      if (!(d.spread > 0.0)) {
        refuse(absolute ? *absolute : *relative, absolute ? "parameter.deviation" : "parameter.relative_deviation",
               "must be > 0");
      }
      if (relative) d.spread *= std::abs(d.centre);
    } else {
      d.kind = DistributionKind::lognormal;
      not_with({"mean", "deviation", "relative_deviation"});
      d.centre = present;
      optional("median", unit, d.centre);
      if (!(d.centre > 0.0)) {
        refuse(node.find("median") ? *node.find("median") : node, "parameter.median", "must be > 0");
      }
      const TomlNode& factor = need(node, "parameter", "geometric_deviation", "a number > 1, as 1.2");
      d.spread = quantity(factor, "parameter.geometric_deviation", "1");
      if (!(d.spread > 1.0)) refuse(factor, "parameter.geometric_deviation", "must be > 1");
      d.spread = std::log(d.spread);
    }
    if (name == "uniform" || node.find("mean") || node.find("median")) {
      no_override_of(p.parameter.key, "has no effect: the study gives the distribution's centre");
    }
    if (!(d.share_kept() > 1e-6)) {
      refuse(
          node, "parameter",
          fmt::format("the bounds cut off all but {:.1g} of the distribution of {}", d.share_kept(), p.parameter.key));
    }
    study_result_->parameters.push_back(std::move(p));
    if (const TomlNode* correlation = node.find("correlation")) {
      if (correlation->kind != Kind::array) correlated_.emplace_back(study_result_->parameters.size() - 1, correlation);
      else
        for (const TomlNode& item : correlation->items) {
          correlated_.emplace_back(study_result_->parameters.size() - 1, &item);
        }
    }
  }

  /// Correlations, once every parameter is known.
  void read_correlations() {
    ToleranceStudy& study = *study_result_;
    const std::string where = "parameter.correlation";
    for (const auto& [first, node] : correlated_) {
      if (node->kind != Kind::table) wrong(*node, where, "{ with = \"motor.torque_constant\", value = 0.5 }");
      known_keys(*node, where, {"with", "value"});
      const TomlNode& with = need(*node, where, "with", "the key of another uncertain parameter");
      const std::string other = text_of(with, where + ".with", "the key of another uncertain parameter");
      const auto found = std::find_if(study.parameters.begin(), study.parameters.end(),
                                      [&](const UncertainParameter& p) { return p.parameter.key == other; });
      if (found == study.parameters.end()) {
        refuse(with, where + ".with", fmt::format("{} is no uncertain parameter of this study", in_quotes(other)));
      }
      if (found->correlated) {
        refuse(with, where + ".with", fmt::format("{} comes with the covariance of a fit already", other));
      }
      const std::size_t second = std::size_t(found - study.parameters.begin());
      if (second == first) refuse(with, where + ".with", "names the parameter itself");
      for (const std::size_t k : {first, second}) {
        const Distribution& d = study.parameters[k].distribution;
        if (d.kind != DistributionKind::uniform && !std::isfinite(d.lower) && !std::isfinite(d.upper)) continue;
        refuse(*node, where,
               fmt::format("{} must be normal or lognormal without bounds to be correlated",
                           study.parameters[k].parameter.key));
      }
      const TomlNode& value = need(*node, where, "value", "a number between -1 and 1");
      const double rho = quantity(value, where + ".value", "1");
      if (!(std::abs(rho) < 1.0)) refuse(value, where + ".value", "must lie between -1 and 1");
      for (const Correlation& c : study.correlations) {
        if (std::minmax(c.first, c.second) != std::minmax(first, second)) continue;
        refuse(*node, where,
               fmt::format("the correlation of {} with {} is given already", study.parameters[first].parameter.key,
                           other));
      }
      study.correlations.push_back({first, second, rho});
    }
    if (correlated_.empty()) return;
    ToleranceStudy trial = study;  // to learn whether the correlations go together
    trial.count = 1;
    trial.indices = false;
    try {
      tolerance_sweep(trial);
    } catch (const ParameterError&) {
      refuse(*correlated_.back().second, where,
             "no parameters can have all the correlations given: their matrix is not "
             "positive definite");
    }
  }

  void add_key(const TomlNode& node, const std::string& where, const std::string& key) {
    if (!used_.insert(key).second) refuse(node, where, fmt::format("{} is given already", key));
    if (const ModelChoice* choice = choice_of(study_result_->choices, key)) {
      refuse(node, where, fmt::format("the choice {} sets {} already", choice->name, key));
    }
    places_[key] = place_of(node);
  }

  /// The parameters of a fit with their covariance, as `wingbeat fit -o` writes them.
  void read_fit(const TomlNode& node) {
    must_be_section(node, "fit");
    known_keys(node, "fit", {"covariance"});
    const TomlNode& name = need(node, "fit", "covariance", "the .covariance.toml of a fit");
    const fs::path path = folder_ / text_of(name, "fit.covariance", "the .covariance.toml of a fit");
    if (!is_there(path)) refuse(name, "fit.covariance", fmt::format("there is no file {}", path.string()));
    ToleranceStudy& study = *study_result_;
    const std::string file = path.string();
    const TomlNode tree = parse_toml_tree(read_text_file(path), file);
    const auto refuse_there = [&](const TomlNode& refused, const std::string& key, const std::string& message) {
      throw InputError(file, refused.line, refused.column, key, message);
    };
    const TomlNode* list = tree.find("parameter");
    if (!list || list->kind != Kind::array || list->items.empty()) {
      refuse_there(tree, "parameter", "missing; expected [[parameter]] sections as wingbeat fit writes them");
    }
    const std::size_t count = list->items.size();
    for (const TomlNode& item : list->items) {
      const TomlNode* key = item.find("key");
      const TomlNode* value = item.find("value");
      if (!key || key->kind != Kind::text) refuse_there(item, "parameter.key", "missing; expected a vehicle-file key");
      if (!value || value->kind != Kind::number) refuse_there(item, "parameter.value", "missing; expected a number");
      UncertainParameter p;
      try {
        p.parameter = parameter_named(*key, "parameter.key", study.design);
      } catch (const InputError& error) {
        refuse_there(*key, "parameter.key", reason_of(error));
      }
      add_key(name, "fit.covariance", p.parameter.key);
      p.correlated = true;
      p.distribution.centre = value->number;
      study.parameters.push_back(std::move(p));
    }
    const TomlNode* section = tree.find("covariance");
    const TomlNode* matrix = section ? section->find("matrix") : nullptr;
    const auto shape = [&](const TomlNode& misshapen) {
      refuse_there(misshapen, "covariance.matrix", fmt::format("expected {0} rows of {0} numbers", count));
    };
    if (!matrix || matrix->kind != Kind::array || matrix->items.size() != count) shape(matrix ? *matrix : tree);
    for (const TomlNode& row : matrix->items) {
      if (row.kind != Kind::array || row.items.size() != count) shape(row);
      std::vector<double> numbers;
      for (const TomlNode& x : row.items) {
        if (x.kind != Kind::number) shape(x);
        numbers.push_back(x.number);
      }
      study.covariance.push_back(std::move(numbers));
    }
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double a = study.covariance[i][j], b = study.covariance[j][i];
        if (std::abs(a - b) > 1e-9 * std::abs(a)) refuse_there(*matrix, "covariance.matrix", "is not symmetric");
      }
      if (!(study.covariance[i][i] > 0.0)) refuse_there(*matrix, "covariance.matrix", "has a variance that is not > 0");
      study.parameters[i].distribution.spread = std::sqrt(study.covariance[i][i]);
    }
    study.covariance_name = path.stem().stem().string();
    ToleranceStudy trial = study;  // the root of the matrix is taken once, to learn whether it has one
    trial.count = 1;
    trial.indices = false;
    try {
      tolerance_sweep(trial);
    } catch (const ParameterError& error) {
      refuse_there(*matrix, "covariance.matrix", error.reason());
    }
  }

  /// The parameters' means are a vehicle that could be built. `with`: the alternatives that it has, in words; refused
  /// at `place` where no parameter is to blame.
  void check_means(const Design<double>& design, const std::string& with, SourceLocation place) const {
    Design<double> centre = design;
    for (const UncertainParameter& p : study_result_->parameters) {
      if (!p.parameter.value(design)) {
        refuse(places_.at(p.parameter.key), p.parameter.key, with + "the vehicle does not have it");
      }
      p.parameter.set(centre, p.distribution.mean());
    }
    for (const UncertainParameter& p : study_result_->parameters) {
      const auto found = p.parameter.value(centre);
      if (!found || *found != p.distribution.mean()) {
        refuse(places_.at(p.parameter.key), p.parameter.key, with + "another uncertain parameter takes its place");
      }
    }
    try {
      validate(centre);
    } catch (const ParameterError& error) {
      const auto parameter = places_.find(error.key());
      refuse(parameter == places_.end() ? place : parameter->second, error.key(),
             fmt::format("{}at the parameters' means: {}", with, error.reason()));
    }
  }

  fs::path folder_;
  std::set<std::string> used_;
  std::vector<std::pair<std::size_t, const TomlNode*>> correlated_;  ///< parameter and what it says
  std::map<std::string, SourceLocation, std::less<>> places_;
  ToleranceStudy* study_result_ = nullptr;
};

}  // namespace

ToleranceStudy read_tolerance_study(const fs::path& file, std::span<const std::string> overrides) {
  return ToleranceReader(file, read_text_file(file), overrides).read();
}

}  // namespace wingbeat
