// A wing stated by its drawing, as users meet it.
#include <gmock/gmock.h>

#include "program.hpp"

namespace cli {
namespace {

using testing::HasSubstr;

class DrawnWing : public Program {
 protected:
  /// A vehicle file whose section [wing] holds these lines in place of the inertia and the planform.
  std::string file_with(const std::string& lines) const {
    std::string text = read(plain);
    for (const char* key : {"\ninertia", "\nplanform"}) {
      const auto position = text.find(key, text.find("[wing]\n"));
      text.erase(position, text.find('\n', position + 1) - position);
    }
    text.insert(text.find("[wing]\n") + 7, lines);
    std::ofstream(path("drawn.toml")) << text;
    return path("drawn.toml");
  }

  const std::string outline = "planform = { shape = \"rectangle\", length = \"60 mm\", root_chord = \"20 mm\" }\n";
};

TEST_F(DrawnWing, RunsAsOneOfItsInertia) {
  const Json drawn =
      run({"run", file_with(outline + "areal_density = \"20 g/m2\"\nspar_density = \"1 g/m\"\n"), "--json"}).json();
  // (sigma c + lambda) R^3/3
  const Json stated = run({"run", file_with(outline + "inertia = 1.008e-7\n"), "--json"}).json();
  for (const char* key : {"frequency_hz", "lift_mean_n", "rod_force_peak_n", "power_electrical_w"}) {
    EXPECT_NEAR(drawn[key].get<double>() / stated[key].get<double>(), 1.0, 1e-9) << key;
  }
}

TEST_F(DrawnWing, RibsAreRods) {
  const std::string material = "areal_density = \"20 g/m2\"\nspar_density = \"1 g/m\"\n";
  const Json ribbed =
      run({"run", file_with(outline + material + "rib_density = \"0.5 g/m\"\nrib_count = 2\n"), "--json"}).json();
  // 0.5 g/m 20 mm ((20 mm)^2 + (40 mm)^2) more
  const Json stated = run({"run", file_with(outline + "inertia = 1.208e-7\n"), "--json"}).json();
  for (const char* key : {"frequency_hz", "lift_mean_n"}) {
    EXPECT_NEAR(ribbed[key].get<double>() / stated[key].get<double>(), 1.0, 1e-9) << key;
  }
}

TEST_F(DrawnWing, IsRefusedWhereItSaysTooMuchOrTooLittle) {
  const auto complaint = [&](const std::string& lines) {
    const Outcome o = run({"run", file_with(lines)});
    EXPECT_EQ(o.status, 2);
    return o.err;
  };
  EXPECT_THAT(complaint(outline + "inertia = 1e-7\nareal_density = \"20 g/m2\"\n"), HasSubstr("not both"));
  EXPECT_THAT(complaint(outline + "inertia = 1e-7\nspar_density = \"1 g/m\"\n"), HasSubstr("wing.areal_density"));
  EXPECT_THAT(complaint("areal_density = \"20 g/m2\"\nplanform = { shape = \"moments\", s2 = 2e-6, s3 = 1e-7 }\n"),
              HasSubstr("needs the wing's outline"));
}

}  // namespace
}  // namespace cli
