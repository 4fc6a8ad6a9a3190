#include "wingbeat/time/transient.hpp"

#include "time/crank_start_up.hpp"
#include "time/direct_transient.hpp"

namespace wingbeat {

const char* name_of(TransientEvent::Kind kind) {
  using Kind = TransientEvent::Kind;
  switch (kind) {
    case Kind::force_sign_change: return "force-sign-change";
    case Kind::standstill: return "standstill";
    case Kind::breakaway: return "breakaway";
    case Kind::revolution: return "revolution";
    case Kind::jam: return "jam";
    case Kind::supply_switch: return "supply-switch";
    case Kind::stop_impact: return "stop-impact";
  }
  return "unknown";
}

TransientResult simulate_start_up(const Vehicle<double>& vehicle, const TransientOptions& options) {
  if (!drive_of(vehicle).rotates) return detail::simulate_direct_start_up(vehicle, options);
  return detail::CrankStartUp(vehicle, options).run();
}

}  // namespace wingbeat
