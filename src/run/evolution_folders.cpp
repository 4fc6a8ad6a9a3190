#include <dlfcn.h>

#include <system_error>

#include "wingbeat/run/evolution_module.hpp"

namespace wingbeat {

Evolve load_evolution(std::span<const std::filesystem::path> folders) {
  for (const std::filesystem::path& folder : folders) {
    std::error_code error;
    const std::filesystem::path file = folder / "wingbeat-evolution.so";
    if (!std::filesystem::exists(file, error)) continue;
    void* const handle = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    const void* const symbol = handle ? ::dlsym(handle, "wingbeat_evolution_module") : nullptr;
    if (symbol) return *static_cast<const Evolve*>(symbol);
  }
  return load_evolution();
}

}  // namespace wingbeat
