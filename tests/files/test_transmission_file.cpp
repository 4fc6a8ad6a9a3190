// Vehicle files of four-bars and tabulated stroke laws: what is read, written back and refused with file, line and key.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/report/reference.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

using Overrides = std::vector<std::string>;

std::string file_of(TransmissionType type) { return starting_vehicle(type, "v"); }

std::string refusal(const std::string& text, const Overrides& overrides) {
  try {
    parse_design(text, "v.toml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(TransmissionFile, FourBarIsReadAndWrittenBack) {
  const Overrides more = {"transmission.stroke_ratio=2", "transmission.ground_angle=100 deg"};
  const Design<double> d = parse_design(file_of(TransmissionType::four_bar), "v.toml", more);
  EXPECT_EQ(d.transmission.type, TransmissionType::four_bar);
  EXPECT_EQ(d.transmission.stroke_ratio, 2.0);
  const FourBar<double> bars = resolve(d).transmission.four_bar;
  EXPECT_EQ(bars.coupler_length, 20e-3);
  EXPECT_NEAR(bars.ground_angle, 100.0 / degrees_per_radian, 1e-15);
  EXPECT_EQ(write_design(parse_design(write_design(d), "w.toml")), write_design(d));
}

TEST(TransmissionFile, WhatTheFourBarIsNotGivenFollows) {
  const Design<double> d = parse_design(file_of(TransmissionType::four_bar), "v.toml");
  const FourBar<double> bars = resolve(d).transmission.four_bar;
  EXPECT_EQ(bars.stroke_ratio, 1.0);
  EXPECT_EQ(bars.ground_angle, centred_ground_angle(bars));
}

TEST(TransmissionFile, RodMassIsTheCouplers) {
  const Overrides mass = {"vehicle.mass=3 g", "transmission.rod_linear_density=5 g/m"};
  const Design<double> d = parse_design(file_of(TransmissionType::four_bar), "v.toml", mass);
  EXPECT_NEAR(*total_mass(d), 3.1e-3, 1e-15);
  EXPECT_EQ(
      refusal(file_of(TransmissionType::tabulated), {"vehicle.mass=3 g", "transmission.rod_linear_density=5 g/m"}),
      "--set transmission.rod_linear_density=5 g/m: transmission.rod_linear_density: a tabulated transmission has "
      "no rod");
}

TEST(TransmissionFile, TableIsReadFromAFileBesideTheVehicleAndWrittenBack) {
  const auto folder = std::filesystem::temp_directory_path() / "wingbeat-test-stroke-table";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "law.csv") << "crank_angle_deg,stroke_angle_deg\n0,0\n90,40\n180,0\n270,-40\n";
  std::ofstream(folder / "v.toml") << file_of(TransmissionType::tabulated);
  const Overrides named = {"transmission.file=law.csv", "transmission.stroke_scale=0.5"};
  const Design<double> d = read_design(folder / "v.toml", named);
  const StrokeTable<double> table = resolve(d).transmission.tabulated;
  ASSERT_EQ(table.curve->rows().size(), 4u);
  EXPECT_NEAR(stroke_amplitude(table), 20.0 / degrees_per_radian, 1e-6);
  EXPECT_EQ(write_design(parse_design(write_design(d), "w.toml")), write_design(d));
  std::filesystem::remove_all(folder);
}

TEST(TransmissionFile, WhatCannotBeIsRefused) {
  const std::string bars = file_of(TransmissionType::four_bar), law = file_of(TransmissionType::tabulated);
  EXPECT_EQ(refusal(bars, {"transmission.crank_radius=8 mm"}),
            "--set transmission.crank_radius=8 mm: transmission.crank_radius: must be the shortest link, or the crank "
            "cannot turn (Grashof) [m], got 0.008 (8 mm)");
  EXPECT_EQ(
      refusal(bars, {"transmission.rod_length=20 mm"}),
      "--set transmission.rod_length=20 mm: transmission.rod_length: belongs to transmission.type = slider-crank, "
      "but transmission.type is \"four-bar\"");
  EXPECT_EQ(refusal(law, {"transmission.stroke_table=[[0, 0], [1, 1]]"}),
            "--set transmission.stroke_table=[[0, 0], [1, 1]]: transmission.stroke_table: needs at least four rows");
  EXPECT_EQ(refusal(law, {"transmission.stroke_table=7"}).substr(0, 71),
            "--set transmission.stroke_table=7: transmission.stroke_table: expected ");
}

}  // namespace
}  // namespace wingbeat
