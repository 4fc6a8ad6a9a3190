#include "module_symbol.hpp"

#include <dlfcn.h>

#include <filesystem>
#include <system_error>

#include "wingbeat/run/module_file.hpp"

namespace wingbeat {

std::filesystem::path module_file(const std::string& name) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  for (const std::filesystem::path& file : {folder / name, folder / WINGBEAT_MODULES / name}) {
    if (std::filesystem::exists(file, error)) return file;
  }
  return {};
}

void* module_symbol(const std::string& name, const char* symbol, int scope, std::string& reason) {
  std::filesystem::path file = module_file(name + ".so");
  if (file.empty()) file = name + ".so";  // the loader says that it is missing
  void* const handle = ::dlopen(file.c_str(), RTLD_NOW | scope);
  void* const found = handle ? ::dlsym(handle, symbol) : nullptr;
  if (!found) {
    const char* const said = ::dlerror();
    reason = said ? said : file.string();
  }
  return found;
}

}  // namespace wingbeat
