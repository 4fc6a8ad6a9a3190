#include "wingbeat/files/optimise_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "files/drive_train_parts.hpp"
#include "files/motor_catalogue.hpp"
#include "files/study_sections.hpp"
#include "files/table_form.hpp"
#include "files/text_encoding.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/study/sampling.hpp"

namespace wingbeat {
namespace {

namespace fs = std::filesystem;
using detail::Kind;

class OptimiseReader : public detail::StudySections {
 public:
  OptimiseReader(const fs::path& file, std::string_view text, std::span<const std::string> overrides)
      : StudySections(
            input_name(file), text, overrides,
            {"objective", "parameter", "constraint", "motors", "search", "drive_train", "gearboxes", "batteries"},
            {"condition", "count_after_hover"}),
        folder_(file.parent_path()) {}

  OptimiseFile read() {
    OptimiseFile file;
    OptimiseStudy& study = file.study;
    attempt([&] { file.title = read_title(); });
    attempt([&] {
      if (const TomlNode* metrics = study_->find("metrics")) {
        refuse(*metrics, "study.metrics",
               "does not apply here: the objective and the constraints say which are wanted");
      }
    });
    attempt([&] { study.options.condition = read_condition(); });
    attempt([&] {
      EnsembleOptions accuracy;
      accuracy.tolerance = study.options.tolerance;
      read_tolerance(accuracy);
      study.options.tolerance = accuracy.tolerance;
    });
    attempt([&] { study.allow_extrapolation = read_allow_extrapolation(); });
    const TomlNode* const after_hover = study_->find("count_after_hover");
    attempt([&] { counts_after_hover_ = after_hover && boolean(*after_hover, "study.count_after_hover"); });
    if (!attempt([&] { study.design = read_vehicle(folder_); })) finish();  // the rest is read for this vehicle
    file.vehicle_file = find_vehicle(folder_, vehicle_file());
    attempt([&] { study.options.hold = read_hold(study.design); });
    const bool parts_read = attempt([&] {
      read_drive_train(file);
      if (const TomlNode* motors = root_.find("motors")) read_motors(*motors, file);
      if (file.drive_train.any()) check_drive_train(file);
    });
    if (!parts_read) finish();
    // The keys of listed parts are those of the first usable ones.
    const auto first_usable = [](const auto& list) {
      const auto found = std::find_if(list.begin(), list.end(), [](const auto& part) { return part.refused.empty(); });
      return found == list.end() ? nullptr : &*found;
    };
    const MotorCandidate* const motor = first_usable(file.motors);
    const Design<double> base =
        with_parts(motor ? motor->design : study.design, first_usable(file.drive_train.gearboxes),
                   first_usable(file.drive_train.batteries));
    several_ = root_.find("objective") && root_.find("objective")->kind == Kind::array;
    attempt([&] {
      if (several_) read_objectives(file, base);
      else read_objective(study, base);
    });
    attempt([&] { read_parameters(file, base); });
    attempt([&] { read_constraints(study, base); });
    attempt([&] {
      if (!after_hover || counts_flight_) return;
      refuse(*after_hover, "study.count_after_hover",
             "does not apply here: neither the objective nor a constraint is endurance_s");
    });
    finish();
    check_size(file);
    return file;
  }

 private:
  /// The metric of that name. One that the vehicle does not have is refused with what it needs. The endurance is
  /// counted while lift carries the weight, unless the study says otherwise.
  Metric metric_named(const TomlNode& node, const std::string& where, const Design<double>& design) {
    const std::string name = text_of(node, where, "the name of a metric such as \"power_electrical_w\"");
    const Metric metric = metric_called(node, where, name);
    const bool flight = metric == Metric::endurance;
    counts_flight_ = counts_flight_ || flight;
    const bool while_hovering = flight && !counts_after_hover_ && !missing_key(metric, design);
    if (while_hovering && !design.mass) {
      refuse(node, where,
             "endurance_s counts while lift carries the weight, which needs vehicle.mass; give it, or "
             "count_after_hover = true in [study] for the time to the battery's end");
    }
    if (metric == Metric::floquet_multiplier_max && !several_)
      refuse(node, where, fmt::format("{} has no derivative", name));
    if (metric == Metric::lift_to_weight && !design.mass) {
      refuse(node, where, "lift_to_weight needs vehicle.mass; give it in the vehicle file or in [set]");
    }
    if (metric == Metric::power_motor_reference && !design.bench_torque_constant) {
      refuse(node, where, "power_motor_reference_w needs bench.torque_constant");
    }
    if (const char* lacks = missing_key(metric, design)) {
      refuse(node, where, fmt::format("{} needs {} in the vehicle file", name, lacks));
    }
    return while_hovering ? Metric::hover : metric;
  }

  void read_objective(OptimiseStudy& study, const Design<double>& design) {
    const TomlNode& node = need(root_, "", "objective", "a section [objective] with minimise or maximise");
    must_be_section(node, "objective");
    known_keys(node, "objective", {"minimise", "maximise", "starts", "seed", "screen"});
    const TomlNode *low = node.find("minimise"), *high = node.find("maximise");
    if (bool(low) == bool(high)) refuse(node, "objective", "give one of minimise and maximise");
    study.maximise = high != nullptr;
    study.objective = metric_named(high ? *high : *low, high ? "objective.maximise" : "objective.minimise", design);
    if (const TomlNode* search = root_.find("search")) {
      refuse(*search, "search",
             "belongs to several [[objective]] sections; starts, screen and seed of one stand in "
             "[objective]");
    }
    if (const TomlNode* starts = node.find("starts")) {
      study.starts = int(whole_number(*starts, "objective.starts", 1, 10000));
    }
    if (const TomlNode* seed = node.find("seed")) {
      study.seed = whole_number(*seed, "objective.seed", 0, std::uint64_t(1) << 53);
    }
    if (const TomlNode* screen = node.find("screen")) {
      study.screen = whole_number(*screen, "objective.screen", 16, 1000000);
    }
  }

  void read_objectives(OptimiseFile& file, const Design<double>& design) {
    const TomlNode& list = *root_.find("objective");
    if (list.items.size() < 2 || list.items.size() > 3) {
      refuse(list.items.empty() ? list : list.items.back(), "objective",
             "expected one section [objective], or two or three sections [[objective]]");
    }
    for (const TomlNode& node : sections_of("objective")) {
      known_keys(node, "objective", {"minimise", "maximise", "reference"});
      const TomlNode *low = node.find("minimise"), *high = node.find("maximise");
      if (bool(low) == bool(high)) refuse(node, "objective", "give one of minimise and maximise");
      ParetoObjective objective;
      objective.maximise = high != nullptr;
      const char* where = high ? "objective.maximise" : "objective.minimise";
      objective.metric = metric_named(high ? *high : *low, where, design);
      for (const ParetoObjective& other : file.objectives) {
        if (other.metric != objective.metric) continue;
        refuse(high ? *high : *low, where, "is an objective already");
      }
      if (const TomlNode* reference = node.find("reference")) {
        objective.reference = quantity(*reference, "objective.reference", metric_info(objective.metric).unit);
      }
      file.objectives.push_back(objective);
    }
    const TomlNode* search = root_.find("search");
    EvolutionOptions& evolution = file.evolution;
    if (search) {
      must_be_section(*search, "search");
      known_keys(*search, "search", {"method", "population", "generations", "screen", "seed", "designs"});
      if (const TomlNode* method = search->find("method")) {
        evolution.method = one_of<EvolutionMethod>(*method, "search.method");
      }
      if (const TomlNode* population = search->find("population")) {
        evolution.population = unsigned(whole_number(*population, "search.population", 8, 10000));
        if (evolution.population % 4 != 0) refuse(*population, "search.population", "must be a multiple of 4");
      }
      if (const TomlNode* generations = search->find("generations")) {
        evolution.generations = unsigned(whole_number(*generations, "search.generations", 1, 100000));
      }
      if (const TomlNode* seed = search->find("seed")) {
        evolution.seed = unsigned(whole_number(*seed, "search.seed", 0, (std::uint64_t(1) << 32) - 1));
      }
      if (const TomlNode* designs = search->find("designs")) {
        file.designs = std::size_t(whole_number(*designs, "search.designs", 1, 1000));
      }
    }
    file.study.screen = std::max<std::uint64_t>(file.study.screen, evolution.population);
    const TomlNode* screen = search ? search->find("screen") : nullptr;
    if (screen) {
      file.study.screen = whole_number(*screen, "search.screen", 16, 1000000);
      if (file.study.screen < evolution.population) {
        refuse(*screen, "search.screen", fmt::format("must be at least the population, {}", evolution.population));
      }
    }
  }

  /// The list of a discrete parameter.
  std::vector<double> values_of(const TomlNode& node, const TomlNode& values, const DesignParameter& parameter) {
    for (const char* other : {"lower", "upper", "scale"}) {
      if (const TomlNode* given = node.find(other)) {
        refuse(*given, fmt::format("parameter.{}", other), "cannot be combined with parameter.values");
      }
    }
    if (values.kind != Kind::array || values.items.size() < 2) {
      wrong(values, "parameter.values", "an array of at least two values");
    }
    std::vector<double> list;
    for (const TomlNode& item : values.items) {
      list.push_back(quantity(item, "parameter.values", parameter.unit));
      if (std::count(list.begin(), list.end(), list.back()) > 1) {
        refuse(item, "parameter.values", fmt::format("{:.6g} is given twice", list.back()));
      }
    }
    return list;
  }

  /// Refuses a value that leaves the parameter's own range.
  void check_range(const TomlNode& node, const std::string& where, const DesignParameter& parameter, double value,
                   const Design<double>& design) const {
    Design<double> d = design;
    parameter.set(d, value);
    try {
      validate(d);
    } catch (const ParameterError& error) {
      if (error.key() == parameter.key) refuse(node, where, error.what());
    }
  }

  void check_size(const OptimiseFile& file) const {
    if (file.drive_train.any()) return check_combinations(file);
    const std::size_t max_combinations = 1000;
    std::size_t combinations = 1;
    for (const DiscreteParameter& p : file.choices) combinations *= p.values.size();
    combinations *= std::max<std::size_t>(1, file.motors.size());
    const TomlNode& list = *root_.find("parameter");
    if (!several_ && combinations > max_combinations) {
      refuse(list, "parameter.values",
             fmt::format("{} combinations are more than {}: one objective tries each of them; "
                         "take fewer values, or bounds instead",
                         combinations, max_combinations));
    }
    if (file.study.parameters.size() + file.choices.size() + 1 > ScrambledSobol::max_dimensions) {
      refuse(list, "parameter", fmt::format("more than {} parameters", ScrambledSobol::max_dimensions - 1));
    }
  }

  void read_parameters(OptimiseFile& file, const Design<double>& design) {
    OptimiseStudy& study = file.study;
    if (file.drive_train.any() && !root_.find("parameter")) return;
    const TomlNode& list = need(root_, "", "parameter", "[[parameter]] sections with key, lower and upper");
    if (list.kind != Kind::array || list.items.empty()) wrong(list, "parameter", "[[parameter]] sections");
    std::set<std::string> used;
    Design<double> all = design;
    std::vector<std::pair<const DesignParameter*, double>> given;
    study.parameters.reserve(list.items.size());
    file.choices.reserve(list.items.size());
    const auto read_one = [&](const TomlNode& node) {
      known_keys(node, "parameter", {"key", "lower", "upper", "scale", "values"});
      const TomlNode& key = need(node, "parameter", "key", "a vehicle-file key");
      const DesignParameter parameter = parameter_named(key, "parameter.key", design);
      if (!used.insert(parameter.key).second) {
        refuse(key, "parameter.key", fmt::format("{} is given already", parameter.key));
      }
      no_override_of(parameter.key, "has no effect: the study varies it");
      if (const char* parts = detail::listed_with(file.drive_train, parameter.key)) {
        refuse(key, "parameter.key", fmt::format("{} is stated by the list of {}", parameter.key, parts));
      }
      if (const TomlNode* values = node.find("values")) {
        file.choices.push_back({parameter, values_of(node, *values, parameter)});
        const std::vector<double>& list_of = file.choices.back().values;
        for (std::size_t n = 0; n < list_of.size(); ++n) {
          check_range(values->items[n], "parameter.values", parameter, list_of[n], design);
        }
        given.emplace_back(&file.choices.back().parameter, list_of[0]);
      } else {
        study.parameters.push_back(bounded(node, parameter, design));
        given.emplace_back(&study.parameters.back().parameter, study.parameters.back().lower);
      }
      given.back().first->set(all, given.back().second);
    };
    bool all_read = true;
    for (const TomlNode& node : sections_of("parameter")) {
      if (!attempt([&] { read_one(node); })) all_read = false;
    }
    for (std::size_t k = 0; all_read && k < given.size(); ++k) {
      const auto found = given[k].first->value(all);
      if (!found || *found != given[k].second) {
        refuse(list.items[k], "parameter.key",
               fmt::format("another parameter takes the place of {}", given[k].first->key));
      }
    }
  }

  OptimisedParameter bounded(const TomlNode& node, const DesignParameter& parameter, const Design<double>& design) {
    OptimisedParameter p;
    p.parameter = parameter;
    const TomlNode& lower = need(node, "parameter", "lower", quantity_example(parameter.unit));
    const TomlNode& upper = need(node, "parameter", "upper", quantity_example(parameter.unit));
    p.lower = quantity(lower, "parameter.lower", parameter.unit);
    p.upper = quantity(upper, "parameter.upper", parameter.unit);
    if (!(p.upper > p.lower)) refuse(upper, "parameter.upper", "must exceed parameter.lower");
    if (const TomlNode* scale = node.find("scale")) {
      p.logarithmic = one_of(*scale, "parameter.scale", {"linear", "log"}) == "log";
    }
    if (p.logarithmic && !(p.lower > 0.0)) refuse(lower, "parameter.lower", "must be > 0 on a logarithmic scale");
    check_range(lower, "parameter.lower", parameter, p.lower, design);
    check_range(upper, "parameter.upper", parameter, p.upper, design);
    return p;
  }

  void read_constraints(OptimiseStudy& study, const Design<double>& design) {
    const auto read_one = [&](const TomlNode& node) {
      known_keys(node, "constraint", {"metric", "at_least", "at_most"});
      const TomlNode& name = need(node, "constraint", "metric", "the name of a metric");
      const Metric metric = metric_named(name, "constraint.metric", design);
      const TomlNode *low = node.find("at_least"), *high = node.find("at_most");
      if (!low && !high) refuse(node, "constraint", "give at_least, at_most or both");
      const std::string_view unit = metric_info(metric).unit;
      if (low) study.constraints.push_back({metric, true, quantity(*low, "constraint.at_least", unit)});
      if (high) study.constraints.push_back({metric, false, quantity(*high, "constraint.at_most", unit)});
      if (low && high && !(study.constraints.back().limit > study.constraints.rbegin()[1].limit)) {
        refuse(*high, "constraint.at_most", "must exceed constraint.at_least");
      }
    };
    for (const TomlNode& node : sections_of("constraint")) attempt([&] { read_one(node); });
  }

  // ---- [motors]

  void read_motors(const TomlNode& node, OptimiseFile& file) {
    must_be_section(node, "motors");
    known_keys(
        node, "motors",
        {"catalogue", "gear_ratio", "mass_without", "columns", "separator", "decimal", "within_nominal_current"});
    const TomlNode& name = need(node, "motors", "catalogue", "the name of a CSV file");
    const fs::path path = folder_ / text_of(name, "motors.catalogue", "the name of a CSV file");
    if (!is_there(path)) refuse(name, "motors.catalogue", fmt::format("there is no file {}", path.string()));
    const bool gearboxes = !file.drive_train.gearboxes.empty();
    if (const TomlNode* ratio = node.find("gear_ratio"); ratio && gearboxes) {
      refuse(*ratio, "motors.gear_ratio", "cannot be combined with [gearboxes], which state theirs");
    }
    double gear = 1.0;
    if (!gearboxes) {
      const TomlNode& ratio =
          need(node, "motors", "gear_ratio", "the ratio of the gearbox behind motors that have none");
      gear = quantity(ratio, "motors.gear_ratio", "1");
      if (!(gear > 0.0)) refuse(ratio, "motors.gear_ratio", "must be > 0");
    }
    std::optional<double> rest;
    if (const TomlNode* mass = node.find("mass_without"); mass && file.drive_train.any()) {
      refuse(*mass, "motors.mass_without", "stands in [drive_train] where gearboxes or batteries are lists");
    } else if (mass) {
      rest = quantity(*mass, "motors.mass_without", "kg");
      if (!(*rest > 0.0)) refuse(*mass, "motors.mass_without", "must be > 0 kg");
      if (file.study.design.masses.motor) {
        refuse(*mass, "motors.mass_without",
               "does not apply where the vehicle gives motor.mass: vehicle.mass is without the motor already");
      }
    }
    if (const TomlNode* within = node.find("within_nominal_current")) {
      file.within_nominal_current = boolean(*within, "motors.within_nominal_current");
    }
    // Where the whole drive train is chosen, the vehicle's mass is one without its motor already.
    if (file.drive_train.any() && mass_without_) rest = mass_without_;
    std::string encoding;
    const std::string list = detail::decoded(read_text_file(path), path.string(), encoding);
    file.motors = detail::parse_motor_catalogue(
        list, path.string(), gear, rest, file.study.design,
        detail::stated_table(TomlFields(this->file(), "motors", node), "torque_constant"));
    for (MotorCandidate& motor : file.motors) {
      if (gearboxes && motor.refused.empty() && !motor.design.motor.gear_ratio) {
        motor.refused = "already has a gearbox";
      }
    }
    require_usable(name, "motors", "motor", file.motors);
  }

  /// Refuses a list of which nothing can be tried.
  template <class List>
  void require_usable(const TomlNode& node, const std::string& section, const char* part, const List& list) const {
    if (std::any_of(list.begin(), list.end(), [](const auto& p) { return p.refused.empty(); })) return;
    std::string reason = fmt::format("holds no {}{}", part, list.empty() ? "" : " that can be tried");
    if (!list.empty()) reason += fmt::format(": {}: {}", list.begin()->model, list.begin()->refused);
    refuse(node, section + ".catalogue", reason);
  }

  // [drive_train], [gearboxes], [batteries]
  void read_drive_train(OptimiseFile& file) {
    const TomlNode* const section = root_.find("drive_train");
    const TomlNode* const gearboxes = root_.find("gearboxes");
    const TomlNode* const batteries = root_.find("batteries");
    Design<double>& design = file.study.design;
    if (section) {
      must_be_section(*section, "drive_train");
      known_keys(*section, "drive_train", {"mass_without", "compatible", "screen", "refine"});
      if (!gearboxes && !batteries) {
        refuse(*section, "drive_train", "needs a list of gearboxes or of batteries, in [gearboxes] or [batteries]");
      }
      if (const TomlNode* mass = section->find("mass_without")) {
        mass_without_ = quantity(*mass, "drive_train.mass_without", "kg");
        if (!(*mass_without_ > 0.0)) refuse(*mass, "drive_train.mass_without", "must be > 0 kg");
        design.mass = mass_without_;
      }
      DriveTrainSearch& search = file.drive_train;
      if (const TomlNode* screen = section->find("screen")) {
        search.screen = int(whole_number(*screen, "drive_train.screen", 1, 10000));
      }
      if (const TomlNode* refine = section->find("refine")) {
        search.refine = int(whole_number(*refine, "drive_train.refine", 1, 1000));
      }
      if (const TomlNode* compatible = section->find("compatible")) {
        if (!gearboxes || !root_.find("motors")) {
          refuse(*compatible, "drive_train.compatible", "needs lists of motors and of gearboxes");
        }
        search.compatible = detail::parse_compatibility(text_beside(*compatible, "drive_train.compatible").second);
        if (search.compatible.empty()) {
          refuse(*compatible, "drive_train.compatible", "is empty; expected lines with a motor and its gearboxes");
        }
      }
    }
    const auto read_list = [&](const TomlNode* node, const std::string& name, const char* column, const auto& parse) {
      if (!node) return;
      must_be_section(*node, name);
      known_keys(*node, name, {"catalogue", "columns", "separator", "decimal"});
      const TomlNode& catalogue = need(*node, name, "catalogue", "the name of a CSV file");
      const auto [path, list] = text_beside(catalogue, name + ".catalogue");
      parse(catalogue, path, list, detail::stated_table(TomlFields(this->file(), name, *node), column));
    };
    const bool weighed = design.mass.has_value();
    read_list(gearboxes, "gearboxes", "ratio",
              [&](const TomlNode& node, const auto& path, const auto& list, const auto& form) {
                file.drive_train.gearboxes = detail::parse_gearboxes(list, path, form, weighed);
                require_usable(node, "gearboxes", "gearbox", file.drive_train.gearboxes);
              });
    read_list(batteries, "batteries", "capacity",
              [&](const TomlNode& node, const auto& path, const auto& list, const auto& form) {
                if (!has_battery(design.supply.type)) {
                  refuse(*batteries, "batteries",
                         "needs a vehicle with supply.type = \"battery\", whose discharge curve the batteries have");
                }
                file.drive_train.batteries = detail::parse_batteries(list, path, form, weighed, design);
                require_usable(node, "batteries", "battery", file.drive_train.batteries);
              });
  }

  /// Name and text of a file that is named beside the study.
  std::pair<std::string, std::string> text_beside(const TomlNode& name, const std::string& key) const {
    const fs::path path = folder_ / text_of(name, key, "the name of a CSV file");
    if (!is_there(path)) refuse(name, key, fmt::format("there is no file {}", path.string()));
    std::string encoding;
    return {path.string(), detail::decoded(read_text_file(path), path.string(), encoding)};
  }

  void check_drive_train(const OptimiseFile& file) const {
    const DriveTrainSearch& search = file.drive_train;
    const Design<double>& design = file.study.design;
    if (!search.gearboxes.empty() && file.motors.empty() && (design.piezo.force_per_volt || !design.motor.gear_ratio)) {
      refuse(*root_.find("gearboxes"), "gearboxes",
             "needs a list of motors, or a vehicle with motor.gear_ratio: constants at the output shaft hold those of "
             "its gearbox");
    }
    if (root_.find("objective") && root_.find("objective")->kind == Kind::array) {
      refuse(*root_.find("objective"), "objective", "lists of gearboxes and of batteries take one objective");
    }
    if (!design.mass || mass_without_) return;
    const ItemMasses<double>& masses = design.masses;
    const bool drives = !search.gearboxes.empty() || !file.motors.empty();
    const bool battery = masses.supply || design.supply.battery.specific_energy;
    if ((!drives || masses.motor) && (search.batteries.empty() || battery)) return;
    const TomlNode& list = *root_.find(search.gearboxes.empty() ? "batteries" : "gearboxes");
    refuse(
        list, "drive_train.mass_without",
        "missing: the mass of the vehicle without the parts that the lists state; or give motor.mass and supply.mass "
        "in the vehicle, in whose place the lists' masses then stand");
  }

  void check_combinations(const OptimiseFile& file) const {
    constexpr std::size_t max_designs = 4000000;
    const std::size_t combinations = combinations_of(file).size();
    const TomlNode& section = *root_.find(file.drive_train.gearboxes.empty() ? "batteries" : "gearboxes");
    if (combinations == 0) refuse(section, "drive_train.compatible", "no motor goes with any of the gearboxes");
    const std::size_t each = file.study.parameters.empty() ? 1 : std::size_t(file.drive_train.screen);
    if (combinations * each <= max_designs) return;
    refuse(section, "drive_train.screen",
           fmt::format("{} combinations of {} designs are more than {} designs", combinations, each, max_designs));
  }

  fs::path folder_;
  std::optional<double> mass_without_;  ///< the vehicle without the parts of a drive train [kg]
  bool several_ = false;                ///< objectives
  bool counts_after_hover_ = false;     ///< endurance_s runs to the battery's end
  bool counts_flight_ = false;          ///< endurance_s is an objective or in a constraint
};

}  // namespace

OptimiseFile read_optimise_study(const fs::path& file, std::span<const std::string> overrides) {
  return OptimiseReader(file, read_text_file(file), overrides).read();
}

}  // namespace wingbeat
