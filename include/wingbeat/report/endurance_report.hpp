// The discharge of a battery for people, for programs, as a figure and as a data set: how long the vehicle hovers
// first.
#pragma once

#include <filesystem>
#include <string>

#include "wingbeat/files/netcdf.hpp"
#include "wingbeat/report/plot.hpp"
#include "wingbeat/study/endurance.hpp"

namespace wingbeat {

/// One JSON object in SI, described in docs/endurance.md; absent numbers are null.
std::string json_endurance(const EnduranceResult& result);

/// A table of at most 90 columns with units chosen for reading.
std::string text_endurance(const Design<double>& design, const EnduranceResult& result);

/// Lift with the weight, power, voltage and charge against time, one panel below the other. Throws like plot_cycle, and
/// where there is nothing to draw.
void plot_endurance(const Design<double>& design, const EnduranceResult& result, PlotFormat format,
                    const std::filesystem::path& file);

/// Every row over the dimension `time` (NetCDF-4): charge, voltage, energies and all metrics. Throws NetcdfError.
void write_endurance(const EnduranceResult& result, const Provenance& provenance, const std::filesystem::path& file);

const char* name_of(EnduranceEnd end);
const char* name_of(Hover hover);

}  // namespace wingbeat
