// Catalogues of motors: CSV files with a motor in each line.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/bench_table.hpp"
#include "files/column_headers.hpp"
#include "wingbeat/files/optimise_file.hpp"

namespace wingbeat::detail {

/// Columns that a list may have; others are passed over.
const std::vector<NamedColumn>& catalogue_columns();

/// Every motor in the design, behind a gearbox of ratio `gear` unless its sheet states its output shaft; `rest` is the
/// mass of the vehicle without a motor [kg]. What cannot be tried says why. Lists of any separator and decimal sign,
/// with names and units as manufacturers write them. Throws InputError, naming the file.
std::vector<MotorCandidate> parse_motor_catalogue(std::string_view text, const std::string& file_name, double gear,
                                                  std::optional<double> rest, const Design<double>& design,
                                                  const StatedTable& stated = {});

}  // namespace wingbeat::detail
