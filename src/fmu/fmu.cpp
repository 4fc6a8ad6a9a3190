#include "wingbeat/fmu/fmu.hpp"

#include <cctype>

#include "fmu/binary/fmi2_functions.h"
#include "fmu/binary/fmi3_functions.h"
#include "fmu/body_in_time.hpp"
#include "fmu/description.hpp"
#include "fmu/package.hpp"
#include "fmu/variables.hpp"
#include "time/time_model.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/vehicle/dynamics.hpp"

namespace wingbeat::fmu {
namespace {

using detail::markup_escaped;

/// Binaries run where the C library is no older than that of the build.
std::string oldest_libc() {
#ifdef __GLIBC__
  return ", on Linux glibc " + std::to_string(__GLIBC__) + "." + std::to_string(__GLIBC_MINOR__) + " or newer";
#else
  return {};
#endif
}

std::string documentation_of(const Design<double>& design, const FmuOptions& options) {
  std::string page =
      "<!DOCTYPE html>\n<html><head><meta charset=\"utf-8\"><title>" + markup_escaped(design.name) +
      "</title></head>\n<body>\n<h1>" + markup_escaped(design.name.empty() ? "wingbeat" : design.name) +
      "</h1>\n<p>A flapping-wing drive as computed by wingbeat " + options.program_version +
      ": motor, transmission, springs and wings in blade-element air. All variables are SI and radians. " +
      (has_body(design) ? "The wings feel the motion of the body, which the air and gravity move. "
                        : "The air meets wings of a body at rest. ") +
      "The binaries need libc and libm alone" + oldest_libc() +
      ".</p>\n"
      "<table>\n<tr><th>variable</th><th>unit</th><th>causality</th><th>variability</th>"
      "<th>meaning</th></tr>\n";
  for (const Variable& v : variables_of(design)) {
    page += "<tr><td><code>" + markup_escaped(v.name) + "</code></td><td>" + markup_escaped(v.unit) + "</td><td>" +
            v.causality + "</td><td>" + v.variability + "</td><td>" + markup_escaped(v.description) + "</td></tr>\n";
  }
  return page + "</table>\n</body></html>\n";
}

/// The translation unit of the sources: linked statically the functions have the identifier before their names.
std::string source_of(const FmuOptions& options) {
  const bool second = options.version == FmiVersion::fmi2;
  std::string text = "#ifndef " + std::string(second ? "FMI2" : "FMI3") + "_OVERRIDE_FUNCTION_PREFIX\n";
  const auto rename = [&](const char* name) {
    text += std::string("#define ") + name + " " + options.identifier + "_" + name + "\n";
  };
#define WINGBEAT_RENAME(result, name, parameters) rename(#name);
  if (second) {
    FMI2_FUNCTIONS(WINGBEAT_RENAME)
  } else {
    FMI3_FUNCTIONS(WINGBEAT_RENAME)
  }
#undef WINGBEAT_RENAME
  return text + "#endif\n#include \"all.cpp\"\n";
}

std::string build_description_of(const FmuOptions& options) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiBuildDescription fmiVersion=\"3.0\">\n"
         "  <BuildConfiguration modelIdentifier=\"" +
         options.identifier +
         "\" description=\"One C++ file with all others\">\n"
         "    <SourceFileSet language=\"C++20\" compiler=\"gcc\" "
         "compilerOptions=\"-std=c++20 -O2 -fPIC -fno-gnu-unique\">\n"
         "      <SourceFile name=\"fmu.cpp\"/>\n"
         "      <IncludeDirectory name=\".\"/>\n"
         "    </SourceFileSet>\n"
         "  </BuildConfiguration>\n</fmiBuildDescription>\n";
}

/// As it is flown: a current that settles within a small part of a cycle follows the voltage.
Design<double> as_flown(Design<double> design) {
  if (!has_body(design)) return design;
  flight_vehicle(design);  // refuses what cannot fly
  detail::TimeModel drive(drive_vehicle(design, has_two_drives(design)), design.supply);
  drive.start({});
  if (drive.indices.inductive && drive.stiff()) design.motor.constants.armature_inductance = 0.0;
  return design;
}

}  // namespace

FmuContent fmu_content(const Design<double>& stated, const FmuOptions& options) {
  const Design<double> design = as_flown(stated);
  const Vehicle<double> vehicle = resolve(design);
  if (is_of_further_kind(vehicle) || vehicle.electronics.efficiency != 1.0) {
    const char* section = design.piezo.force_per_volt     ? "piezo"
                          : design.electronics.efficiency ? "electronics"
                          : design.wing.torsion.stiffness ? "wing.torsion"
                                                          : "aerodynamics.angle_of_attack_min";
    const bool beside = jumps_at_pitch_stop(vehicle);
    throw ParameterError(section, std::string("FMUs do not support it ") + (beside ? "with added_mass " : "") +
                                      "yet: `wingbeat run` and Simulation do");
  }
  if (has_friction(vehicle.pitch.hinge) || vehicle.voltage_offset != 0.0) {
    throw ParameterError(has_friction(vehicle.pitch.hinge) ? "pitch.friction" : "supply.offset",
                         "FMUs do not support it yet: `wingbeat run` and Simulation do");
  }
  const AerodynamicsDesign<double>& air = design.aerodynamics;
  if (air.induced_velocity || (air.clap.amplitude && !drive_of(design).stroke_is_fixed)) {
    throw ParameterError(air.induced_velocity ? induced_velocity_key::share.path : clap_and_fling_key::amplitude.path,
                         "an FMU does not know it: it follows from a cycle's mean, and an FMU has no cycles");
  }
  FmuContent content;
  content.resource = resource_of(design);
  content.description = model_description(design, token_of(content.resource), options);
  content.documentation = documentation_of(design, options);
  const bool second = options.version == FmiVersion::fmi2;
#ifdef __aarch64__
  content.linux_folder = "binaries/aarch64-linux";  // FMI 2 has no name for it
#else
  content.linux_folder = second ? "binaries/linux64" : "binaries/x86_64-linux";
#endif
  content.windows_folder = second ? "binaries/win64" : "binaries/x86_64-windows";
  if (options.sources) content.source = source_of(options);
  if (options.sources && !second) content.build_description = build_description_of(options);
  return content;
}

std::string identifier_of(const std::string& name) {
  std::string identifier;
  for (const char c : name) identifier += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  if (identifier.empty() || std::isdigit(static_cast<unsigned char>(identifier[0]))) identifier = "_" + identifier;
  return identifier;
}

}  // namespace wingbeat::fmu
