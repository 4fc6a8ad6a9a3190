// Lists of gearboxes and of batteries: CSV files with one of them in each line.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "files/bench_table.hpp"
#include "wingbeat/files/optimise_file.hpp"

namespace wingbeat::detail {

/// Every gearbox of a list; what cannot be tried says why. `weighed`: its mass counts. Throws InputError, naming the
/// file.
std::vector<GearboxCandidate> parse_gearboxes(std::string_view utf8, const std::string& file_name,
                                              const StatedTable& stated, bool weighed);

/// Every battery of a list, in the vehicle of `design`, which gives what the list does not state.
std::vector<BatteryCandidate> parse_batteries(std::string_view utf8, const std::string& file_name,
                                              const StatedTable& stated, bool weighed, const Design<double>& design);

/// Lines of a motor's name and the names of the gearboxes that go with it, as the Motor-Gearbox Database has them.
std::map<std::string, std::vector<std::string>> parse_compatibility(std::string_view utf8);

/// The list, "gearboxes" or "batteries", that states a key of the vehicle; null where none does.
const char* listed_with(const DriveTrainSearch& search, std::string_view key);

}  // namespace wingbeat::detail
