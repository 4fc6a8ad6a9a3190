// The motion of the wings over one cycle as other programs read it. For the formats and their signs see docs/cfd.md.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "wingbeat/core/names.hpp"
#include "wingbeat/parts/load_table.hpp"
#include "wingbeat/study/wing_motion.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

enum class KinematicsFormat { csv, wabbit, pterasoftware, load_table };
template <>
inline constexpr std::pair<const char*, KinematicsFormat> names_of<KinematicsFormat>[] = {
    {"csv", KinematicsFormat::csv},
    {"wabbit", KinematicsFormat::wabbit},
    {"pterasoftware", KinematicsFormat::pterasoftware},
    {"load-table", KinematicsFormat::load_table}};

/// Time, phase, angles with velocities and accelerations and, of wings that twist, the twist: a header line and one
/// line for each instant, every number with the digits that read back to the same double. With `loads` also those of
/// the model, in columns that read_loads() takes.
std::string kinematics_csv(std::span<const WingInstant> wings, bool loads = false);

/// Rows of a table of loads, in the columns that aerodynamics.file takes; `comment` on a line before them.
std::string load_table_csv(std::span<const LoadTable::Row> rows, const std::string& comment);

/// What a file with the motion as Fourier series states beside it.
struct KinematicsSource {
  std::string vehicle, version;  ///< name of the vehicle; version of the program
  double frequency = 0.0;        ///< [Hz]
  AngleSeries stroke, pitch;
};

/// The kinematics file (.ini) of WABBIT, FLUSI and their insect tools: series in degrees over the cycle.
std::string kinematics_wabbit(const KinematicsSource& source);

/// Chords at distances from the root [m], from root to tip, for programs that take a wing as a row of sections. Throws
/// ParameterError for a planform that has no shape.
std::vector<std::pair<double, double>> wing_sections(const Planform<double>& planform, int count);

/// A Python script that sets the flapping wings up for PteraSoftware and writes the loads that it finds. Throws
/// ParameterError for a planform that has no shape.
std::string kinematics_pterasoftware(const KinematicsSource& source, const Design<double>& design);

}  // namespace wingbeat
