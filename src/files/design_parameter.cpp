#include "wingbeat/files/design_parameter.hpp"

#include "wingbeat/files/design_keys.hpp"

namespace wingbeat {

DesignParameter design_parameter(std::string_view path) {
  const Key<double>& plain = numeric_key<double>(path);
  const Key<GradientJet>& jets = numeric_key<GradientJet>(path);
  return {std::string(path), std::string(plain.unit), plain.set, jets.set, plain.get};
}

}  // namespace wingbeat
