#include "files/free_parameter.hpp"

#include "wingbeat/core/status.hpp"
#include "wingbeat/files/design_parameter.hpp"

namespace wingbeat::detail {

FreeParameter bounded_parameter(const TomlFields& fields, const std::string& key) {
  FreeParameter free{};
  try {
    free.parameter = design_parameter(key);
  } catch (const ParameterError& error) {
    fields.refuse(fields.at("key"), "key", error.what());
  }
  free.lower = fields.needed_quantity("lower", free.parameter.unit);
  free.upper = fields.needed_quantity("upper", free.parameter.unit);
  return free;
}

}  // namespace wingbeat::detail
