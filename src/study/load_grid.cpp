#include "wingbeat/study/load_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wingbeat/core/status.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

constexpr double margin = 1.2;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The largest magnitude over a motion.
template <class Value>
double largest(std::span<const WingInstant> motion, const Value& value) {
  double found = 0.0;
  for (const WingInstant& w : motion) found = std::max(found, std::abs(value(w)));
  return found;
}

/// `count` values, an odd number of them, from -limit to limit with 0 among them.
std::vector<double> to_either_side(double limit, int count) {
  const int half = std::max(1, count / 2);
  std::vector<double> values;
  for (int k = -half; k <= half; ++k) values.push_back(limit * k / half);
  return values;
}

void require_plain_air(const Vehicle<double>& v) {
  const BladeElement<double>& w = v.wings;
  const struct {
    bool given;
    const char* key;
  } without_table[] = {{is_given(w.tabulated), load_table_key::type},
                       {has_induced_velocity(w.wake), induced_velocity_key::share.path},
                       {claps(w.clap), clap_and_fling_key::amplitude.path},
                       {twists(v.pitch.torsion), torsion_key::stiffness.path}};
  for (const auto& [given, key] : without_table) {
    if (given) throw ParameterError(key, "does not apply to a table of loads; leave it out to write one");
  }
}

}  // namespace

std::vector<LoadTable::Row> load_grid(const Vehicle<double>& v, std::span<const WingInstant> motion, int count) {
  require_plain_air(v);
  const double fastest = margin * largest(motion, [](const WingInstant& w) { return w.stroke.velocity; });
  std::vector<LoadTable::Row> rows;
  for (int k = 0; k < count; ++k) {
    const double velocity = fastest * k / (count - 1);
    if (!pitches(v)) {
      const AeroLoads<double> loads = aero_loads(v.wings, velocity);
      rows.push_back({none, velocity, none, none, loads.lift, loads.moment, none});
      continue;
    }
    const double pitch = margin * largest(motion, [](const WingInstant& w) { return w.pitch.value; });
    const double turn = margin * largest(motion, [](const WingInstant& w) { return w.pitch.velocity; });
    for (const double psi : to_either_side(pitch, count)) {
      for (const double psi_velocity : to_either_side(turn, count / 3)) {
        const PitchState<double> state = pitch_state(psi, psi_velocity, velocity);
        const PitchAeroLoads<double> loads = aero_loads(v.wings, v.pitch, state, 1.0, psi_velocity < 0.0 ? -1.0 : 1.0);
        const double lift = loads.tangential_lift - loads.normal_force * state.sin_psi;
        rows.push_back({none, velocity, psi, psi_velocity, lift, loads.stroke_moment, loads.pitch_moment});
      }
    }
  }
  return rows;
}

}  // namespace wingbeat
