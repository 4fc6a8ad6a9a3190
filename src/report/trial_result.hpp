// One combination with its optimum as JSON; what lists of motors and drive trains have in common.
#pragma once

#include "report/described.hpp"
#include "wingbeat/files/optimise_file.hpp"

namespace wingbeat::described {

Json trial_schema();
Json trial_json(const OptimiseFile& file, const MotorTrial& trial);

}  // namespace wingbeat::described
