// What was identified of a motor, as text, JSON and a [motor] section.
#pragma once

#include <string>

#include "wingbeat/study/motor_identification.hpp"

namespace wingbeat {

/// Whether there is a section to write: the motor is complete, or the sheet is of heat alone and the curve determines
/// both thermal resistances.
bool has_motor_section(const MotorIdentification& motor, const MotorDatasheet& sheet);

/// The [motor] section of a vehicle file with what it rests on as comments: constants at the output shaft, or
/// gear_ratio and those at the motor shaft, so that the ratio may be changed. Numbers read back to the same double. The
/// identification must have a section.
std::string motor_section(const MotorIdentification& motor, const MotorDatasheet& sheet, const std::string& made_by,
                          Shaft shaft = Shaft::output);

/// A table of at most 90 columns.
std::string text_identification(const MotorIdentification& motor, const MotorDatasheet& sheet);
/// One JSON object, SI, what is not determined null.
std::string json_identification(const MotorIdentification& motor, const MotorDatasheet& sheet);

}  // namespace wingbeat
