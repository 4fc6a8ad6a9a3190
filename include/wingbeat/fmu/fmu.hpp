// A vehicle as a Functional Mock-up Unit: its description and what its binary reads. The binary is the same for every
// vehicle.
#pragma once

#include <string>
#include <utility>

#include "wingbeat/core/names.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat::fmu {

enum class FmiVersion { fmi2, fmi3 };
enum class FmuKind { model_exchange, co_simulation, both };

struct FmuOptions {
  FmiVersion version = FmiVersion::fmi2;
  FmuKind kind = FmuKind::both;
  std::string identifier = "wingbeat";  ///< of the model, and the file name of its binaries
  std::string program_version;
  bool sources = false;  ///< the sources of the binaries, too
};

/// Files of the FMU, without its binaries.
struct FmuContent {
  std::string description;                   ///< modelDescription.xml
  std::string resource;                      ///< resources/vehicle.bin
  std::string documentation;                 ///< documentation/index.html
  std::string linux_folder, windows_folder;  ///< of the binaries, "binaries/linux64"
  std::string source;                        ///< sources/fmu.cpp, which includes all.cpp; empty without sources
  std::string build_description;             ///< sources/buildDescription.xml; of FMI 3 with sources alone
};

/// Throws ParameterError for a design out of range.
FmuContent fmu_content(const Design<double>& design, const FmuOptions& options);

/// Letters, digits and underscores, no digit first; never empty.
std::string identifier_of(const std::string& name);

}  // namespace wingbeat::fmu

namespace wingbeat {

template <>
inline constexpr std::pair<const char*, fmu::FmiVersion> names_of<fmu::FmiVersion>[] = {{"2", fmu::FmiVersion::fmi2},
                                                                                        {"3", fmu::FmiVersion::fmi3}};
template <>
inline constexpr std::pair<const char*, fmu::FmuKind> names_of<fmu::FmuKind>[] = {
    {"me", fmu::FmuKind::model_exchange}, {"cs", fmu::FmuKind::co_simulation}, {"both", fmu::FmuKind::both}};

}  // namespace wingbeat
