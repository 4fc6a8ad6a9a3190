#include "wingbeat/files/design_keys.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat {
namespace {

const std::string reference_file = std::string(WINGBEAT_DATA) + "/../docs/vehicle-file.md";

TEST(DesignKeys, ReferenceIsTheKeyTable) {
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
  for (const auto& key : vehicle_keys<double>()) EXPECT_THAT(text, testing::HasSubstr("| `" + std::string(key.path)));
}

TEST(DesignKeys, TableIsConsistent) {
  std::set<std::string_view> paths;
  for (const auto& key : vehicle_keys<double>()) {
    EXPECT_TRUE(paths.insert(key.path).second) << key.path;
    EXPECT_FALSE(key.range.empty() || key.fallback.empty() || key.meaning.empty()) << key.path;
    EXPECT_EQ(key.unit.empty(), key.text != nullptr) << key.path;
    EXPECT_EQ(key.unit.empty(), key.set == nullptr && key.get == nullptr) << key.path;
    if (!key.unit.empty()) {
      EXPECT_EQ(unit_factor(key.unit, key.unit), 1.0) << key.path;
      EXPECT_THAT(quantity_example(key.unit), testing::HasSubstr(" such as ")) << key.path;
    }
  }
}

TEST(DesignKeys, WhatIsSetIsRead) {
  for (const auto& key : vehicle_keys<double>()) {
    if (!key.set) continue;
    Design<double> d{};
    for (const SupplyType supply : {SupplyType::constant, SupplyType::sine, SupplyType::pwm, SupplyType::battery}) {
      d.supply.type = supply;
      if (key.set(d, 0.25)) break;
    }
    if (!key.get(d)) d.transmission.type = TransmissionType::direct;
    if (!key.get(d)) key.set(d, 0.25);
    if (!key.get(d)) d.motor.gear_ratio = 4.0;
    if (!key.get(d) && key.only_with == "vehicle.mass") {
      d.transmission.type = TransmissionType::slider_crank;
      d.mass = 1e-3;
      d.spring.stiffness = 1e-3;
      key.set(d, 0.25);
    }
    for (const auto& [name, shape] : names_of<PlanformShape>) {
      if (key.get(d)) break;
      d.wing.planform.shape = shape;
      if (key.set(d, 0.25)) break;
    }
    ASSERT_TRUE(key.set(d, 0.25)) << key.path;
    EXPECT_EQ(key.get(d), std::optional(0.25)) << key.path;
  }
}

TEST(DesignKeys, AlternativesReplaceEachOther) {
  Design<double> d{};
  set_parameter(d, "transmission.hinge_offset", 0.006);
  set_parameter(d, "transmission.stroke_amplitude", 0.7);
  EXPECT_FALSE(d.transmission.hinge_offset);
  set_parameter(d, "spring.stiffness", 1e-3);
  set_parameter(d, "spring.resonance", 22.0);
  EXPECT_FALSE(d.spring.stiffness);
  d.supply.type = SupplyType::battery;
  d.supply.battery.discharge_curve = {{0.0, 3.0}, {1.0, 4.2}};
  EXPECT_EQ(find_key<double>("supply.cell_voltage")->get(d), std::nullopt);
  set_parameter(d, "supply.cell_voltage", 3.7);
  EXPECT_TRUE(d.supply.battery.discharge_curve.empty());
  d.transmission.type = TransmissionType::direct;
  set_parameter(d, "spring.resonance_ratio", 1.0);
  EXPECT_FALSE(d.spring.resonance);
  d.supply.type = SupplyType::sine;
  set_parameter(d, "supply.resonance_ratio", 1.0);
  EXPECT_FALSE(find_key<double>("supply.frequency")->get(d));
  set_parameter(d, "supply.frequency", 22.0);
  EXPECT_FALSE(d.supply_resonance_ratio);
  set_parameter(d, "wing.resonance", 22.0);
  EXPECT_FALSE(find_key<double>("wing.inertia")->get(d));
  set_parameter(d, "wing.inertia", 1e-7);
  EXPECT_FALSE(d.wing.resonance);
  d.wing.planform.shape = PlanformShape::rectangle;
  set_parameter(d, "wing.planform.chord_ratio", 0.3);
  EXPECT_FALSE(find_key<double>("wing.planform.root_chord")->get(d));
  set_parameter(d, "wing.planform.root_chord", 0.02);
  EXPECT_FALSE(d.wing.planform.chord_ratio);
  set_parameter(d, "friction.damping", 1e-6);
  EXPECT_EQ(d.friction.law, FrictionLaw::viscous);
  EXPECT_EQ(find_key<double>("friction.radius")->get(d), std::nullopt);
  d.aerodynamics.coefficients = translational_2022();
  set_parameter(d, "aerodynamics.coefficients.lift.offset", 0.3);
  EXPECT_EQ(d.aerodynamics.coefficients_name, "custom");
}

TEST(DesignKeys, JetsCarryDerivatives) {
  Design<Jet<2>> d{};
  set_parameter(d, "motor.inertia", Jet<2>(1.5e-7, 1));
  EXPECT_EQ(d.motor.constants.inertia.a, 1.5e-7);
  EXPECT_EQ(d.motor.constants.inertia.v[1], 1.0);
}

template <class F>
std::string refusal(const F& f) {
  try {
    f();
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DesignKeys, RefusesKeysWithoutAPlace) {
  Design<double> d{};
  EXPECT_EQ(refusal([&] { set_parameter(d, "supply.duty", 0.5); }), "supply.duty: only with supply.type = pwm");
  EXPECT_EQ(refusal([&] { set_parameter(d, "friction.type", 0.5); }), "friction.type: is not a number");
  EXPECT_EQ(refusal([&] { set_parameter(d, "motor.inerta", 0.5); }),
            "motor.inerta: unknown key; did you mean motor.inertia?");
}

TEST(DesignKeys, NearestKey) {
  EXPECT_EQ(unknown_key_message("motor.torque_constan"), "unknown key; did you mean motor.torque_constant?");
  EXPECT_EQ(unknown_key_message("motr"), "unknown key; did you mean [motor]?");
  EXPECT_EQ(unknown_key_message("voltage"), "unknown key; did you mean supply.voltage?");
  EXPECT_EQ(unknown_key_message("spring.damper"),
            "unknown key; [spring] knows stiffness, resonance, resonance_ratio, mass");
  EXPECT_EQ(unknown_key_message("battery"),
            "unknown key; the sections are [vehicle], [supply], [motor], [transmission], [friction], [spring], [wing], "
            "[aerodynamics], [bench]");
}

}  // namespace
}  // namespace wingbeat
