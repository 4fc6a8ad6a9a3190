#include "files/unit_system.hpp"

#include <udunits2.h>

#include <cmath>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "wingbeat/core/math.hpp"

namespace wingbeat::detail {
namespace {

struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
struct FreeSystem {
  void operator()(ut_system* system) const { ut_free_system(system); }
};
struct FreeConverter {
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;

UnitAnatomy& anatomy(void* argument) { return *static_cast<UnitAnatomy*>(argument); }

void add_power(UnitAnatomy& a, const ut_unit* base, int power) {
  const char* symbol = ut_get_symbol(base, UT_ASCII);
  const std::string name = symbol ? symbol : "?";
  if (name == "rad") {
    a.angle += power;
  } else if (power != 0) {
    a.dimension[name] += power;
  }
}

ut_status visit_basic(const ut_unit* unit, void* argument) {
  add_power(anatomy(argument), unit, 1);
  return UT_SUCCESS;
}
ut_status visit_product(const ut_unit*, int count, const ut_unit* const* bases, const int* powers, void* argument) {
  for (int n = 0; n < count; ++n) add_power(anatomy(argument), bases[n], powers[n]);
  return UT_SUCCESS;
}
ut_status visit_scaled(const ut_unit* unit, double scale, const ut_unit* underlying, double offset, void* argument);
ut_status visit_timestamp(const ut_unit*, const ut_unit*, double, void* argument) {
  anatomy(argument).plain = false;
  return UT_SUCCESS;
}
ut_status visit_logarithm(const ut_unit*, double, const ut_unit*, void* argument) {
  anatomy(argument).plain = false;
  return UT_SUCCESS;
}
const ut_visitor visitor = {visit_basic, visit_product, visit_scaled, visit_timestamp, visit_logarithm};

ut_status visit_scaled(const ut_unit*, double scale, const ut_unit* underlying, double offset, void* argument) {
  anatomy(argument).scale *= scale;
  if (offset != 0.0) anatomy(argument).plain = false;
  return ut_accept_visitor(underlying, &visitor, argument);
}

/// The unit database. UDUNITS keeps global state while it parses, so one mutex guards all of it.
class UnitSystem {
 public:
  static UnitSystem& instance() {
    static UnitSystem system;
    return system;
  }

  /// A temperature in another unit, their zeros taken into account; empty where one of the units is none of
  /// temperature.
  std::optional<double> temperature(double value, const std::string& unit, const std::string& wanted) {
    const std::lock_guard lock(mutex_);
    const Unit from(ut_parse(system_.get(), unit.c_str(), UT_UTF8));
    const Unit to(ut_parse(system_.get(), wanted.c_str(), UT_UTF8));
    if (!from || !to) return std::nullopt;
    const std::unique_ptr<cv_converter, FreeConverter> converter(ut_get_converter(from.get(), to.get()));
    if (!converter) return std::nullopt;
    return cv_convert_double(converter.get(), value);
  }

  std::optional<UnitAnatomy> dissect(const std::string& unit) {
    const std::lock_guard lock(mutex_);
    const Unit parsed(ut_parse(system_.get(), unit.c_str(), UT_UTF8));
    if (!parsed) return std::nullopt;
    UnitAnatomy result;
    if (ut_accept_visitor(parsed.get(), &visitor, &result) != UT_SUCCESS) return std::nullopt;
    std::erase_if(result.dimension, [](const auto& power) { return power.second == 0; });
    if (!(std::isfinite(result.scale) && result.scale > 0.0)) return std::nullopt;
    return result;
  }

 private:
  UnitSystem() {
    ut_set_error_message_handler(ut_ignore);
    system_.reset(ut_read_xml(nullptr));
    if (!system_) {
      throw std::runtime_error(
          "cannot read the UDUNITS-2 unit database; install it, or name it in the environment variable "
          "UDUNITS2_XML_PATH");
    }
    // The database knows only the long names of these.
    const Unit radian(ut_get_unit_by_name(system_.get(), "radian"));
    add("deg", ut_scale(pi / 180.0, radian.get()));
    add("rev", ut_scale(two_pi, radian.get()));
    // Products as they stand in catalogues; UDUNITS puts its prefixes before them: mAh, mNm, uNm.
    for (const auto& [symbol, definition] : unit_products) add(symbol, ut_parse(system_.get(), definition, UT_UTF8));
  }

  void add(const char* symbol, ut_unit* unit) {
    const Unit owner(unit);
    ut_map_symbol_to_unit(symbol, UT_UTF8, owner.get());
  }

  std::mutex mutex_;
  std::unique_ptr<ut_system, FreeSystem> system_;
};

}  // namespace

std::optional<UnitAnatomy> dissect_unit(const std::string& unit) { return UnitSystem::instance().dissect(unit); }

std::optional<double> converted_temperature(double value, const std::string& unit, const std::string& wanted) {
  return UnitSystem::instance().temperature(value, unit, wanted);
}

}  // namespace wingbeat::detail
