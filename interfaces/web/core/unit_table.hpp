// The units and prefixes of UDUNITS-2 as tables, written while the explorer is built (write_unit_table.cpp): UDUNITS
// itself reads XML files, which a page does not have.
#pragma once

#include <span>

namespace wingbeat::web {

struct UnitRow {
  const char* word;       ///< "metre", "m"
  bool symbol;            ///< symbols keep their case, names do not
  double scale;           ///< to the product of base units
  double offset;          ///< of temperatures, [K] at 0
  int angle;              ///< power of the radian
  const char* dimension;  ///< "kg 1 m 2 s -2"
  bool plain;             ///< see detail::UnitAnatomy
};
struct PrefixRow {
  const char* word;
  bool symbol;
  double factor;
};

std::span<const UnitRow> unit_table();
std::span<const PrefixRow> prefix_table();

}  // namespace wingbeat::web
