// Catalogues of motors: CSV files with a motor in each line.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wingbeat/files/optimise_file.hpp"

namespace wingbeat::detail {

/// Every motor in the design, behind a gearbox of ratio `gear` unless its sheet states its output shaft; `rest` is the
/// mass of the vehicle without a motor [kg]. What cannot be tried says why. Throws InputError, naming the file.
std::vector<MotorCandidate> parse_motor_catalogue(std::string_view text, const std::string& file_name, double gear,
                                                  std::optional<double> rest, const Design<double>& design);

}  // namespace wingbeat::detail
