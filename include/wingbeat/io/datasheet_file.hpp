// Motor data sheets as TOML, and the identified motor as text. For the keys see docs/motors.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "wingbeat/study/motor_identification.hpp"

namespace wingbeat {

/// Throws InputError.
MotorDatasheet read_datasheet(const std::filesystem::path& file);
MotorDatasheet parse_datasheet(std::string_view text, const std::string& file_name);

/// The [motor] section of a vehicle file, constants at the output shaft, with what it rests on as comments. Numbers read
/// back to the same double. The identification must be complete.
std::string motor_section(const MotorIdentification& motor, const MotorDatasheet& sheet, const std::string& made_by);

/// A table of at most 90 columns.
std::string text_identification(const MotorIdentification& motor, const MotorDatasheet& sheet);
/// One JSON object, SI, what is not determined null.
std::string json_identification(const MotorIdentification& motor, const MotorDatasheet& sheet);

}  // namespace wingbeat
