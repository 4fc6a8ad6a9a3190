// One combination of a drive train with its optimum as JSON.
#pragma once

#include "report/described.hpp"
#include "wingbeat/files/optimise_file.hpp"

namespace wingbeat::described {

Json drive_train_schema();
Json drive_train_json(const OptimiseFile& file, const MotorTrial& trial);

}  // namespace wingbeat::described
