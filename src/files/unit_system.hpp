// The units of UDUNITS-2, taken apart: what the rules of units.hpp rest on.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

namespace wingbeat::detail {

/// A unit taken apart: `scale` times a product of powers of base units, the radian counted on its own.
struct UnitAnatomy {
  double scale = 1.0;
  int angle = 0;
  std::map<std::string, int> dimension;  ///< by symbol of the base unit, without powers of 0
  bool plain = true;                     ///< neither offset nor logarithm nor time stamp
};

/// Symbols beside those of UDUNITS, which takes its prefixes before them as well: mAh, mNm, uNm.
inline constexpr std::pair<const char*, const char*> unit_products[] = {
    {"Ah", "A h"},   {"Wh", "W h"},    {"Nm", "N m"}, {"Ncm", "N cm"},
    {"Nmm", "N mm"}, {"Nms", "N m s"}, {"Vs", "V s"}, {"RPM", "rpm"}};

/// Empty for what is no unit, and for one whose scale is not a positive number. Throws std::runtime_error where the
/// unit database cannot be read.
std::optional<UnitAnatomy> dissect_unit(const std::string& unit);

/// A temperature in another unit, their zeros taken into account; empty where one of the units is none of temperature.
/// Throws as dissect_unit.
std::optional<double> converted_temperature(double value, const std::string& unit, const std::string& wanted);

}  // namespace wingbeat::detail
