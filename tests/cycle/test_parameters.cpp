#include "wingbeat/vehicle/parameters.hpp"

#include <gmock/gmock.h>

#include <set>

#include "wingbeat/cycle/orbit_gradient.hpp"

namespace wingbeat {
namespace {

TEST(Parameters, TableIsConsistent) {
  std::set<std::string_view> paths;
  for (const auto& parameter : parameter_table<double>()) {
    const std::string_view path = parameter.path;
    EXPECT_TRUE(paths.insert(path).second) << path;
    EXPECT_FALSE(parameter.range.text.empty() || parameter.fallback.empty() || parameter.meaning.empty()) << path;
    EXPECT_EQ(parameter.unit.empty(), parameter.text != nullptr) << path;
    EXPECT_EQ(parameter.unit.empty(), parameter.set == nullptr && parameter.get == nullptr) << path;
    EXPECT_EQ(parameter.unit.empty(), std::string_view(parameter.range.expected).empty()) << path;
    for (const std::string& other : alternatives_of(parameter)) {
      EXPECT_TRUE(find_parameter<double>(other) || is_section(other)) << other;
      EXPECT_TRUE(are_alternatives(other, path)) << path << " and " << other;
      const Parameter<double>* found = find_parameter<double>(other);
      if (!found) continue;
      const std::vector<std::string> back = alternatives_of(*found);
      EXPECT_THAT(back, testing::Contains(std::string(path))) << other << " does not name it in turn";
    }
  }
}

/// A table of loads.
std::shared_ptr<const LoadTable> two_rows() {
  LoadTable::Row rest{}, fast{};
  fast[1] = fast[4] = fast[5] = 1.0;
  return std::make_shared<LoadTable>(std::vector{rest, fast});
}

/// Designs of every kind: each parameter has a place in one of them.
std::vector<Design<double>> designs_of_every_kind() {
  std::vector<Design<double>> designs;
  for (const auto& [supply_name, supply] : names_of<SupplyType>) {
    for (const auto& [transmission_name, transmission] : names_of<TransmissionType>) {
      for (const auto& [shape_name, shape] : names_of<PlanformShape>) {
        Design<double> d{};
        d.supply.type = supply;
        d.transmission.type = transmission;
        d.wing.planform.shape = shape;
        d.mass = 1e-3;
        d.motor.gear_ratio = 4.0;
        d.motor.thermal.resistance_winding = 20.0;
        d.spring.stiffness = 1e-3;
        d.wing.areal_density = 0.02;
        d.aerodynamics.induced_velocity = 0.5;
        d.aerodynamics.clap.amplitude = 0.3;
        d.body.inertia_pitch = 1e-6, d.body.wing_mass = 1e-5, d.body.tail.area = d.body.fin.area = 1e-4;
        if (transmission == TransmissionType::direct) d.pitch.stiffness = 3e-4;
        designs.push_back(d);
        Design<double> tabulated = d;
        tabulated.aerodynamics.load_table = two_rows();
        designs.push_back(tabulated);
        Design<double> further = d;
        further.wing.torsion.stiffness = 1e-3;
        if (transmission == TransmissionType::direct) further.piezo.force_per_volt = 1e-3;
        else further.electronics.efficiency = 0.9;
        designs.push_back(further);
      }
    }
  }
  return designs;
}

/// The numbers of a design in the order of its members.
std::vector<std::optional<double>> numbers_of(const Design<double>& d) {
  std::vector<std::optional<double>> numbers;
  for_each_number(d, [&](const auto& x) { numbers.push_back(x); });
  return numbers;
}

TEST(Parameters, EveryNumberOfADesignHasARow) {
  constexpr double mark = 0.618;
  std::vector<std::string_view> row_of(std::size_t(number_count<Design<double>>));
  for (const Design<double>& before : designs_of_every_kind()) {
    for (const auto& parameter : parameter_table<double>()) {
      Design<double> after = before;
      if (!parameter.set || !parameter.set(after, mark)) continue;
      const auto numbers = numbers_of(after), were = numbers_of(before);
      for (std::size_t n = 0; n < numbers.size(); ++n) {
        if (numbers[n] == mark && were[n] != mark) row_of[n] = parameter.path;
      }
    }
  }
  for (std::size_t n = 0; n < row_of.size(); ++n) {
    EXPECT_FALSE(row_of[n].empty()) << "number " << n << " of Design has no row in the parameter table; it follows "
                                    << (n > 0 ? row_of[n - 1] : "none");
  }
}

TEST(Parameters, EveryNumberHasAPlaceAndIsReadAsSet) {
  for (const auto& parameter : parameter_table<double>()) {
    if (!parameter.set) continue;
    bool has_place = false;
    for (Design<double> d : designs_of_every_kind()) {
      if (!parameter.set(d, 0.25)) continue;
      has_place = true;
      EXPECT_EQ(parameter.get(d), std::optional(0.25)) << parameter.path;
    }
    EXPECT_TRUE(has_place) << parameter.path;
  }
}

TEST(Parameters, RangesSayWhatTheyHold) {
  EXPECT_TRUE(range::positive.holds(1e-300) && !range::positive.holds(0.0) && !range::positive.holds(NAN));
  EXPECT_TRUE(range::not_negative.holds(0.0) && !range::not_negative.holds(-1e-300));
  EXPECT_TRUE(range::zero_to_one.holds(1.0) && !range::zero_to_one.holds(1.0 + 1e-15));
  EXPECT_TRUE(range::acute.holds(1.5) && !range::acute.holds(0.5 * pi) && !range::acute.holds(0.0));
  EXPECT_TRUE(range::zero_to_acute.holds(0.0) && !range::zero_to_acute.holds(0.5 * pi));
  EXPECT_TRUE(range::count.holds(2.0) && !range::count.holds(2.5) && !range::count.holds(0.0));
  EXPECT_TRUE(range::any.holds(-1e300));
}

TEST(Parameters, PlacesAreNamedAsTheirChoices) {
  EXPECT_EQ(find_parameter<double>("supply.frequency")->only_with, "supply.type = sine|pwm|battery-sine");
  EXPECT_EQ(find_parameter<double>("friction.radius")->only_with, "friction.type = load-proportional");
  EXPECT_EQ(find_parameter<double>("friction.type")->range.text,
            "none, load-proportional, viscous, quadratic or constant");
  for (const auto& parameter : parameter_table<double>()) {
    if (parameter.only_with.empty()) continue;
    const Requirement requirement = requirement_of(parameter.only_with);
    const Parameter<double>* choice = find_parameter<double>(requirement.path);
    ASSERT_TRUE(choice) << parameter.path;
    for (const std::string_view value : requirement.values) {
      EXPECT_THAT(std::string(choice->range.text), testing::HasSubstr(std::string(value))) << parameter.path;
    }
  }
}

TEST(Parameters, AlternativesReplaceEachOther) {
  Design<double> d{};
  set_parameter(d, "transmission.hinge_offset", 0.006);
  set_parameter(d, "transmission.stroke_amplitude", 0.7);
  EXPECT_FALSE(d.transmission.hinge_offset);
  set_parameter(d, "spring.stiffness", 1e-3);
  set_parameter(d, "spring.resonance", 22.0);
  EXPECT_FALSE(d.spring.stiffness);
  d.supply.type = SupplyType::battery;
  d.supply.battery.discharge_curve = {{0.0, 3.0}, {1.0, 4.2}};
  EXPECT_EQ(find_parameter<double>("supply.cell_voltage")->get(d), std::nullopt);
  set_parameter(d, "supply.cell_voltage", 3.7);
  EXPECT_TRUE(d.supply.battery.discharge_curve.empty());
  d.transmission.type = TransmissionType::direct;
  set_parameter(d, "spring.resonance_ratio", 1.0);
  EXPECT_FALSE(d.spring.resonance);
  d.supply.type = SupplyType::sine;
  set_parameter(d, "supply.resonance_ratio", 1.0);
  EXPECT_FALSE(find_parameter<double>("supply.frequency")->get(d));
  set_parameter(d, "supply.frequency", 22.0);
  EXPECT_FALSE(d.supply_resonance_ratio);
  set_parameter(d, "wing.resonance", 22.0);
  EXPECT_FALSE(find_parameter<double>("wing.inertia")->get(d));
  set_parameter(d, "wing.inertia", 1e-7);
  EXPECT_FALSE(d.wing.resonance);
  d.wing.planform.shape = PlanformShape::rectangle;
  set_parameter(d, "wing.planform.chord_ratio", 0.3);
  EXPECT_FALSE(find_parameter<double>("wing.planform.root_chord")->get(d));
  set_parameter(d, "wing.planform.root_chord", 0.02);
  EXPECT_FALSE(d.wing.planform.chord_ratio);
  set_parameter(d, "friction.damping", 1e-6);
  EXPECT_EQ(d.friction.law, FrictionLaw::viscous);
  EXPECT_EQ(find_parameter<double>("friction.radius")->get(d), std::nullopt);
  d.aerodynamics.coefficients = translational_2022();
  set_parameter(d, "aerodynamics.coefficients.lift.offset", 0.3);
  EXPECT_EQ(d.aerodynamics.coefficients_name, "custom");
}

TEST(Parameters, JetsCarryDerivatives) {
  Design<GradientJet> d = cast<GradientJet>(Design<double>());
  set_parameter(d, "motor.inertia", GradientJet(1.5e-7, 1));
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

TEST(Parameters, RefusesWhatHasNoPlace) {
  Design<double> d{};
  EXPECT_EQ(refusal([&] { set_parameter(d, "supply.duty", 0.5); }),
            "supply.duty: only with supply.type = pwm or battery");
  EXPECT_EQ(refusal([&] { set_parameter(d, "friction.type", 0.5); }), "friction.type: is not a number");
  EXPECT_EQ(refusal([&] { set_parameter(d, "motor.inerta", 0.5); }),
            "motor.inerta: unknown key; did you mean motor.inertia?");
}

TEST(Parameters, NearestKey) {
  EXPECT_EQ(unknown_key_message("motor.torque_constan"), "unknown key; did you mean motor.torque_constant?");
  EXPECT_EQ(unknown_key_message("motr"), "unknown key; did you mean [motor]?");
  EXPECT_EQ(unknown_key_message("voltage"), "unknown key; did you mean supply.voltage?");
  EXPECT_EQ(unknown_key_message("spring.damper"),
            "unknown key; [spring] knows stiffness, resonance, resonance_ratio, rest_angle, mass");
  EXPECT_EQ(unknown_key_message("battery"),
            "unknown key; the sections are [vehicle], [supply], [motor], [electronics], [piezo], [transmission], "
            "[friction], [spring], [wing], [pitch], [aerodynamics], [bench], [body]");
}

}  // namespace
}  // namespace wingbeat
