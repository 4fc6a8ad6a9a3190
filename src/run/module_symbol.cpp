#include "module_symbol.hpp"

#include <dlfcn.h>

#include <filesystem>
#include <system_error>

namespace wingbeat {

void* module_symbol(const std::string& name, const char* symbol, int scope, std::string& reason) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  std::filesystem::path file = folder / (name + ".so");
  if (!std::filesystem::exists(file, error)) file = folder / WINGBEAT_MODULES / (name + ".so");
  void* const handle = ::dlopen(file.c_str(), RTLD_NOW | scope);
  void* const found = handle ? ::dlsym(handle, symbol) : nullptr;
  if (!found) {
    const char* const said = ::dlerror();
    reason = said ? said : file.string();
  }
  return found;
}

}  // namespace wingbeat
