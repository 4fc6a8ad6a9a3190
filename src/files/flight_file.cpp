#include "wingbeat/files/flight_file.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string_view>

#include "files/study_sections.hpp"
#include "files/toml_fields.hpp"
#include "wingbeat/files/input_file.hpp"

namespace wingbeat {
namespace {

namespace fs = std::filesystem;

class FlightReader : public detail::StudySections {
 public:
  FlightReader(const fs::path& file, std::string_view text, std::span<const std::string> overrides)
      : StudySections(input_name(file), text, overrides,
                      {"start", "limits", "controller", "sensors", "actuators", "path", "waypoint", "wind", "gust"},
                      {"duration", "sample"}),
        folder_(file.parent_path()) {}

  FlightFile read() {
    attempt([&] { file_.title = read_title(); });
    for (const char* key : {"metrics", "hold", "allow_extrapolation"}) {
      if (const TomlNode* node = study_->find(key)) {
        attempt([&] { refuse(*node, fmt::format("study.{}", key), "does not apply to a flight"); });
      }
    }
    if (!attempt([&] { file_.source = read_sides(folder_); })) finish();
    attempt([&] {
      try {
        file_.vehicle = flight_vehicle(file_.source);
      } catch (const ParameterError& e) {
        refuse_file("study", "vehicle", fmt::format("{}: {}", e.key(), e.reason()));
      }
    });
    attempt([&] { read_study(); });
    section("start", &FlightReader::read_start);
    section("limits", &FlightReader::read_limits);
    section("controller", &FlightReader::read_controller);
    section("sensors", &FlightReader::read_sensors);
    section("actuators", &FlightReader::read_actuators);
    section("wind", &FlightReader::read_wind);
    section("path", &FlightReader::read_path);
    for (const TomlNode& node : sections_of("waypoint")) attempt([&] { read_waypoint({file(), "waypoint", node}); });
    for (const TomlNode& node : sections_of("gust")) attempt([&] { read_gust({file(), "gust", node}); });
    finish();
    check();
    return std::move(file_);
  }

 private:
  void section(const char* name, void (FlightReader::*read)(const TomlFields&)) {
    const TomlNode* node = root_.find(name);
    if (!node) return;
    attempt([&] {
      must_be_section(*node, name);
      (this->*read)({file(), name, *node});
    });
  }

  static void set(const TomlFields& fields, std::string_view key, std::string_view unit, double& x) {
    if (const auto given = fields.quantity(key, unit)) x = *given;
  }
  static void known(const TomlFields& fields, std::initializer_list<std::string_view> keys) {
    fields.known_keys(std::span(keys.begin(), keys.size()));
  }
  static void set_seed(const TomlFields& fields, std::uint64_t& seed) {
    if (const auto given = fields.count("seed", 0)) seed = std::uint64_t(*given);
  }

  void read_study() {
    const TomlFields fields(file(), "study", *study_);
    set(fields, "duration", "s", plan().duration);
    set(fields, "sample", "s", plan().sample);
    set(fields, "tolerance", "1", plan().tolerance);
  }

  void read_start(const TomlFields& fields) {
    known(fields, {"from", "height", "speed", "climb", "roll", "pitch", "yaw", "u", "v", "w", "p", "q", "r"});
    plan().start = fields.choice<FlightStart>("from", FlightStart::trim);
    set(fields, "height", "m", plan().height);
    set(fields, "speed", "m/s", plan().condition.speed);
    set(fields, "climb", "m/s", plan().condition.climb);
    StartDisturbance& by = plan().disturbance;
    constexpr const char *angles[] = {"roll", "pitch", "yaw"}, *speeds[] = {"u", "v", "w"}, *rates[] = {"p", "q", "r"};
    for (std::size_t k = 0; k < 3; ++k) {
      set(fields, angles[k], "rad", by.angles[k]);
      set(fields, speeds[k], "m/s", by.velocity[k]);
      set(fields, rates[k], "rad/s", by.rates[k]);
    }
  }

  void read_limits(const TomlFields& fields) {
    known(fields, {"ground", "tilt", "distance"});
    plan().ground = fields.quantity("ground", "m");
    set(fields, "tilt", "rad", plan().max_tilt);
    set(fields, "distance", "m", plan().max_distance);
  }

  void read_controller(const TomlFields& fields) {
    known(fields, {"type", "rate", "max_tilt", "max_speed", "sizes", "bandwidths", "gains", "held"});
    ControllerOptions& c = plan().controller;
    c.type = fields.choice<ControllerType>("type", ControllerType::lqr);
    set(fields, "rate", "Hz", c.rate);
    set(fields, "max_tilt", "rad", c.max_tilt);
    set(fields, "max_speed", "m/s", c.max_speed);
    const auto only = [&](const char* key, ControllerType type) {
      if (fields.has(key) && c.type != type) {
        fields.refuse(fields.at(key), key, fmt::format("is for type = \"{}\"", name_of(type)));
      }
      return fields.table(key);
    };
    if (const auto sizes = only("sizes", ControllerType::lqr)) {
      known(*sizes, {"position", "heading", "velocity", "attitude", "rates", "integral", "controls"});
      set(*sizes, "position", "m", c.sizes.position);
      set(*sizes, "heading", "rad", c.sizes.heading);
      set(*sizes, "velocity", "m/s", c.sizes.velocity);
      set(*sizes, "attitude", "rad", c.sizes.attitude);
      set(*sizes, "rates", "rad/s", c.sizes.rates);
      set(*sizes, "integral", "1", c.sizes.integral);
      set(*sizes, "controls", "1", c.sizes.controls);
    }
    if (const auto bandwidths = only("bandwidths", ControllerType::pid)) {
      known(*bandwidths, {"position", "velocity", "attitude", "rates"});
      for (const auto& [key, loop] : {std::pair("position", &c.bandwidths.position),
                                      {"velocity", &c.bandwidths.velocity},
                                      {"attitude", &c.bandwidths.attitude},
                                      {"rates", &c.bandwidths.rates}}) {
        *loop = bandwidths->quantity(key, "rad/s");
        if (*loop && !(**loop > 0.0)) bandwidths->refuse(bandwidths->at(key), key, "must be > 0 rad/s");
      }
    }
    if (const auto gains = only("gains", ControllerType::pid)) read_gains(*gains);
    if (const auto held = only("held", ControllerType::none)) {
      plan().held = FlightControls{};
      read_controls(*held, plan().held->at, [](std::size_t k) { return std::string(flight_control_units[k]); });
    }
  }

  void read_gains(const TomlFields& fields) {
    known(fields, {"climb", "pitch", "roll", "yaw"});
    for (std::size_t a = 0; a < flight_axis_count; ++a) {
      const auto axis = fields.table(name_of(FlightAxis(a)));
      if (!axis) continue;
      known(*axis, {"proportional", "integral", "derivative"});
      LoopGains& loop = plan().controller.gains[a];
      loop.proportional = axis->quantity("proportional", "1");
      loop.integral = axis->quantity("integral", "1");
      loop.derivative = axis->quantity("derivative", "1");
    }
  }

  /// A number for each control that the vehicle has.
  template <class Unit>
  void read_controls(const TomlFields& fields, std::array<double, flight_control_count>& into, const Unit& unit) {
    std::vector<std::string_view> names;
    for (std::size_t k = 0; k < flight_control_count; ++k) {
      const char* name = name_of(FlightControl(k));
      names.push_back(name);
      if (fields.has(name) && !file_.vehicle.ranges[k].given()) {
        fields.refuse(fields.at(name), name, "the vehicle does not have this control");
      }
      set(fields, name, unit(k), into[k]);
    }
    fields.known_keys(names);
  }

  void read_sensors(const TomlFields& fields) {
    known(fields, {"rate", "delay", "average", "position", "velocity", "attitude", "rates", "seed"});
    FlightSensors& s = plan().sensors;
    set(fields, "rate", "Hz", s.rate);
    set(fields, "delay", "s", s.delay);
    s.average = fields.quantity("average", "s");
    set(fields, "position", "m", s.position);
    set(fields, "velocity", "m/s", s.velocity);
    set(fields, "attitude", "rad", s.attitude);
    set(fields, "rates", "rad/s", s.rates);
    set_seed(fields, s.seed);
  }

  void read_actuators(const TomlFields& fields) {
    known(fields, {"time_constant", "rate_limit"});
    if (const auto lags = fields.table("time_constant")) {
      read_controls(*lags, plan().actuators.time_constant, [](std::size_t) { return std::string("s"); });
    }
    if (const auto limits = fields.table("rate_limit")) {
      read_controls(*limits, plan().actuators.rate_limit, [](std::size_t k) {
        const std::string unit = flight_control_units[k];
        return unit == "1" ? std::string("1/s") : unit + "/s";
      });
    }
  }

  /// north, east and up, as earth axes with z down.
  static void read_vector(const TomlFields& fields, Triple& into) {
    double up = 0.0;
    set(fields, "north", "m/s", into[0]);
    set(fields, "east", "m/s", into[1]);
    set(fields, "up", "m/s", up);
    into[2] = -up;
  }

  void read_wind(const TomlFields& fields) {
    known(fields, {"north", "east", "up", "turbulence", "time_constant", "seed"});
    read_vector(fields, plan().wind.steady);
    set(fields, "turbulence", "m/s", plan().wind.deviation);
    set(fields, "time_constant", "s", plan().wind.time_constant);
    set_seed(fields, plan().wind.seed);
  }

  void read_gust(const TomlFields& fields) {
    known(fields, {"start", "duration", "north", "east", "up"});
    Gust gust;
    gust.start = fields.needed_quantity("start", "s");
    gust.duration = fields.needed_quantity("duration", "s");
    if (!(gust.duration > 0.0)) fields.refuse(fields.at("duration"), "duration", "must be > 0 s");
    read_vector(fields, gust.velocity);
    plan().wind.gusts.push_back(gust);
  }

  void read_path(const TomlFields& fields) {
    known(fields, {"interpolation"});
    plan().interpolation = fields.choice<PathInterpolation>("interpolation", PathInterpolation::smooth);
  }

  void read_waypoint(const TomlFields& fields) {
    known(fields, {"time", "x", "y", "height", "yaw"});
    Waypoint w;
    w.time = fields.needed_quantity("time", "s");
    if (!plan().path.empty() && !(w.time > plan().path.back().time)) {
      fields.refuse(fields.at("time"), "time", "must be later than that of the waypoint before");
    }
    double height = plan().path.empty() ? plan().height : -plan().path.back().position[2];
    set(fields, "x", "m", w.position[0]);
    set(fields, "y", "m", w.position[1]);
    set(fields, "height", "m", height);
    set(fields, "yaw", "rad", w.yaw);
    w.position[2] = -height;
    plan().path.push_back(w);
  }

  /// What the plan itself refuses, at its key where the file has it.
  void check() {
    try {
      validate(plan());
    } catch (const ParameterError& e) {
      std::string key = e.key();
      if (key.starts_with("flight.")) key = "study." + key.substr(7);
      const TomlNode* node = &root_;
      for (std::string_view rest = key; node && !rest.empty();) {
        const std::size_t dot = std::min(rest.find('.'), rest.size());
        const TomlNode* below = node->kind == detail::Kind::table ? node->find(rest.substr(0, dot)) : nullptr;
        if (!below) break;
        node = below;
        rest.remove_prefix(std::min(dot + 1, rest.size()));
      }
      if (node == &root_) refuse(place_of(*study_), key, e.reason());
      refuse(*node, key, e.reason());
    }
  }

  FlightPlan& plan() { return file_.plan; }

  fs::path folder_;
  FlightFile file_;
};

}  // namespace

FlightVehicle flight_vehicle(const VehicleFile& file) {
  if (file.sides) return flight_vehicle(file.design, &file.sides->right, &file.sides->left);
  return flight_vehicle(file.design);
}

FlightFile read_flight_file(const fs::path& file, std::span<const std::string> overrides) {
  return FlightReader(file, read_text_file(file), overrides).read();
}

}  // namespace wingbeat
