// Parts of the program that are loaded when they are needed, because their libraries take long to load.
#pragma once

#include <string>

namespace wingbeat {

/// A symbol of the module `name` ("wingbeat-mpi"), which is beside the program in the build folder, and where modules
/// are installed otherwise. `scope` is RTLD_LOCAL or RTLD_GLOBAL. Null with the loader's sentence in `reason`.
void* module_symbol(const std::string& name, const char* symbol, int scope, std::string& reason);

}  // namespace wingbeat
