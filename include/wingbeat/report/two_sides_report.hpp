// Results of vehicles whose sides differ, for people and for programs.
#pragma once

#include <string>

#include "wingbeat/study/two_sides.hpp"

namespace wingbeat {

/// What the whole vehicle has, and both sides beside each other where they differ.
std::string text_two_sides(const TwoSidesResult& result, const RunOptions& options);
/// The metrics of the whole vehicle, and status and metrics of either side in the objects `left` and `right`.
std::string json_two_sides(const TwoSidesResult& result);

std::string text_two_sides_maps(const TwoSidesMaps& found);
std::string json_two_sides_maps(const TwoSidesMaps& found, const std::string& version);

}  // namespace wingbeat
