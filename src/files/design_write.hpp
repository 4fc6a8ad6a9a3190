// A design as the keys of a vehicle file, one by one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "files/toml_document.hpp"
#include "wingbeat/files/toml_text.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

struct WrittenKey {
  std::string_view path, unit;
  TomlNode value;    ///< numbers in SI units
  std::string text;  ///< the value in TOML, to the last bit

  bool is_number() const { return value.kind == TomlNode::Kind::number; }
};

/// In the order of the key table.
std::vector<WrittenKey> written_keys(const Design<double>& design);

/// A number, or a string with its unit, that reads back to the same double.
std::string toml_quantity(double x, std::string_view unit);

}  // namespace wingbeat
