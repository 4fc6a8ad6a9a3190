#include "wingbeat/files/design_parameter.hpp"

#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {

DesignParameter design_parameter(std::string_view path) {
  const Parameter<double>& plain = numeric_parameter<double>(path);
  const Parameter<GradientJet>& jets = numeric_parameter<GradientJet>(path);
  return {std::string(path), std::string(plain.unit), plain.set, jets.set, plain.get};
}

}  // namespace wingbeat
