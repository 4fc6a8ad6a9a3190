// What a data sheet states of a motor, and what a motor with given constants shows in its place.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "wingbeat/study/motor_identification.hpp"

namespace wingbeat::detail {

/// Unknowns of the fit: ln R, ln K, constant friction and damping over their scales; at the sheet's shaft.
enum Unknown { resistance, constant, friction, damping, unknowns };

enum class DatumKind {
  resistance,
  torque_constant,
  speed_constant,
  no_load_speed,
  no_load_current,
  stall_torque,
  stall_current,
  friction_torque,
  viscous_damping,
  point_speed,
  point_current,
  point_torque,
  point_efficiency
};

/// SI
const char* unit_of(DatumKind kind);

struct Datum {
  std::string name;
  DatumKind kind;
  double value;
  double deviation;  ///< relative
  double voltage;
  double load = 0.0;  ///< of a point: its torque, or its current where that is given instead
  bool by_torque = true;
};

/// Of the unknowns of the losses.
struct LossScales {
  double friction, damping;
  double torque_factor;  ///< output torque over the sum of what the motor gives
};

/// What a motor shows where the sheet states a datum.
template <class T>
T predicted(const Datum& d, const T* x, const LossScales& scales) {
  using std::exp;
  const T R = exp(x[resistance]), K = exp(x[constant]);
  const T T_c = x[friction] * scales.friction, b = x[damping] * scales.damping;
  const double v = d.voltage, eta = scales.torque_factor;
  const auto speed_at = [&](const T& torque) { return T((K * v / R - torque / eta - T_c) / (K * K / R + b)); };
  switch (d.kind) {
    case DatumKind::resistance: return R;
    case DatumKind::torque_constant: return K;
    case DatumKind::speed_constant: return T(1.0 / K);
    case DatumKind::no_load_speed: return speed_at(T(0.0));
    case DatumKind::no_load_current: return T((T_c + b * speed_at(T(0.0))) / K);
    case DatumKind::stall_current: return T(v / R);
    case DatumKind::stall_torque: return T(eta * (K * v / R - T_c));
    case DatumKind::friction_torque: return T_c;
    case DatumKind::viscous_damping: return b;
    default: break;
  }
  T torque(d.load), speed, current;
  if (d.by_torque) {
    speed = speed_at(torque);
    current = (torque / eta + T_c + b * speed) / K;
  } else {
    current = T(d.load);
    speed = (v - R * current) / K;
    torque = eta * (K * current - T_c - b * speed);
  }
  if (d.kind == DatumKind::point_speed) return speed;
  if (d.kind == DatumKind::point_current) return current;
  if (d.kind == DatumKind::point_torque) return torque;
  return T(torque * speed / (v * current));
}

/// Throws ParameterError for values out of range.
void validate(const MotorDatasheet& sheet);

/// Relative standard deviation of the value of that name.
double deviation_in(const MotorDatasheet& sheet, const std::string& name);

std::vector<Datum> data_of(const MotorDatasheet& sheet);

}  // namespace wingbeat::detail
