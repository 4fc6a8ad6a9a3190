// Files that belong to the program.
#pragma once

#include <filesystem>
#include <string>

namespace wingbeat {

/// The file of that name, which is beside the program in the build folder, and where modules are installed otherwise;
/// empty where there is none.
std::filesystem::path module_file(const std::string& name);

}  // namespace wingbeat
