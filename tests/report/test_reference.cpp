#include "wingbeat/report/reference.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>

#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

/// What stands between the marks of a generated part must be what is wanted; WINGBEAT_UPDATE_DOCS puts it there.
/// Returns the page.
std::string page_with(const std::string& name, std::string wanted) {
  const std::string file = std::string(WINGBEAT_DATA) + "/../docs/" + name;
  const std::string begin = "rewrites it -->\n", end = "<!-- end of the generated part -->";
  std::string text = read_text_file(file);
  const auto from = text.find(begin) + begin.size(), to = text.find(end);
  wanted += "\n";
  if (to == std::string::npos || from >= to) {
    ADD_FAILURE() << name << " has no generated part";
  } else if (std::getenv("WINGBEAT_UPDATE_DOCS")) {
    text.replace(from, to - from, wanted);
    std::ofstream(file, std::ios::binary) << text;
  } else {
    EXPECT_EQ(text.substr(from, to - from), wanted) << "run test_report with WINGBEAT_UPDATE_DOCS=1";
  }
  return text;
}

TEST(Reference, IsTheParameterTable) {
  const std::string text = page_with("vehicle-file.md", vehicle_file_reference());
  for (const auto& key : parameter_table<double>())
    EXPECT_THAT(text, testing::HasSubstr("| `" + std::string(key.path)));
}

TEST(Reference, DefinesEveryMetric) {
  const std::string text = page_with("metrics.md", metric_reference());
  // In the order of the table, each once.
  auto position = text.find("| key |");
  for (const MetricInfo& metric : metric_table()) {
    const std::string row = "\n| `" + std::string(metric.key) + "` |";
    const auto found = text.find(row, position);
    ASSERT_NE(found, std::string::npos) << metric.key;
    EXPECT_EQ(text.find(row, found + 1), std::string::npos) << metric.key;
    position = found;
  }
}

TEST(Reference, KnowsEveryUnit) {
  for (const auto& key : parameter_table<double>()) {
    if (key.unit.empty()) continue;
    EXPECT_EQ(unit_factor(key.unit, key.unit), 1.0) << key.path;
    EXPECT_THAT(quantity_example(key.unit), testing::HasSubstr(" such as ")) << key.path;
  }
}

TEST(Reference, ANewVehicleOfEveryTransmissionIsComplete) {
  for (const auto& [name, transmission] : names_of<TransmissionType>) {
    const Design<double> d = parse_design(starting_vehicle(transmission, "new"), name);
    EXPECT_EQ(d.transmission.type, transmission);
    EXPECT_NO_THROW(validate(d)) << name;
    EXPECT_EQ(d.motor.constants.inertia, 1.5e-7) << name;
  }
}

}  // namespace
}  // namespace wingbeat
