#include "wingbeat/time/transient.hpp"

#include "time/crank_start_up.hpp"
#include "time/direct_start_up.hpp"
#include "wingbeat/cycle/static_balance.hpp"

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
  if (heats_up(vehicle.thermal) && vehicle.motor.torque_constant == 0.0) {
    // The magnet is too hot to have a field, which the models of the drives do not describe: the motor stands.
    TransientResult result;
    result.status = FlappingStatus::stalled;
    result.settled = true;
    result.evidence = {
        .kind = StatusEvidence::Kind::weak_motor, .torque = 0.0, .friction_torque = breakaway_torque(vehicle)};
    return result;
  }
  if (!drive_of(vehicle).rotates) return detail::DirectStartUp(vehicle, options).run();
  return detail::CrankStartUp(vehicle, options).run();
}

}  // namespace wingbeat
