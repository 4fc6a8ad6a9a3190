#include "wingbeat/reproduction/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "report/result_schemas.hpp"
#include "report/schema_tools.hpp"
#include "reproduction/claim_schemas.hpp"
#include "run/sweep_schema.hpp"

namespace wingbeat {
namespace {

using detail::Json;

Json optimise_schema() {
  return schema::either(
      {schema::with_text(described::optimum_schema(), "one objective"),
       schema::with_text(described::motors_schema(), "one objective, a catalogue of motors or choices"),
       schema::with_text(described::drive_trains_schema(), "one objective, lists of gearboxes or batteries"),
       schema::with_text(described::front_schema(), "several objectives")});
}

Json run_schema() {
  return schema::either({schema::with_text(described::run_schema(), "both sides alike"),
                         schema::with_text(described::two_sides_schema(), "sides that differ")});
}
Json linearise_schema() {
  return schema::either({schema::with_text(described::control_schema(), "both sides alike"),
                         schema::with_text(described::two_sides_maps_schema(), "sides that differ")});
}

Json tolerance_schema() {
  return schema::either({schema::with_text(described::tolerance_schema(), "metrics of a cycle"),
                         schema::with_text(described::flight_tolerance_schema(), "with --flight")});
}

constexpr std::array<std::pair<std::string_view, Json (*)()>, 21> schemas = {
    {{"run", run_schema},
     {"compare", described::comparison_schema},
     {"sweep", described::sweep_schema},
     {"identify-motor", described::identification_schema},
     {"read-bench", described::readings_schema},
     {"fit", described::fit_schema},
     {"tolerance", tolerance_schema},
     {"optimise", optimise_schema},
     {"endurance", described::endurance_schema},
     {"linearise", linearise_schema},
     {"reproduce", described::claims_schema},
     {"scale", described::scaling_schema},
     {"synthesise", described::synthesis_schema},
     {"validate", described::validation_schema},
     {"export-kinematics", described::kinematics_schema},
     {"compare-loads", described::loads_schema},
     {"trim", described::trim_schema},
     {"stability", described::stability_schema},
     {"fly", described::fly_schema},
     {"keys", described::keys_schema},
     {"metrics", described::metrics_schema}}};

}  // namespace

const std::vector<std::string_view>& schema_commands() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const auto& [name, schema] : schemas) all.push_back(name);
    return all;
  }();
  return names;
}

std::string json_schema(std::string_view command) {
  const auto* found = std::find_if(schemas.begin(), schemas.end(), [&](const auto& s) { return s.first == command; });
  if (found == schemas.end()) return "";
  Json json;
  json["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  json["title"] = fmt::format("wingbeat {} --json", command);
  json.update(found->second());
  return json.dump(2) + "\n";
}

}  // namespace wingbeat
