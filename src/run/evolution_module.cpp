#include "wingbeat/run/evolution_module.hpp"

#include <dlfcn.h>

#include <stdexcept>
#include <string>

#include "module_symbol.hpp"

namespace wingbeat {

Evolve load_evolution() {
  std::string reason;
  const void* const symbol = module_symbol("wingbeat-evolution", "wingbeat_evolution_module", RTLD_LOCAL, reason);
  if (!symbol) {
    throw std::runtime_error(
        "several objectives need the module with pagmo (Debian package wingbeat; in a checkout: cmake --build "
        "--preset release --target wingbeat_modules): " +
        reason);
  }
  return *static_cast<const Evolve*>(symbol);
}

}  // namespace wingbeat
