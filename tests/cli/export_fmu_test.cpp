// FMUs as the program writes them, run by the importers in C of examples/fmu. tests/fmu has the numbers and every
// function of the standard.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <regex>

#include "program.hpp"
#include "wingbeat/files/zip_file.hpp"

namespace {

using namespace cli;
using testing::HasSubstr;

class ExportFmu : public Program {
 protected:
  /// Unpacks vehicle.fmu and returns its description.
  std::string unpack() const {
    for (const auto& [name, bytes] : wingbeat::read_zip(path("vehicle.fmu"))) {
      const fs::path file = path("vehicle") + "/" + name;
      fs::create_directories(file.parent_path());
      std::ofstream(file, std::ios::binary) << bytes;
    }
    return read(path("vehicle") + "/modelDescription.xml");
  }

  /// What an importer prints, a number a line.
  std::vector<double> imported(const std::string& command) const {
    const std::string out = path("imported.txt");
    EXPECT_EQ(std::system((command + " > " + out).c_str()), 0) << command;
    std::ifstream in(out);
    return {std::istream_iterator<double>(in), {}};
  }
};

std::string found(const std::string& text, const std::string& pattern) {
  std::smatch match;
  EXPECT_TRUE(std::regex_search(text, match, std::regex(pattern))) << pattern;
  return match.empty() ? "" : match[1].str();
}

#ifdef FMU_IMPORTER  // a build with sanitizers makes no binary
TEST_F(ExportFmu, ImportersInCRunBothKinds) {
  for (const auto& [vehicle, version] : {std::pair{"friction2022", "2"}, {"direct-drive", "3"}, {"pitch-hinge", "2"}}) {
    // A file of its own is replaced.
    const Outcome made = run({"export-fmu", vehicle, "-o", path("vehicle.fmu"), "--fmi", version});
    ASSERT_EQ(made.status, 0) << made.err;
    EXPECT_THAT(made.out, HasSubstr(std::string("FMI ") + version + ".0, model exchange and co-simulation, Linux"));
    const std::string text = unpack();
    const bool second = version == std::string("2");
    const std::string inputs = path("vehicle") + (second ? "/binaries/linux64" : "/binaries/x86_64-linux") +
                               "/vehicle.so " + path("vehicle") + "/resources '" +
                               found(text, "(?:guid|instantiationToken)=\"([^\"]*)\"") + "' " + version + " ";
    const std::string references = found(text, "name=\"lift_mean\" valueReference=\"([0-9]+)\"") + " " +
                                   found(text, "name=\"frequency_mean\" valueReference=\"([0-9]+)\"");
    const std::string counts =
        std::to_string(count_of(text, " derivative=\"")) + " " +
        (second ? found(text, "numberOfEventIndicators=\"([0-9]+)\"") : std::to_string(count_of(text, "<EventIndic")));
    const auto co = imported(FMU_IMPORTER " " + inputs + "0.5 0.01 " + references);
    const auto me = imported(FMU_CVODE_IMPORTER " " + inputs + counts + " 0.5 1e-8 " + references);
    ASSERT_EQ(co.size(), 2u);
    ASSERT_EQ(me.size(), 3u);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_GT(co[k], 0.0) << vehicle;
      EXPECT_NEAR(me[k], co[k], 1e-5 * co[k]) << vehicle;
    }
    EXPECT_GT(me[2], co[0]) << "the peak of the lift";
    fs::remove_all(path("vehicle"));
  }
}
#endif

TEST_F(ExportFmu, RefusesWhatItCannotDo) {
  const auto says = [&](std::vector<std::string> arguments, const std::string& sentence) {
    arguments.insert(arguments.begin(), {"export-fmu", plain});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.err, "wingbeat: " + sentence + "\n");
  };
  says({}, "--output is required (see wingbeat export-fmu --help)");
  says({"-o", "vehicle.zip"}, "-o vehicle.zip: the name must end in .fmu");
  says({"-o", path("vehicle.fmu"), "--fmi", "1"}, "--fmi: must be 2 or 3, got \"1\"");
  says({"-o", path("vehicle.fmu"), "--kind", "se"}, "--kind: must be me, cs or both, got \"se\"");
  says({"-o", path("vehicle.fmu"), "--set", "motor.inertia=-1"},
       "--set motor.inertia=-1: motor.inertia: must be > 0 [kg m2], got -1");
  EXPECT_TRUE(files().empty());
  // What others wrote stays.
  const std::vector<std::pair<std::string, std::string>> other = {{"modelDescription.xml", "<fmiModelDescription/>"}};
  wingbeat::write_zip(path("other.fmu"), other);
  says({"-o", path("other.fmu")},
       "-o " + path("other.fmu") +
           ": exists and was not written by wingbeat; give another name, or --force to replace it");
  EXPECT_EQ(wingbeat::read_zip(path("other.fmu")), other);
}

}  // namespace
