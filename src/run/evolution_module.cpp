#include "wingbeat/run/evolution_module.hpp"

#include <dlfcn.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace wingbeat {

Evolve load_evolution() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::string library = (program.parent_path() / "wingbeat-evolution.so").string();
  void* const handle = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  const void* const symbol = handle ? ::dlsym(handle, "wingbeat_evolution_module") : nullptr;
  if (!symbol) {
    const char* reason = ::dlerror();
    throw std::runtime_error(std::string("several objectives need the library with pagmo: ") +
                             (reason ? reason : library));
  }
  return *static_cast<const Evolve*>(symbol);
}

}  // namespace wingbeat
