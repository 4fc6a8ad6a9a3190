// wingbeat export-fmu VEHICLE: the vehicle for other simulators.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "command.hpp"
#include "options.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/files/zip_file.hpp"
#include "wingbeat/fmu/fmu.hpp"
#include "wingbeat/report/plot.hpp"
#include "wingbeat/run/module_file.hpp"

namespace wingbeat::app {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  std::string vehicle, output, version = "2", kind = "both";
  std::vector<std::string> overrides;
  bool sources = false, without_body = false, force = false;
};

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (in.bad() || bytes.empty()) throw std::runtime_error(file.string() + ": cannot be read");
  return bytes;
}

fs::path required_file(const std::string& name, const char* what) {
  fs::path file = module_file(name);
  if (file.empty()) {
    throw std::runtime_error(fmt::format(
        "{}, {}, is not installed (in a checkout: cmake --build --preset release --target wingbeat_modules)", name,
        what));
  }
  return file;
}

/// A drawing of the mechanism; empty where gnuplot is not installed.
std::string icon_of(const Design<double>& design) {
  try {
    return drawn_mechanism(design, 1.0, PlotFormat::png);
  } catch (const std::runtime_error&) {
    return {};
  }
}

int run(const ExportArguments& arguments) {
  fmu::FmuOptions options;
  options.version = choice_of<fmu::FmiVersion>("--fmi", arguments.version);
  options.kind = choice_of<fmu::FmuKind>("--kind", arguments.kind);
  options.program_version = version;
  options.sources = arguments.sources;
  options.identifier = fmu::identifier_of(fs::path(arguments.output).stem().string());
  Design<double> design = read_design(arguments.vehicle, arguments.overrides);
  if (arguments.without_body) design.body = {};
  OutputFile output("-o", arguments.output, OutputRules{".fmu", arguments.force});
  const fmu::FmuContent content = fmu::fmu_content(design, options);
  const fs::path linux_binary = required_file("wingbeat-fmu.so", "the binary of all FMUs");
  const fs::path windows_binary = module_file("wingbeat-fmu.dll");

  const bool second = options.version == fmu::FmiVersion::fmi2;
  std::vector<std::pair<std::string, std::string>> files = {
      {"modelDescription.xml", content.description},
      {"resources/vehicle.bin", content.resource},
      {"documentation/index.html", content.documentation},
      {fmt::format("{}/{}.so", content.linux_folder, options.identifier), bytes_of(linux_binary)}};
  if (!windows_binary.empty()) {
    files.emplace_back(fmt::format("{}/{}.dll", content.windows_folder, options.identifier), bytes_of(windows_binary));
  }
  if (std::string icon = icon_of(design); !icon.empty()) {
    files.emplace_back(second ? "model.png" : "terminalsAndIcons/icon.png", std::move(icon));
  }
  if (arguments.sources) {
    const fs::path bundle = required_file("wingbeat-fmu-sources.zip", "the sources of FMUs");
    for (auto& [name, bytes] : read_zip(bundle)) files.emplace_back("sources/" + name, std::move(bytes));
    files.emplace_back("sources/fmu.cpp", content.source);
    if (!second) files.emplace_back("sources/buildDescription.xml", content.build_description);
  }
  write_zip(output.temporary(), files);
  output.commit();
  print(fmt::format("{}: FMI {}, {}, {}{}\n", arguments.output, second ? "2.0" : "3.0",
                    options.kind == fmu::FmuKind::both             ? "model exchange and co-simulation"
                    : options.kind == fmu::FmuKind::model_exchange ? "model exchange"
                                                                   : "co-simulation",
                    windows_binary.empty() ? "Linux" : "Linux and Windows", arguments.sources ? ", sources" : ""));
  return done;
}

}  // namespace

void add_export_fmu(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("export-fmu", "Write the vehicle as an FMU, for other simulators");
  const auto a = std::make_shared<ExportArguments>();
  add_input(command, a->vehicle, InputKind::vehicle, "vehicle", "Vehicle file (TOML)", "VEHICLE");
  add_set(command, a->overrides);
  add_file(command, "-o,--output", a->output, ".fmu", "The FMU", "FILE.fmu")->required();
  add_choice<fmu::FmiVersion>(command, "--fmi", a->version, "Version of the standard: 2 (default) or 3", "VERSION");
  add_choice<fmu::FmuKind>(command, "--kind", a->kind, "me (model exchange), cs (co-simulation) or both (default)",
                           "KIND");
  command->add_flag("--sources", a->sources, "The sources too, which gcc compiles by itself");
  command->add_flag("--without-body", a->without_body, "The drive alone, its wings on a body at rest");
  add_force(*command, a->force);
  command->footer(
      "Example:\n  wingbeat export-fmu friction2022 -o flapper.fmu --fmi 3\n\n"
      "Inputs, outputs, parameters and events: docs/fmu.md.\n\n"
      "Exit status: 0 done, 2 bad input or usage, 1 anything else.");
  command->callback([a, &action] {
    action = [a] {
      a->vehicle = find_input(a->vehicle, InputKind::vehicle).string();
      return run(*a);
    };
  });
}

}  // namespace wingbeat::app
