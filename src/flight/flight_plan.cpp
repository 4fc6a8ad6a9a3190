#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/flight/fly.hpp"

namespace wingbeat {

FlightReference reference_at(const std::vector<Waypoint>& path, PathInterpolation interpolation, double t) {
  FlightReference at;
  if (path.empty()) return at;
  const auto hold = [&](const Waypoint& w) {
    at.position = w.position;
    at.yaw = w.yaw;
    return at;
  };
  if (t <= path.front().time) return hold(path.front());
  if (t >= path.back().time) return hold(path.back());
  const auto next =
      std::upper_bound(path.begin(), path.end(), t, [](double x, const Waypoint& w) { return x < w.time; });
  const Waypoint &a = *(next - 1), &b = *next;
  const double T = b.time - a.time, x = (t - a.time) / T;
  double share = x, speed = 1.0 / T;
  if (interpolation == PathInterpolation::smooth) {
    share = x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
    speed = 30.0 * square(x * (1.0 - x)) / T;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    at.position[k] = a.position[k] + share * (b.position[k] - a.position[k]);
    at.velocity[k] = speed * (b.position[k] - a.position[k]);
  }
  at.yaw = a.yaw + share * (b.yaw - a.yaw);
  at.yaw_rate = speed * (b.yaw - a.yaw);
  return at;
}

void validate(const FlightPlan& p) {
  const auto require = [](bool ok, const char* key, const char* message) {
    if (!ok) throw ParameterError(key, message);
  };
  const auto between = [](double x, double low, double high) { return x >= low && x <= high; };
  require(between(p.duration, 1e-3, 1e4), "flight.duration", "must be between 1 ms and 1e4 s");
  require(between(p.tolerance, 1e-12, 1e-2), "flight.tolerance", "must be between 1e-12 and 1e-2");
  require(p.sample == 0.0 || between(p.sample, 1e-5, p.duration), "flight.sample",
          "must be at least 10 us and at most the duration");
  require(p.sample == 0.0 || p.duration / p.sample <= 1e6, "flight.sample", "makes more than a million rows");
  require(between(p.max_tilt, 0.1, pi), "limits.tilt", "must be between 5.73 and 180 deg");
  require(p.max_distance > 0.0, "limits.distance", "must be > 0 m");
  require(!p.ground || *p.ground < p.height, "limits.ground", "must be below the height of the start");
  require(p.controller.rate == 0.0 || between(p.controller.rate, 10.0, 1e4), "controller.rate",
          "must be between 10 Hz and 10 kHz");
  require(p.sensors.rate == 0.0 || between(p.sensors.rate, 10.0, 1e4), "sensors.rate",
          "must be between 10 Hz and 10 kHz");
  require(between(p.sensors.delay, 0.0, 0.2), "sensors.delay", "must be between 0 and 200 ms");
  require(!p.sensors.average || between(*p.sensors.average, 0.0, 0.2), "sensors.average",
          "must be between 0 and 200 ms");
  const double total = p.sensors.delay + 0.5 * p.sensors.average.value_or(0.0);
  require(p.controller.type != ControllerType::lqr || total * p.controller.rate <= 50.0, "sensors.delay",
          "takes more than 50 steps of the controller: lower controller.rate");
  for (const double x : {p.sensors.position, p.sensors.velocity, p.sensors.attitude, p.sensors.rates}) {
    require(x >= 0.0, "sensors", "standard deviations must be >= 0");
  }
  const RegulatorSizes& s = p.controller.sizes;
  for (const double x : {s.position, s.heading, s.velocity, s.attitude, s.rates}) {
    require(x > 0.0, "controller.sizes", "must be > 0");
  }
  require(s.controls >= 0.0, "controller.sizes.controls", "must be >= 0");
  require(s.integral >= 0.0, "controller.sizes.integral", "must be >= 0 m s");
  require(p.wind.deviation >= 0.0, "wind.turbulence", "must be >= 0 m/s");
  require(between(p.wind.time_constant, 1e-3, 1e4), "wind.time_constant", "must be between 1 ms and 1e4 s");
  for (const Gust& gust : p.wind.gusts) require(gust.duration > 0.0, "gust.duration", "must be > 0 s");
  for (std::size_t k = 1; k < p.path.size(); ++k) {
    require(p.path[k].time > p.path[k - 1].time, "waypoint.time", "must be later than that of the waypoint before");
  }
}

}  // namespace wingbeat
