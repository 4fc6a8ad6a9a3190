// Flight files: TOML in, a checked plan of a flight out; and the flight as NetCDF-4. See docs/flight-fly.md.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "wingbeat/files/two_sides_file.hpp"
#include "wingbeat/flight/fly.hpp"

namespace wingbeat {

/// With the designs of either side, where they differ. Throws ParameterError as of a design.
FlightVehicle flight_vehicle(const VehicleFile& file);

struct FlightFile {
  std::string title;
  VehicleFile source;
  FlightVehicle vehicle;  ///< flight_vehicle(source)
  FlightPlan plan;
};

/// The flight in a TOML file; the vehicle file that it names is sought beside it, or comes with the program. Throws
/// InputError.
FlightFile read_flight_file(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// The rows of a flight over time, with the whole input. `input` is the text of the flight file. Throws NetcdfError.
void write_flight(const FlightFile& file, const FlightRecord& flight, const std::string& input,
                  const std::string& version, const std::filesystem::path& output);

}  // namespace wingbeat
