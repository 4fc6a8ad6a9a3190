// Control models as data sets: NetCDF-4, and MATLAB's MAT-files of version 5, which MATLAB, Octave and SciPy load.
#pragma once

#include <filesystem>
#include <string>

#include "wingbeat/flight/stability.hpp"
#include "wingbeat/study/control_models.hpp"

namespace wingbeat {

/// Matrices over labelled dimensions, and whatever else was computed. `models.linear.model` must be there. Throws
/// NetcdfError.
void write_control_netcdf(const ControlModels& models, const std::string& version, const std::filesystem::path& file);

/// Control models as a MAT-file with the variables A, B, C, D, dt, Ac, Bc, Cc, Dc, steady_gain, names as cell arrays,
/// step responses (cycle x output x input), maps as structures. Throws std::runtime_error.
void write_control_mat(const ControlModels& models, const std::string& version, const std::filesystem::path& file);

/// The averaged linear model of a flight in continuous time as a MAT-file: A, B, C, D from deviations of the controls
/// and the wind to those of all states, with names, units and the values of the trim. `flight.model` must be there.
/// Throws std::runtime_error.
void write_flight_mat(const StabilityResult& flight, const std::string& version, const std::filesystem::path& file);

}  // namespace wingbeat
