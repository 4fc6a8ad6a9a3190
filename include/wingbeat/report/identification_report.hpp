// What was identified of a motor, as text, JSON and a [motor] section.
#pragma once

#include <string>

#include "wingbeat/study/motor_identification.hpp"

namespace wingbeat {

/// The [motor] section of a vehicle file, constants at the output shaft, with what it rests on as comments. Numbers
/// read back to the same double. The identification must be complete.
std::string motor_section(const MotorIdentification& motor, const MotorDatasheet& sheet, const std::string& made_by);

/// A table of at most 90 columns.
std::string text_identification(const MotorIdentification& motor, const MotorDatasheet& sheet);
/// One JSON object, SI, what is not determined null.
std::string json_identification(const MotorIdentification& motor, const MotorDatasheet& sheet);

}  // namespace wingbeat
