#include "wingbeat/report/reference.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

const std::string reference_file = std::string(WINGBEAT_DATA) + "/../docs/vehicle-file.md";

TEST(Reference, IsTheParameterTable) {
  const std::string begin = "rewrites it -->\n", end = "<!-- end of the generated part -->";
  std::string text = read_text_file(reference_file);
  const auto from = text.find(begin) + begin.size(), to = text.find(end);
  ASSERT_TRUE(to != std::string::npos && from < to);
  const std::string wanted = vehicle_file_reference() + "\n";
  if (std::getenv("WINGBEAT_UPDATE_DOCS")) {
    text.replace(from, to - from, wanted);
    std::ofstream(reference_file, std::ios::binary) << text;
    return;
  }
  EXPECT_EQ(text.substr(from, to - from), wanted) << "run test_io with WINGBEAT_UPDATE_DOCS=1";
  for (const auto& key : parameter_table<double>())
    EXPECT_THAT(text, testing::HasSubstr("| `" + std::string(key.path)));
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
