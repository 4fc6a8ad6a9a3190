// Headers of tables as people and programs write them: names and units in use.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace wingbeat::detail {

/// A column that a table may have, by its name without unit.
struct NamedColumn {
  std::string name;
  std::string full;  ///< a header that needs no reading, in SI: "current_mean_a"
  std::string unit;  ///< SI; "1" without dimension, "" of text
};

/// What others call a column.
struct ColumnAlias {
  std::string_view written, name;
};

struct RecognisedHeader {
  const NamedColumn* column = nullptr;  ///< null: unknown
  double factor = 1.0;                  ///< SI value over the number
  std::string unit;                     ///< as written
  bool renamed = false;                 ///< the name is an alias
  std::string complaint;                ///< about the unit; empty where there is none
};

/// "current_mean" of "current_mean_a".
std::string base_name(std::string_view key);

/// The column of a name or an alias, with or without the suffix of its SI unit; null where it is none of them.
const NamedColumn* find_column(std::string_view name, std::span<const NamedColumn* const> known,
                               std::span<const ColumnAlias> aliases);

/// What a header means, as "current_mean_mA", "Lift (g)", "U [V]" or "Frequency / Hz".
RecognisedHeader recognise_header(std::string_view header, std::span<const NamedColumn* const> known,
                                  std::span<const ColumnAlias> aliases);

/// What a header means that is stated to be a column: the unit stands in the name given, as "lift_mean_mN", or in the
/// header. No column where the name is none.
RecognisedHeader recognise_stated(std::string_view name, std::string_view header,
                                  std::span<const NamedColumn* const> known, std::span<const ColumnAlias> aliases);

}  // namespace wingbeat::detail
