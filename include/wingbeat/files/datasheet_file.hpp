// Motor data sheets: TOML in, what it states out. For the keys see docs/motors.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "wingbeat/study/motor_identification.hpp"

namespace wingbeat {

/// A heating curve that the sheet names is sought beside it, or in `folder`. Throws InputError.
MotorDatasheet read_datasheet(const std::filesystem::path& file);
MotorDatasheet parse_datasheet(std::string_view text, const std::string& file_name,
                               const std::filesystem::path& folder = {});

}  // namespace wingbeat
