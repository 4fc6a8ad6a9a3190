// A vehicle file to change in tests, and what became of it.
#pragma once

#include <gmock/gmock.h>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat::design_file_test {

using Overrides = std::vector<std::string>;

inline const std::filesystem::path designs = std::filesystem::path(WINGBEAT_DATA) / "designs";
inline const std::filesystem::path test_data = std::filesystem::path(WINGBEAT_DATA) / ".." / "tests" / "files" / "data";

// Line numbers count in the tests.
inline const std::string vehicle_text = R"([vehicle]
name = "test vehicle"
[supply]
type = "constant"
voltage = "3 V"
[motor]
armature_resistance = "9 ohm"
armature_inductance = "29 mH"
torque_constant = "0.01 N m/A"
inertia = "1.5e-7 kg m2"
viscous_damping = "3.6e-6 N m s/rad"
[transmission]
type = "slider-crank"
crank_radius = "5 mm"
rod_length = "20 mm"
hinge_offset = "6 mm"
formulation = "rod-force"
[friction]
type = "load-proportional"
radius = "2.5 mm"
[wing]
inertia = "7.205e-8 kg m2"
planform = { shape = "moments", s2 = "2.457e-6 m4", s3 = "1.048e-7 m5" }
[aerodynamics]
air_density = "1.225 kg/m3"
pitch_coefficient = "5e-3 s"
)";

/// The test vehicle with the first occurrence of one text replaced by another.
inline std::string with(const std::string& from, const std::string& to) {
  std::string text = vehicle_text;
  const auto position = text.find(from);
  EXPECT_NE(position, std::string::npos) << from;
  return text.replace(position, from.size(), to);
}

inline std::string without_line(const std::string& line) { return with(line + "\n", ""); }

inline std::string refusal(const std::string& text, const Overrides& overrides = {}, const TableLoader& load = {}) {
  try {
    parse_design(text, "v.toml", overrides, load);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

inline std::string override_refusal(const std::string& assignment) { return refusal(vehicle_text, {assignment}); }

/// Bits of every number and every text of a design.
inline std::map<std::string, std::string> fingerprint(const Design<double>& d) {
  std::map<std::string, std::string> result;
  const auto bits = [](double x) { return std::to_string(std::bit_cast<std::uint64_t>(x)); };
  for (const auto& key : parameter_table<double>()) {
    const std::string path(key.path);
    if (key.text) {
      result[path] = key.text(d);
    } else if (const auto x = key.get(d)) {
      result[path] = bits(*x);
    }
  }
  for (const auto& [x, chord] : d.wing.planform.chord_table) result["chords"] += bits(x) + " " + bits(chord) + " ";
  if (const auto& table = d.aerodynamics.coefficients.table) {
    for (const auto* column : {&table->alpha(), &table->lift(), &table->drag()}) {
      for (const double x : *column) result["table"] += bits(x) + " ";
    }
  }
  result["coefficients_name"] = d.aerodynamics.coefficients_name;
  return result;
}

inline constexpr const char* battery_supply =
    "\"battery\"\ncapacity = \"50 mA h\"\ninternal_resistance = \"0.8 ohm\"\n"
    "discharge_curve = [[0, \"3 V\"], [0.5, 3.7], [1, \"4200 mV\"]]";

}  // namespace wingbeat::design_file_test
