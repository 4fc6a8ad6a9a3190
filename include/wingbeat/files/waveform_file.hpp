// One flapping cycle as a file: CSV or NetCDF-4 with the same columns.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>

#include "wingbeat/cycle/waveform_row.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace wingbeat {

struct WaveformColumn {
  const char* name;       ///< as in files, e.g. "time_s"
  const char* unit;       ///< UDUNITS
  const char* long_name;  ///< plain words
  double WaveformRow::* value;
};
inline constexpr int waveform_column_count = 20;

/// The columns of a waveform file, in order; the last, the pitch angle, of wings that pitch on a hinge alone.
const std::array<WaveformColumn, waveform_column_count>& waveform_columns();
/// Those that a file of these rows has.
std::span<const WaveformColumn> waveform_columns(std::span<const WaveformRow> rows);

/// A header line and one line per row, every number with the digits that read back to the same double.
std::string waveforms_csv(std::span<const WaveformRow> rows);

/// The columns as variables over the coordinate time_s. Throws NetcdfError.
void write_waveforms_netcdf(const std::filesystem::path& file, std::span<const WaveformRow> rows,
                            const Provenance& provenance);

}  // namespace wingbeat
