// Vehicle files with [left] and [right]: numbers of one side that take the place of the vehicle's.
//
//   [left]
//   "motor.armature_resistance" = "14.78 ohm"
//
// Keys are those of the vehicle file, dotted or as sections below ([left.motor]). Overrides come after them.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/study/two_sides.hpp"

namespace wingbeat {

/// What is said of such files where both sides must be alike.
inline constexpr const char* sides_refused =
    "this takes no vehicle whose sides differ; wingbeat run, linearise, trim, stability and fly do";

struct VehicleFile {
  Design<double> design;          ///< of both sides alike; where they differ, without what is of one side
  std::optional<TwoSides> sides;  ///< where they differ
};

/// As read_design(), which refuses files with sides. Throws InputError for sides that have no place: of a crank, of
/// other than two motors, on a battery; and for keys that both sides share.
VehicleFile read_vehicle(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// As parse_design().
VehicleFile parse_vehicle(std::string_view text, std::string_view file_name,
                          std::span<const std::string> overrides = {}, const TableLoader& load_table = {});

}  // namespace wingbeat
