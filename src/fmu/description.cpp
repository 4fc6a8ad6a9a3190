#include "fmu/description.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>
#include <vector>

#include "fmu/dependencies.hpp"
#include "fmu/instance.hpp"
#include "fmu/variables.hpp"
#include "wingbeat/core/text.hpp"

namespace wingbeat::fmu {
namespace {

/// The shortest text that reads back as x.
std::string number(double x) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, x).ptr};
}

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + detail::markup_escaped(value) + "\"";
}

/// Exponents of kg, m, s, A, K, rad, and the factor to the SI unit.
struct BaseUnit {
  std::array<int, 6> exponents{};
  double factor = 1.0;
};

BaseUnit base_of(const std::string& unit) {
  static const std::map<std::string, BaseUnit> known = {
      {"kg", {{1, 0, 0, 0, 0, 0}}},  {"m", {{0, 1, 0, 0, 0, 0}}},     {"s", {{0, 0, 1, 0, 0, 0}}},
      {"A", {{0, 0, 0, 1, 0, 0}}},   {"K", {{0, 0, 0, 0, 1, 0}}},     {"rad", {{0, 0, 0, 0, 0, 1}}},
      {"N", {{1, 1, -2, 0, 0, 0}}},  {"J", {{1, 2, -2, 0, 0, 0}}},    {"W", {{1, 2, -3, 0, 0, 0}}},
      {"V", {{1, 2, -3, -1, 0, 0}}}, {"ohm", {{1, 2, -3, -2, 0, 0}}}, {"H", {{1, 2, -2, -2, 0, 0}}},
      {"Hz", {{0, 0, -1, 0, 0, 0}}}, {"C", {{0, 0, 1, 1, 0, 0}}},     {"1", {}}};
  BaseUnit base;
  int sign = 1;
  std::string part;
  const auto add = [&] {
    if (part.empty()) return;
    const std::size_t digits = part.find_first_of("-0123456789");
    const bool one = part == "1";
    const std::string name = one ? part : part.substr(0, digits);
    const int power = one || digits == std::string::npos ? 1 : std::atoi(part.c_str() + digits);
    const auto found = known.find(name);
    if (found != known.end()) {
      for (std::size_t k = 0; k < 6; ++k) base.exponents[k] += sign * power * found->second.exponents[k];
    }
    part.clear();
  };
  for (const char c : unit) {
    if (c != '.' && c != '/') {
      part += c;
      continue;
    }
    add();
    if (c == '/') sign = -1;
  }
  add();
  return base;
}

class Writer {
 public:
  Writer(const Design<double>& design, const std::string& token, const FmuOptions& options)
      : design_(design),
        token_(token),
        options_(options),
        instance_(design),
        layout_(drive_vehicle(design, has_two_drives(design))),
        variables_(variables_of(design)) {
    // FMI 2 knows the number of event indicators alone, FMI 3 each as a variable.
    if (!is3() || !has_model_exchange()) {
      std::erase_if(variables_, [](const Variable& v) { return v.kind == VariableKind::indicator; });
    }
    instance_.initialise(0.0);
  }

  std::string all() {
    head();
    kinds();
    units();
    types();
    line(1, "<LogCategories>");
    for (const auto& [name, meaning] : {std::pair{"logStatusDiscard", "calls that were discarded"},
                                        std::pair{"logStatusError", "calls that failed"}}) {
      line(2, std::string("<Category") + attribute("name", name) + attribute("description", meaning) + "/>");
    }
    line(1, "</LogCategories>");
    line(1, "<DefaultExperiment startTime=\"0\" stopTime=\"1\" tolerance=\"1e-6\"" +
                (options_.version == FmiVersion::fmi3 || has_co_simulation() ? attribute("stepSize", "0.001")
                                                                             : std::string()) +
                "/>");
    line(1, "<ModelVariables>");
    for (const Variable& v : variables_) {
      if (is3()) variable3(v);
      else variable2(v);
    }
    line(1, "</ModelVariables>");
    structure();
    text_ += "</fmiModelDescription>\n";
    return text_;
  }

 private:
  void line(int depth, const std::string& content) {
    text_ += std::string(std::size_t(2 * depth), ' ') + content + "\n";
  }

  bool is3() const { return options_.version == FmiVersion::fmi3; }
  /// FMI 3 lists them in a file of their own.
  bool has_source_files() const { return options_.sources && !is3(); }
  bool has_model_exchange() const { return options_.kind != FmuKind::co_simulation; }
  bool has_co_simulation() const { return options_.kind != FmuKind::model_exchange; }

  void head() {
    text_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription";
    text_ += attribute("fmiVersion", is3() ? "3.0" : "2.0");
    text_ += attribute("modelName", design_.name.empty() ? options_.identifier : design_.name);
    text_ += attribute(is3() ? "instantiationToken" : "guid", token_);
    text_ += attribute("description", "Flapping-wing drive: electromechanical model of motor, transmission and wings");
    text_ += attribute("generationTool", "wingbeat " + options_.program_version);
    text_ += attribute("variableNamingConvention", "flat");
    if (!is3() && has_model_exchange()) {
      text_ += attribute("numberOfEventIndicators", std::to_string(instance_.indicator_count()));
    }
    text_ += ">\n";
  }

  void kinds() {
    const std::string name = attribute("modelIdentifier", options_.identifier);
    const std::string state =
        is3() ? " canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\" providesDirectionalDerivatives=\"true\""
              : " canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\" providesDirectionalDerivative=\"true\"";
    const auto kind = [&](const std::string& element, const std::string& attributes) {
      line(1, "<" + element + attributes + (has_source_files() ? ">" : "/>"));
      if (!has_source_files()) return;
      line(2, "<SourceFiles>");
      line(3, "<File name=\"fmu.cpp\"/>");
      line(2, "</SourceFiles>");
      line(1, "</" + element + ">");
    };
    if (has_model_exchange()) {
      kind("ModelExchange", name + state + (is3() ? "" : " completedIntegratorStepNotNeeded=\"true\""));
    }
    if (has_co_simulation()) kind("CoSimulation", name + state + " canHandleVariableCommunicationStepSize=\"true\"");
  }

  void units() {
    std::vector<std::string> seen;
    for (const Variable& v : variables_) {
      if (!v.unit.empty() && std::find(seen.begin(), seen.end(), v.unit) == seen.end()) seen.push_back(v.unit);
    }
    line(1, "<UnitDefinitions>");
    for (const std::string& unit : seen) {
      const BaseUnit base = base_of(unit);
      constexpr const char* names[] = {"kg", "m", "s", "A", "K", "rad"};
      std::string element = "<Unit" + attribute("name", unit) + "><BaseUnit";
      for (std::size_t k = 0; k < 6; ++k) {
        if (base.exponents[k] != 0) element += attribute(names[k], std::to_string(base.exponents[k]));
      }
      element += "/>";
      for (const DisplayUnit& d : display_units) {
        if (unit != d.unit) continue;
        element += "<DisplayUnit" + attribute("name", d.name) + attribute("factor", number(d.factor)) +
                   (d.offset != 0.0 ? attribute("offset", number(d.offset)) : std::string()) + "/>";
      }
      line(2, element + "</Unit>");
    }
    line(1, "</UnitDefinitions>");
  }

  /// Of the status.
  void types() {
    line(1, "<TypeDefinitions>");
    const std::string name = attribute("name", status_type) + attribute("description", "What a drive does");
    if (is3()) line(2, "<EnumerationType" + name + ">");
    else line(2, "<SimpleType" + name + "><Enumeration>");
    for (const StatusMeaning& s : status_meanings) {
      line(3, "<Item" + attribute("name", s.name) + attribute("value", std::to_string(int(s.status))) +
                  attribute("description", s.meaning) + "/>");
    }
    line(2, is3() ? "</EnumerationType>" : "</Enumeration></SimpleType>");
    line(1, "</TypeDefinitions>");
  }

  static constexpr const char* status_type = "Status";
  bool is_whole(const Variable& v) const { return v.kind == VariableKind::count; }
  std::string unit_of(const Variable& v) const {
    if (is_text(v) || is_whole(v) || v.unit.empty()) return {};
    return attribute("unit", v.unit) +
           (v.display_unit.empty() ? std::string() : attribute("displayUnit", v.display_unit));
  }
  bool is_text(const Variable& v) const { return v.kind == VariableKind::text; }

  /// A start value belongs to what is set, to constants, and to what is exact.
  bool has_start(const Variable& v) const {
    return v.causality == "input" || v.causality == "parameter" || v.variability == "constant";
  }
  std::string start_of(const Variable& v) const {
    if (is_text(v)) return instance_.text(v.reference());
    if (is_whole(v)) return std::to_string(instance_.whole(v.reference()).value_or(0));
    return number(instance_.real(v.reference()).value_or(0.0));
  }

  std::string bounds(const Variable& v) const {
    std::string text;
    if (v.min) text += attribute("min", number(*v.min));
    if (v.max) text += attribute("max", number(*v.max));
    return text;
  }

  /// Nominal value, and whether events may set it anew: the motion at stops and standstill, not the sums.
  std::string of_state(const Variable& v) const {
    const bool moves = v.side != body_side && v.number < layout_.indices.count;
    const std::size_t drives = has_two_drives(design_) ? 2 : 1;
    const std::size_t before = layout_.count() * (v.side == body_side ? drives : v.side == 2 ? 1 : 0);
    return attribute("nominal", number(instance_.nominals()[before + v.number])) +
           (moves && has_model_exchange() ? attribute("reinit", "true") : std::string());
  }

  /// Value references of the state behind a derivative.
  static std::size_t state_behind(const Variable& v) { return reference_of(VariableKind::state, v.number, v.side); }

  void variable2(const Variable& v) {
    line(2, "<ScalarVariable" + attribute("name", v.name) + attribute("valueReference", std::to_string(v.reference())) +
                attribute("description", v.description) + attribute("causality", v.causality) +
                attribute("variability", v.variability) +
                (v.initial.empty() || v.causality == "independent" ? std::string() : attribute("initial", v.initial)) +
                ">");
    std::string type = is_text(v) ? "<String" : v.is_status() ? "<Enumeration" : is_whole(v) ? "<Integer" : "<Real";
    if (v.is_status()) type += attribute("declaredType", status_type);
    type += unit_of(v);
    if (!is_text(v)) type += bounds(v);
    if (v.kind == VariableKind::state) type += of_state(v);
    if (has_start(v)) type += attribute("start", start_of(v));
    if (v.kind == VariableKind::derivative) {
      type += attribute("derivative", std::to_string(place_of(state_behind(v))));
    }
    line(3, type + "/>");
    line(2, "</ScalarVariable>");
  }

  void variable3(const Variable& v) {
    std::string text = is_text(v) ? "<String" : v.is_status() ? "<Enumeration" : is_whole(v) ? "<Int32" : "<Float64";
    text += attribute("name", v.name) + attribute("valueReference", std::to_string(v.reference())) +
            attribute("description", v.description) + attribute("causality", v.causality) +
            attribute("variability", v.variability);
    if (!v.initial.empty() && v.causality != "independent") text += attribute("initial", v.initial);
    if (v.is_status()) text += attribute("declaredType", status_type);
    text += unit_of(v);
    if (!is_text(v)) text += bounds(v);
    if (v.kind == VariableKind::state) text += of_state(v);
    if (v.kind == VariableKind::derivative) text += attribute("derivative", std::to_string(state_behind(v)));
    if (is_text(v)) {
      line(2, text + ">");
      line(3, "<Start" + attribute("value", start_of(v)) + "/>");
      line(2, "</String>");
      return;
    }
    if (has_start(v)) text += attribute("start", start_of(v));
    line(2, text + "/>");
  }

  /// In the list of variables, from 1: FMI 2 counts so.
  std::size_t place_of(std::size_t reference) const {
    for (std::size_t n = 0; n < variables_.size(); ++n) {
      if (variables_[n].reference() == reference) return n + 1;
    }
    return 0;
  }

  std::string with_dependencies(const char* element, const Variable& v, const std::vector<std::size_t>& known) const {
    std::string on, kinds;
    for (const std::size_t reference : known) {
      if (!on.empty()) on += ' ';
      on += std::to_string(is3() ? reference : place_of(reference));
      kinds += kinds.empty() ? "dependent" : " dependent";
    }
    std::string text = std::string("<") + element +
                       (is3() ? attribute("valueReference", std::to_string(v.reference()))
                              : attribute("index", std::to_string(place_of(v.reference())))) +
                       attribute("dependencies", on);
    if (!kinds.empty()) text += attribute("dependenciesKind", kinds);
    return text + "/>";
  }
  std::string unknown(const char* element, const Variable& v) const {
    return with_dependencies(element, v, dependencies_of(design_, v.reference()));
  }
  /// At the start everything follows from parameters and from the inputs that it depends on.
  std::string initial_unknown(const char* element, const Variable& v) const {
    std::vector<std::size_t> known;
    for (const std::size_t reference : dependencies_of(design_, v.reference())) {
      if (kind_of(reference) == VariableKind::input) known.push_back(reference);
    }
    for (const Variable& p : variables_) {
      if (p.causality == "parameter") known.push_back(p.reference());
    }
    return with_dependencies(element, v, known);
  }

  template <class Use>
  void for_each(bool (*wanted)(const Variable&), const Use& use) const {
    for (const Variable& v : variables_) {
      if (wanted(v)) use(v);
    }
  }

  void structure() {
    const auto is_output = [](const Variable& v) { return v.causality == "output"; };
    const auto is_derivative = [](const Variable& v) { return v.kind == VariableKind::derivative; };
    const auto starts_calculated = [](const Variable& v) {
      return v.causality == "output" || v.kind == VariableKind::state || v.kind == VariableKind::derivative;
    };
    line(1, "<ModelStructure>");
    if (!is3()) {
      line(2, "<Outputs>");
      for_each(is_output, [&](const Variable& v) { line(3, unknown("Unknown", v)); });
      line(2, "</Outputs>");
      line(2, "<Derivatives>");
      for_each(is_derivative, [&](const Variable& v) { line(3, unknown("Unknown", v)); });
      line(2, "</Derivatives>");
      line(2, "<InitialUnknowns>");
      for_each(starts_calculated, [&](const Variable& v) { line(3, initial_unknown("Unknown", v)); });
      line(2, "</InitialUnknowns>");
    } else {
      for_each(is_output, [&](const Variable& v) { line(2, unknown("Output", v)); });
      for_each(is_derivative, [&](const Variable& v) { line(2, unknown("ContinuousStateDerivative", v)); });
      for_each(starts_calculated, [&](const Variable& v) { line(2, initial_unknown("InitialUnknown", v)); });
      for_each([](const Variable& v) { return v.kind == VariableKind::indicator; },
               [&](const Variable& v) {
                 line(2, "<EventIndicator" + attribute("valueReference", std::to_string(v.reference())) + "/>");
               });
    }
    line(1, "</ModelStructure>");
  }

  const Design<double>& design_;
  std::string token_;
  FmuOptions options_;
  Instance instance_;
  StateLayout layout_;
  std::vector<Variable> variables_;
  std::string text_;
};

}  // namespace

std::string model_description(const Design<double>& design, const std::string& token, const FmuOptions& options) {
  return Writer(design, token, options).all();
}

}  // namespace wingbeat::fmu
