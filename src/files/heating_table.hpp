// Heating curves of motors: the section [heating] of a data sheet file and the CSV that it names.
#pragma once

#include <filesystem>

#include "files/toml_fields.hpp"
#include "wingbeat/study/motor_heating.hpp"

namespace wingbeat::detail {

/// The section, its table being sought in that folder. Throws InputError.
HeatingCurve read_heating(const TomlFields& section, const std::filesystem::path& folder);

}  // namespace wingbeat::detail
