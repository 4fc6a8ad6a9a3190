// What the program says about itself: keys of vehicle files, metrics, and a vehicle file to start from.
#pragma once

#include <string>

#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

/// The keys of vehicle files whose name, unit or meaning contains `filter` (all for an empty one), with unit, range,
/// default and meaning, as text or as one JSON object. Empty where there is none.
std::string text_keys(const std::string& filter);
std::string json_keys(const std::string& filter);

/// The metrics whose name, unit or meaning contains `filter`: name, unit, meaning.
std::string text_metrics(const std::string& filter);
std::string json_metrics(const std::string& filter);

/// All keys as Markdown: the generated part of docs/vehicle-file.md.
std::string vehicle_file_reference();

/// All metrics with symbol and definition (TeX) as Markdown: the generated part of docs/metrics.md.
std::string metric_reference();

/// A vehicle file that flaps and holds every key that such a vehicle may have, each explained, the optional ones as
/// comments.
std::string starting_vehicle(TransmissionType transmission, const std::string& name);

}  // namespace wingbeat
