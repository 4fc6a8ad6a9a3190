// Parts of a vehicle by themselves, for Python: what their functions give over an array. Nothing is computed here.
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "binding.hpp"
#include "wingbeat/parts/pitching_wings.hpp"
#include "wingbeat/parts/steady_motor.hpp"
#include "wingbeat/vehicle/drive.hpp"

namespace wingbeat::python {
namespace {

using Columns = std::vector<std::vector<double>>;

py::list arrays_of(Columns&& columns) {
  py::list arrays;
  for (std::vector<double>& column : columns) arrays.append(array_of(std::move(column)));
  return arrays;
}

/// One value after the other into its column.
void append_row(Columns& columns, std::initializer_list<double> row) {
  std::size_t column = 0;
  for (const double value : row) columns[column++].push_back(value);
}

void require_finite(const char* name, double angle) {
  if (!std::isfinite(angle)) throw InputError("", 0, 0, name, "must be finite");
}

Vehicle<double> resolved(const Design<double>& design) {
  validate(design);
  return switched_on(resolve(design));
}

/// Voltage [V], no-load speed [rad/s] and current [A], stall current [A] and torque [N m], then columns: current,
/// torque, electrical and mechanical power, and the speeds [rad/s], which without any given run from rest to no load.
py::tuple motor_curves(const Design<double>& design, std::optional<double> voltage, std::vector<double> speeds) {
  const Vehicle<double> vehicle = resolved(design);
  const double v = voltage.value_or(vehicle.voltage), free = free_speed(vehicle.motor, v);
  if (!(v >= 0.0) || !std::isfinite(v)) throw InputError("", 0, 0, "voltage", "must be >= 0 V and finite");
  if (speeds.empty()) {
    constexpr int intervals = 100;
    for (int n = 0; n <= intervals; ++n) speeds.push_back(free * n / intervals);
  }
  Columns columns(4);
  listening([&] {
    for (const double speed : speeds) {
      check_cancellation();
      if (!(speed >= 0.0) || !std::isfinite(speed))
        throw InputError("", 0, 0, "speed", "must be >= 0 rad/s and finite");
      const SteadyMotor<double> steady = steady_motor(vehicle.motor, v, speed);
      append_row(columns, {steady.current, steady.torque, steady.power_electrical, steady.power_mechanical});
    }
  });
  const SteadyMotor<double> stalled = steady_motor(vehicle.motor, v, 0.0), idle = steady_motor(vehicle.motor, v, free);
  columns.push_back(std::move(speeds));
  return py::make_tuple(v, free, idle.current, stalled.current, stalled.torque, arrays_of(std::move(columns)));
}

/// C_L, C_D, C_N and, of wings on hinges, the centre of pressure over angles of attack [rad].
py::list coefficient_curves(const Design<double>& design, const std::vector<double>& angles) {
  const Vehicle<double> vehicle = resolved(design);
  if (is_given(vehicle.wings.tabulated)) {
    throw ParameterError(load_table_key::type, "tabulated loads have no coefficients");
  }
  const ForceCoefficients<double>& c = vehicle.wings.coefficients;
  Columns columns(4);
  listening([&] {
    for (const double alpha : angles) {
      check_cancellation();
      require_finite("angle_of_attack", alpha);
      append_row(columns, {lift_coefficient(c, alpha), drag_coefficient(c, alpha),
                           normal_force_coefficient(vehicle.wings, vehicle.pitch, alpha),
                           pitches(vehicle) ? centre_of_pressure(alpha) : absent});
    }
  });
  return arrays_of(std::move(columns));
}

/// Stroke amplitude [rad] and reversals [rad], then stroke angle, its derivatives and the levers over crank angles.
py::tuple kinematics(const Design<double>& design, const std::vector<double>& angles) {
  if (!drive_of(design).rotates) {
    throw ParameterError("transmission.type", "a direct drive has no transmission between motor and wings");
  }
  const Vehicle<double> vehicle = resolved(design);
  Columns columns(5);
  listening([&] {
    for (const double theta : angles) {
      check_cancellation();
      require_finite("crank_angle", theta);
      const CrankKinematics<double> k = crank_kinematics(vehicle.transmission, std::sin(theta), std::cos(theta));
      append_row(columns,
                 {stroke_angle(k), k.stroke_slope, k.stroke_second_derivative, k.crank_jacobian, k.wing_jacobian});
    }
  });
  const Reversals found = reversals(vehicle.transmission);
  std::vector<double> turns(found.angle.begin(), found.angle.begin() + std::ptrdiff_t(found.count));
  return py::make_tuple(stroke_amplitude(vehicle.transmission), turns, arrays_of(std::move(columns)));
}

}  // namespace

void add_parts(py::module_& m) {
  using namespace py::literals;
  m.def("motor_curves", &motor_curves, "design"_a, "voltage"_a, "speeds"_a);
  m.def("coefficient_curves", &coefficient_curves, "design"_a, "angles"_a);
  m.def("kinematics", &kinematics, "design"_a, "angles"_a);
}

}  // namespace wingbeat::python
