#include "wingbeat/flight/flight_vehicle.hpp"

#include <cmath>
#include <memory>
#include <utility>

#include "wingbeat/core/text.hpp"

namespace wingbeat {
namespace {

void refuse_what_does_not_fly(const Design<double>& d) {
  if (!d.body.inertia_pitch) {
    throw ParameterError(body_key::inertia_pitch.path,
                         "missing: flight needs [body], with the moments of inertia of the vehicle");
  }
  if (d.wing.planform.shape == PlanformShape::moments) {
    throw ParameterError("wing.planform.shape", "flight needs the wing's outline: give a planform with a shape");
  }
  if (!(d.aerodynamics.air_density > 0.0)) {
    throw ParameterError(aerodynamics_key::air_density.path, "flight needs air: must be > 0");
  }
  for (const auto& [given, key] : {std::pair{d.wing.torsion.stiffness.has_value(), torsion_key::stiffness.path},
                                   {d.aerodynamics.load_table != nullptr, load_table_key::type},
                                   {d.aerodynamics.induced_velocity.has_value(), induced_velocity_key::share.path},
                                   {d.piezo.force_per_volt.has_value(), piezo_key::force_per_volt.path}}) {
    if (given) throw ParameterError(key, "flight is not known of vehicles with this");
  }
}

/// The share of one side, or all, of a design.
Design<double> of_one_drive(Design<double> d) {
  d.motors = 1.0;
  return d;
}

WingMount mount_of(const BodyDesign<double>& b, double side, double sense, double share) {
  WingMount mount;
  mount.side = side;
  mount.sense = sense;
  mount.share = share;
  mount.shoulder = {b.shoulder_ahead, side * b.shoulder_aside, -b.shoulder_above};
  mount.tilt = b.stroke_plane_tilt;
  mount.mean_angle = b.mean_stroke_angle;
  return mount;
}

FlightDrive drive_from(const Design<double>& design, double side) {
  FlightDrive drive;
  drive.side = side;
  drive.vehicle = resolve(design);
  drive.supply = design.supply;
  const Planform<double>& planform = design.wing.planform;
  const double R = length_of(planform), d = hub_offset_of(planform);
  const double B = design.aerodynamics.lifting_span.value_or(1.0);
  if (B < 1.0 && planform.shape == PlanformShape::tabulated) {
    throw ParameterError(tip_loss_key::lifting_span.path, "is not for a tabulated outline in flight");
  }
  drive.vehicle.wings.wake.strips = wake_strips(planform, drive.vehicle.wing_count, (B * (R + d) - d) / R);
  const bool opposed = design.body.opposed;
  const double sides = side == 0.0 ? 2.0 : 1.0;
  for (const double of_side : {1.0, -1.0}) {
    if (side == -of_side) continue;
    for (const double sense : {1.0, -1.0}) {
      if (sense < 0.0 && !opposed) continue;
      drive.flow.mounts[drive.flow.count++] =
          mount_of(design.body, of_side, sense, 1.0 / (sides * (opposed ? 2.0 : 1.0)));
    }
  }
  drive.vehicle.wings.flow = std::make_shared<OnsetFlow>(drive.flow);
  return drive;
}

void set_ranges(const Design<double>& d, FlightVehicle& v) {
  const ControlDesign<double>& c = d.body.control;
  const auto range = [&](FlightControl which) -> ControlRange& { return v.ranges[std::size_t(which)]; };
  const auto both = [](double largest) { return ControlRange{-largest, largest}; };
  // A battery gives no more than it has.
  double highest = 2.0 * v.stated_voltage;
  if (has_battery(d.supply.type)) highest = open_circuit_voltage(d.supply.battery, d.supply.battery.charge);
  if (c.voltage_max) highest = *c.voltage_max;
  range(FlightControl::voltage) = {0.0, highest};
  if (v.drives.size() == 2) range(FlightControl::voltage_difference) = both(0.5 * highest);
  if (v.direct) {
    range(FlightControl::bias) = both(0.5 * highest);
    if (v.drives.size() == 2) range(FlightControl::split_difference) = both(0.3);
  }
  if (c.mean_stroke_angle) range(FlightControl::mean_stroke_angle) = both(*c.mean_stroke_angle);
  if (c.stroke_plane_difference) range(FlightControl::stroke_plane_difference) = both(*c.stroke_plane_difference);
  if (c.incidence_difference && follows_pitch_law(d)) {
    range(FlightControl::incidence_difference) = both(*c.incidence_difference);
  }
}

}  // namespace

FlightVehicle flight_vehicle(const Design<double>& design, const Design<double>* right, const Design<double>* left) {
  refuse_what_does_not_fly(design);
  FlightVehicle v;
  v.name = design.name;
  v.direct = !drive_of(design).rotates;
  v.stated_voltage = mean_voltage(design.supply);
  const BodyDesign<double>& b = design.body;
  if (design.motors == 2.0) {
    v.drives.push_back(drive_from(of_one_drive(right ? *right : design), 1.0));
    v.drives.push_back(drive_from(of_one_drive(left ? *left : design), -1.0));
  } else {
    v.drives.push_back(drive_from(design, 0.0));
  }
  v.wings_of_drive = design.wing.count;
  v.body.mass = *total_mass(design);
  v.body.inertia_roll = *b.inertia_roll;
  v.body.inertia_pitch = *b.inertia_pitch;
  v.body.inertia_yaw = *b.inertia_yaw;
  v.body.inertia_product = b.inertia_product;
  v.body.drag_area = {b.drag_area_forward, b.drag_area_sideways, b.drag_area_vertical};
  v.body.drag_below = b.drag_below;
  v.body.air_density = design.aerodynamics.air_density;
  if (b.tail.area)
    v.body.plates[0] = {{-b.tail.behind, 0.0, b.tail.below}, {0.0, 0.0, 1.0}, *b.tail.area, b.tail.coefficient};
  if (b.fin.area)
    v.body.plates[1] = {{-b.fin.behind, 0.0, b.fin.below}, {0.0, 1.0, 0.0}, *b.fin.area, b.fin.coefficient};
  if (b.wing_mass) v.wing_mass = *b.wing_mass, v.wing_centre = b.wing_centre;
  set_ranges(design, v);
  return v;
}

void set_mounts(const FlightDrive& drive, const FlightControls& controls, OnsetFlow& flow) {
  for (std::size_t n = 0; n < flow.count; ++n) {
    const WingMount& fixed = drive.flow.mounts[n];
    WingMount& mount = flow.mounts[n];
    mount.mean_angle = fixed.mean_angle + controls[FlightControl::mean_stroke_angle];
    mount.tilt = fixed.tilt + fixed.side * controls[FlightControl::stroke_plane_difference];
    mount.incidence = fixed.incidence + fixed.side * controls[FlightControl::incidence_difference];
  }
}

}  // namespace wingbeat
