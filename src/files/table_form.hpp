// What a study or bench file states of a table that does not show by itself: [[log]] and [motors] alike.
#pragma once

#include "files/bench_table.hpp"
#include "files/toml_fields.hpp"

namespace wingbeat::detail {

/// The keys separator, decimal and columns. `example` is the name of a column, for the message. Throws InputError.
StatedTable stated_table(const TomlFields& fields, const char* example);

}  // namespace wingbeat::detail
