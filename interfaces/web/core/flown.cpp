#include "flown.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "flight/flight_run.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/parts/planform.hpp"
#include "wingbeat/vehicle/dynamics.hpp"

namespace wingbeat::web {
namespace {

constexpr double rows_of_wingbeat = 24.0, longest_flight = 600.0, stations = 24.0;

/// Earth axes have z down; a page has north, east and up.
Triple upwards(const Triple& v) { return {v[0], v[1], -v[2]}; }

Triple triple_of(const nlohmann::json& object, const std::array<const char*, 3>& names) {
  return {object.value(names[0], 0.0), object.value(names[1], 0.0), object.value(names[2], 0.0)};
}
Triple wind_in(const nlohmann::json& object) { return upwards(triple_of(object, {"north", "east", "up"})); }
Triple velocity_in(const nlohmann::json& object) { return triple_of(object, {"u", "v", "w"}); }
Triple rates_in(const nlohmann::json& object) { return triple_of(object, {"p", "q", "r"}); }

/// Rows as columns, in the order in which a row names them.
class Recorder {
 public:
  void add(const FlightRow& row, const FlightSimulation& simulation) {
    next_ = 0;
    put("time_s", row.time);
    put_all({"north_m", "east_m", "height_m"}, upwards(row.position));
    put_all({"roll_rad", "pitch_rad", "yaw_rad"}, row.angles);
    put_all({"u_m_per_s", "v_m_per_s", "w_m_per_s"}, row.velocity);
    put_all({"p_rad_per_s", "q_rad_per_s", "r_rad_per_s"}, row.rates);
    put("electrical_w", row.electrical);
    put_all({"aim_north_m", "aim_east_m", "aim_height_m"}, upwards(row.reference.position));
    put("aim_yaw_rad", row.reference.yaw);
    const FlightVehicle& vehicle = simulation.vehicle();
    for (std::size_t k = 0; k < flight_control_count; ++k) {
      if (vehicle.ranges[k].given()) put(name_of(FlightControl(k)), row.controls.at[k]);
    }
    const FlightState state = simulation.state();
    std::size_t wing = 0;
    for (std::size_t n = 0; n < vehicle.drives.size(); ++n) {
      put("voltage_" + std::to_string(n) + "_v", voltage_of(vehicle.drives[n], row.controls));
      add_wings(vehicle.drives[n], row.controls, state.drives[n], wing);
    }
  }
  Columns taken() { return std::exchange(columns_, {}); }

 private:
  void add_wings(const FlightDrive& drive, const FlightControls& controls, const Coordinates<double>& now,
                 std::size_t& wing) {
    OnsetFlow flow = drive.flow;
    set_mounts(drive, controls, flow);
    const auto k = configuration_at_angle(drive.vehicle, now.angle).kinematics;
    const double stroke = stroke_angle_at(drive.vehicle, k, now.angle), velocity = k.stroke_slope * now.speed;
    for (std::size_t m = 0; m < flow.count; ++m, ++wing) {
      const WingMount& mount = flow.mounts[m];
      const std::string ending = "_" + std::to_string(wing) + "_rad";
      put("stroke" + ending, mount.sense * stroke + mount.mean_angle);
      put("plane" + ending, mount.tilt);
      put("chord" + ending, mount.sense * pitch_of(drive.vehicle, mount, now, velocity));
    }
  }
  /// By which the chord is turned ahead, of a wing that flaps with the stroke angle [rad].
  static double pitch_of(const Vehicle<double>& v, const WingMount& mount, const Coordinates<double>& now,
                         double velocity) {
    if (pitches(v)) return now.pitch_angle;
    const double alpha = aero_loads(v.wings, std::abs(velocity)).angle_of_attack;
    return std::copysign(1.0, velocity) * (alpha - 0.5 * pi + mount.incidence);
  }
  void put(const std::string& name, double x) {
    if (next_ == columns_.size()) columns_.emplace_back(name, std::vector<double>{});
    columns_[next_++].second.push_back(x);
  }
  void put_all(const std::array<const char*, 3>& names, const Triple& v) {
    for (std::size_t k = 0; k < 3; ++k) put(names[k], v[k]);
  }

  Columns columns_;
  std::size_t next_ = 0;
};

struct Airborne {
  FlightVehicle vehicle;
  Recorder recorder;
  std::optional<detail::FlightRun> run;
};
std::unique_ptr<Airborne> airborne;

/// Reached as soon as either controller follows without tipping over, unless `within` says when.
Waypoint waypoint_of(const nlohmann::json& aim, const detail::FlightRun& run) {
  constexpr double speed = 0.3, acceleration = 1.5, turn_rate = 1.0, shortest = 0.3;
  const double now = run.simulation().time();
  const FlightReference from = run.reference(now);
  Waypoint there{now, upwards(triple_of(aim, {"north", "east", "height"})), aim.value("yaw", 0.0)};
  double far = 0.0;
  for (std::size_t k = 0; k < 3; ++k) far = std::hypot(far, there.position[k] - from.position[k]);
  const double of_least_jerk = 10.0 / std::sqrt(3.0);  // its largest acceleration, of a unit of way in a unit of time
  const double takes = std::max({shortest, far / speed, std::sqrt(of_least_jerk * far / acceleration),
                                 std::abs(there.yaw - from.yaw) / turn_rate});
  there.time += aim.value("within", takes);
  return there;
}

FlightPlan plan_of(const nlohmann::json& options) {
  FlightPlan plan;
  plan.duration = longest_flight;
  plan.height = options.value("height", 1.0);
  plan.ground = 0.0;
  plan.controller.type =
      from_name<ControllerType>(options.value("controller", std::string("lqr"))).value_or(ControllerType::lqr);
  if (options.contains("wind")) plan.wind.steady = wind_in(options["wind"]);
  if (options.contains("start")) {
    plan.disturbance.velocity = velocity_in(options["start"]);
    plan.disturbance.rates = rates_in(options["start"]);
  }
  return plan;
}

void describe_vehicle(const Design<double>& design, const FlightVehicle& vehicle, FlightBegun& begun) {
  begun.amplitude = vehicle.direct;
  for (std::size_t k = 0; k < flight_control_count; ++k) {
    const ControlRange& range = vehicle.ranges[k];
    if (!range.given()) continue;
    begun.controls.push_back(
        {name_of(FlightControl(k)), flight_control_units[k], begun.trim.controls.at[k], range.low, range.high});
  }
  for (const FlightDrive& drive : vehicle.drives) {
    for (std::size_t m = 0; m < drive.flow.count; ++m) {
      const WingMount& mount = drive.flow.mounts[m];
      begun.wings.push_back({mount.side, mount.sense, mount.shoulder});
    }
  }
  const Planform<double>& planform = design.wing.planform;
  const double length = length_of(planform), hub = hub_offset_of(planform);
  for (double n = 0.0; n <= stations; n += 1.0) {
    begun.outline.push_back({hub + length * n / stations, chord_at(planform, n / stations)});
  }
}

}  // namespace

FlightBegun begin_flight(const Design<double>& design, const nlohmann::json& options) {
  airborne = std::make_unique<Airborne>();
  Airborne& flight = *airborne;
  flight.vehicle = flight_vehicle(design);
  detail::ReadyFlight ready = detail::ready_flight(flight.vehicle, plan_of(options));
  FlightBegun begun;
  begun.trim = ready.trim;
  begun.detail = ready.trim.detail;
  begun.controller = ready.plan.controller.type;
  begun.height = ready.plan.height;
  describe_vehicle(design, flight.vehicle, begun);
  if (!ready.controller) return begun;
  begun.control_rate = ready.plan.controller.rate;
  begun.delay = ready.controller->design().delay;
  begun.uncontrolled = ready.controller->design().uncontrolled;
  begun.row_period = ready.plan.sample = 1.0 / (rows_of_wingbeat * ready.trim.frequency);
  flight.run.emplace(flight.vehicle, std::move(ready),
                     [&flight](const FlightRow& row, const FlightSimulation& now) { flight.recorder.add(row, now); });
  return begun;
}

FlightPiece fly_on(const nlohmann::json& wish, Columns& columns) {
  if (!airborne || !airborne->run) throw std::runtime_error("no flight has been started");
  detail::FlightRun& run = *airborne->run;
  if (wish.contains("aim")) {
    const nlohmann::json& aim = wish["aim"];
    run.go(waypoint_of(aim, run));
  }
  if (wish.contains("wind")) run.blow(wind_in(wish["wind"]));
  if (wish.contains("push")) run.push(velocity_in(wish["push"]), rates_in(wish["push"]));
  FlightPiece piece;
  piece.flies = run.fly_to(wish.value("until", 0.0));
  if (!piece.flies) run.record_end();
  piece.time = run.simulation().time();
  piece.outcome = run.outcome();
  piece.detail = run.detail();
  if (run.battery().there()) piece.charge = run.battery().charge();
  columns = airborne->recorder.taken();
  return piece;
}

}  // namespace wingbeat::web
