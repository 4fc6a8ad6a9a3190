// A flight as NetCDF-4.
#include <functional>
#include <string>
#include <vector>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/flight_file.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace wingbeat {
namespace {

struct FlightColumn {
  std::string name, unit, meaning;
  std::function<double(const FlightRow&)> value;
};

std::vector<FlightColumn> flight_columns(const FlightVehicle& vehicle, bool battery) {
  using R = FlightRow;
  std::vector<FlightColumn> columns;
  const auto add = [&](std::string name, const char* unit, const char* meaning, auto value) {
    columns.push_back({std::move(name), unit, meaning, value});
  };
  const char *north_east[] = {"x", "y"}, *angles[] = {"roll", "pitch", "yaw"}, *speeds[] = {"u", "v", "w"},
             *rates[] = {"p", "q", "r"};
  for (std::size_t k = 0; k < 2; ++k) {
    add(north_east[k], "m", k == 0 ? "position to the north" : "position to the east",
        [k](const R& r) { return r.position[k]; });
    add(std::string("reference_") + north_east[k], "m", "where it is to be",
        [k](const R& r) { return r.reference.position[k]; });
  }
  add("height", "m", "above the height 0", [](const R& r) { return -r.position[2]; });
  add("reference_height", "m", "where it is to be", [](const R& r) { return -r.reference.position[2]; });
  add("reference_yaw", "rad", "heading that it is to have", [](const R& r) { return r.reference.yaw; });
  for (std::size_t k = 0; k < 3; ++k) {
    add(angles[k], "rad", "Euler angle, turned in the order yaw, pitch, roll", [k](const R& r) { return r.angles[k]; });
    add(speeds[k], "m s-1", "velocity of the centre of mass along a body axis: u forward, v right, w down",
        [k](const R& r) { return r.velocity[k]; });
    add(rates[k], "rad s-1", "angular velocity about a body axis: p forward, q right, r down",
        [k](const R& r) { return r.rates[k]; });
  }
  add("wind_north", "m s-1", "wind at the vehicle", [](const R& r) { return r.wind[0]; });
  add("wind_east", "m s-1", "wind at the vehicle", [](const R& r) { return r.wind[1]; });
  add("wind_up", "m s-1", "wind at the vehicle", [](const R& r) { return r.wind[2] == 0.0 ? 0.0 : -r.wind[2]; });
  for (std::size_t k = 0; k < flight_control_count; ++k) {
    if (!vehicle.ranges[k].given()) continue;
    add(std::string("control_") + name_of(FlightControl(k)), flight_control_units[k], "control as it acts",
        [k](const R& r) { return r.controls.at[k]; });
  }
  add("power_electrical", "W", "mean since the row before, at the terminals", &R::electrical);
  add("power_motor", "W", "mean since the row before, lost in motors and gearboxes", &R::motor);
  add("power_friction", "W", "mean since the row before, lost in mechanism and hinges", &R::friction);
  add("power_aerodynamic", "W", "mean since the row before, from the drives to the air", &R::wing_air);
  add("energy_body", "J", "kinetic and potential energy of the body, over the height 0", &R::body_energy);
  add("energy_stored", "J", "of body and drives", &R::stored_energy);
  if (battery) {
    add("charge", "1", "state of charge of the battery", &R::charge);
    add("voltage_available", "V", "that the battery can give", &R::available);
  }
  return columns;
}

}  // namespace

void write_flight(const FlightFile& file, const FlightRecord& flight, const std::string& input,
                  const std::string& version, const std::filesystem::path& output) {
  NetcdfFile data(output);
  write_provenance(data, {.title = file.title.empty() ? "flight" : file.title,
                          .command = "fly",
                          .version = version,
                          .vehicle = write_design(file.source.design),
                          .study = input,
                          .tolerance = file.plan.tolerance});
  if (file.source.sides) {
    data.set_attribute("vehicle_left", write_design(file.source.sides->left));
    data.set_attribute("vehicle_right", write_design(file.source.sides->right));
  }
  data.set_attribute("outcome", name_of(flight.outcome));
  data.set_attribute("outcome_detail", flight.detail);
  const auto time = data.define_dimension("time", flight.rows.size());
  std::vector<double> values(flight.rows.size());
  const auto put = [&](const std::string& name, const std::string& unit, const std::string& meaning,
                       const std::function<double(const FlightRow&)>& value) {
    for (std::size_t n = 0; n < values.size(); ++n) values[n] = value(flight.rows[n]);
    data.write(data.define_variable(name, {time}, unit, meaning), values);
  };
  put("time", "s", "since the start", &FlightRow::time);
  for (const FlightColumn& c : flight_columns(file.vehicle, has_battery(file.source.design.supply.type))) {
    put(c.name, c.unit, c.meaning, c.value);
  }
  data.close();
}

}  // namespace wingbeat
