#include "wingbeat/study/allocation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "wingbeat/cycle/wing_loads.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

constexpr double point_tolerance = 1e-9;  ///< relative, of the cycle behind a point
constexpr int max_halvings = 8;           ///< of the step of a map, where it has a kink within

/// Cycle means of half of the wings, as those of the right side; or their derivatives.
struct SideMeans {
  double lift = absent;           ///< [N]
  double lift_sideways = absent;  ///< lift times d + r cos beta [N m]
  double lift_forward = absent;   ///< lift times r sin beta [N m]
  double yaw = absent;            ///< of the drag [N m]
  double frequency = absent;      ///< [Hz]
};

/// Right and left.
using BothSides = std::array<SideMeans, 2>;

AllocationPoint point_of(double input, const BothSides& sides) {
  const auto& [right, left] = sides;
  return {input,
          right.lift + left.lift,
          left.lift_sideways - right.lift_sideways,
          right.lift_forward + left.lift_forward,
          right.yaw - left.yaw,
          left.frequency};
}

/// What an input does to either side.
struct InputOfSides {
  DriveInput which;
  double right, left;  ///< how much of it
};

InputOfSides effect_of(AllocationInput which) {
  switch (which) {
    case AllocationInput::voltage: return {DriveInput::voltage, 1.0, 1.0};
    case AllocationInput::differential_voltage: return {DriveInput::voltage, -0.5, 0.5};
    case AllocationInput::bias_voltage: return {DriveInput::bias, 1.0, 1.0};
    case AllocationInput::split_cycle: return {DriveInput::split, 1.0, -1.0};
    case AllocationInput::split_cycle_cosine: return {DriveInput::cosine_split, 1.0, -1.0};
  }
  return {};
}

DriveWave<double> wave_of(DriveInput which, double value) {
  DriveWave<double> wave;
  switch (which) {
    case DriveInput::voltage: break;
    case DriveInput::bias: wave.bias = value; break;
    case DriveInput::split: wave.split = value; break;
    case DriveInput::cosine_split: wave.cosine_split = value; break;
  }
  return wave;
}

/// One side's wings, or half of all where both sides are alike.
class Side {
 public:
  /// `share`: of the wings that were linearised.
  Side(const Linearisation& linearisation, double hinge_offset, double share)
      : orbit_(linearisation.orbit.record),
        reporting_(reporting_of(linearisation.operating_point.design)),
        hinge_offset_(hinge_offset),
        share_(share),
        slopes_(wing_load_slopes(orbit_)) {
    vehicle_ = orbit_.vehicle();
    vehicle_.thermal = {};  // the record's motor is as warm as it gets
    const double s2 = vehicle_.wings.s2;
    centre_ = s2 > 0.0 ? vehicle_.wings.s3 / s2 : 0.0;
    at_orbit_ = means_of(wing_loads(orbit_));
    by_voltage_[key_of(vehicle_.voltage)] = at_orbit_;
  }

  const Vehicle<double>& vehicle() const { return vehicle_; }
  double arm() const { return hinge_offset_ + centre_; }

  /// Where an input of the drive is changed by each of these; those of the wave are symmetrical about 0.
  std::vector<SideMeans> over(DriveInput which, const std::vector<double>& changes) {
    if (which != DriveInput::voltage) return under_waves(which, changes);
    std::vector<SideMeans> means;
    for (const double change : changes) means.push_back(at(which, change));
    return means;
  }

  /// By itself, followed from the operating point.
  SideMeans at(DriveInput which, double change) {
    return which == DriveInput::voltage ? at_voltage(vehicle_.voltage + change) : under_wave(which, change);
  }

  SideMeans slope(DriveInput which, double by) const {
    const SideMeans m = means_of(slopes_[std::size_t(which)]);
    const auto no_minus = [](double x) { return x == 0.0 ? 0.0 : x; };
    return {no_minus(by * m.lift), no_minus(by * m.lift_sideways), no_minus(by * m.lift_forward), no_minus(by * m.yaw),
            no_minus(by * m.frequency)};
  }

 private:
  static long long key_of(double voltage) { return std::llround(1e12 * voltage); }

  SideMeans means_of(const WingLoads& all) const {
    const auto load = [&](WingLoad which) { return all[std::size_t(which)]; };
    const double r = centre_, per_r = hinge_offset_ / std::max(centre_, 1e-300);
    // The drag M_aero / r acts against beta' at p = (0, d, 0) + r e_r.
    return {share_ * load(WingLoad::lift),
            share_ * (hinge_offset_ * load(WingLoad::lift) + r * load(WingLoad::lift_sideways)),
            share_ * r * load(WingLoad::lift_forward),
            share_ * (load(WingLoad::moment) + (r > 0.0 ? per_r * load(WingLoad::moment_sideways) : 0.0)),
            load(WingLoad::frequency)};
  }

  /// In steady flapping at that voltage or amplitude [V], the motor as warm as at the operating point.
  SideMeans at_voltage(double voltage) {
    const auto known = by_voltage_.find(key_of(voltage));
    if (known != by_voltage_.end()) return known->second;
    SideMeans means;
    Vehicle<double> there = vehicle_;
    there.voltage = voltage;
    const SteadyFlapping found = find_steady_flapping(there, {point_tolerance, false, reporting_}, start_up_in_time());
    if (found.status == FlappingStatus::flapping && !found.record.empty()) means = means_of(wing_loads(found.record));
    by_voltage_[key_of(voltage)] = means;
    return means;
  }

  /// Of a direct drive at the operating point's amplitude and frequency, its wave changed by each of the inputs, which
  /// are symmetrical about 0: followed from there to either end.
  std::vector<SideMeans> under_waves(DriveInput which, const std::vector<double>& inputs) const {
    std::vector<SideMeans> means(inputs.size(), at_orbit_);
    const int middle = int(inputs.size()) / 2;
    for (const int way : {1, -1}) {
      std::vector<double> near;
      for (int n = middle + way; n >= 0 && n < int(inputs.size()); n += way) {
        const auto found = loads_under_wave(orbit_, wave_of(which, inputs[std::size_t(n)]), near);
        means[std::size_t(n)] = found ? means_of(found->loads) : SideMeans{};
        near = found ? found->start : std::vector<double>{};
      }
    }
    return means;
  }

  SideMeans under_wave(DriveInput which, double input) {
    const auto [entry, added] = by_wave_.try_emplace({which, std::llround(1e12 * input)});
    if (added) {
      if (const auto found = loads_under_wave(orbit_, wave_of(which, input))) entry->second = means_of(found->loads);
    }
    return entry->second;
  }

  Vehicle<double> vehicle_;
  const CycleRecord& orbit_;
  Reporting reporting_;
  double hinge_offset_, share_, centre_;
  WingLoadSlopes slopes_;
  SideMeans at_orbit_;
  std::map<long long, SideMeans> by_voltage_;
  std::map<std::pair<DriveInput, long long>, SideMeans> by_wave_;
};

class Sides {
 public:
  /// Of a vehicle whose sides are alike.
  Sides(const Linearisation& both, double hinge_offset) : right_(both, hinge_offset, 0.5) {}
  Sides(const Linearisation& left, const Linearisation& right, double hinge_offset)
      : right_(right, hinge_offset, 1.0), own_left_(std::in_place, left, hinge_offset, 1.0) {}

  const Vehicle<double>& vehicle() const { return right_.vehicle(); }
  double arm() const { return right_.arm(); }
  bool two() const { return own_left_ || right_.vehicle().motors == 2.0; }
  double centre_of(AllocationInput which) const {
    return which == AllocationInput::voltage ? right_.vehicle().voltage : 0.0;
  }

  std::vector<AllocationPoint> points(AllocationInput which, const std::vector<double>& inputs) {
    const InputOfSides effect = effect_of(which);
    const auto over = [&](Side& side, double share) {
      std::vector<double> changes;
      for (const double input : inputs) changes.push_back(share * (input - centre_of(which)));
      return side.over(effect.which, changes);
    };
    const std::vector<SideMeans> right = over(right_, effect.right);
    const std::vector<SideMeans> left = alike(effect) ? right : over(this->left(), effect.left);
    std::vector<AllocationPoint> points;
    for (std::size_t n = 0; n < inputs.size(); ++n) points.push_back(point_of(inputs[n], {right[n], left[n]}));
    return points;
  }

  /// A point by itself, followed from the operating point.
  AllocationPoint point(AllocationInput which, double input) {
    const InputOfSides effect = effect_of(which);
    const double change = input - centre_of(which);
    const SideMeans right = right_.at(effect.which, effect.right * change);
    return point_of(input, {right, alike(effect) ? right : left().at(effect.which, effect.left * change)});
  }

  AllocationPoint slope(AllocationInput which) {
    const InputOfSides effect = effect_of(which);
    return point_of(centre_of(which),
                    {right_.slope(effect.which, effect.right), left().slope(effect.which, effect.left)});
  }

 private:
  Side& left() { return own_left_ ? *own_left_ : right_; }
  bool alike(const InputOfSides& effect) const { return !own_left_ && effect.left == effect.right; }

  Side right_;
  std::optional<Side> own_left_;
};

/// The operating point and those one and two steps to either side.
struct PointsAround {
  AllocationPoint scale;  ///< of the quantities, also of those that a symmetry makes zero
  double step;
  AllocationPoint far_below, below, centre, above, far_above;
};

/// Sets a quantity's slope from points, its error and the step; whether the exact slope is within that error.
bool set_slope_of_points(AllocationMap& map, const PointsAround& p, double AllocationPoint::* member) {
  const double h = p.step, centre = p.centre.*member;
  const double near = (p.above.*member - p.below.*member) / (2.0 * h);
  const double far = (p.far_above.*member - p.far_below.*member) / (4.0 * h);
  // Where the map has a kink within the nearer step, the curvatures that both pairs show differ.
  const double near_curvature = (p.above.*member - 2.0 * centre + p.below.*member) / (h * h);
  const double far_curvature = (p.far_above.*member - 2.0 * centre + p.far_below.*member) / (4.0 * h * h);
  const double rounding = 2.0 * point_tolerance * p.scale.*member / h;
  map.slope_of_points.*member = (4.0 * near - far) / 3.0;
  map.slope_of_points_error.*member = std::abs(near - far) + h * std::abs(near_curvature - far_curvature) + rounding;
  map.slope_of_points_step.*member = h;
  const double slope = map.slope.*member;
  return std::isnan(slope) || std::abs(slope - map.slope_of_points.*member) <= map.slope_of_points_error.*member;
}

/// Fills in the slopes that points around the operating point, number `middle` of the map, give. `point_at` computes
/// one that the map does not have.
template <class PointAt>
void set_slopes_of_points(AllocationMap& map, std::size_t middle, double arm, const PointAt& point_at) {
  const AllocationPoint* middle_point = &map.points[middle];
  const double lift = std::abs(middle_point->lift), moment = arm * lift;
  PointsAround around{{0.0, lift, moment, moment, moment, middle_point->frequency},
                      (middle_point + 1)->input - middle_point->input,
                      middle_point[-2],
                      middle_point[-1],
                      middle_point[0],
                      middle_point[1],
                      middle_point[2]};
  map.slope_of_points.input = map.slope_of_points_error.input = map.slope_of_points_step.input = map.slope.input;
  std::vector<double AllocationPoint::*> open;
  for (const AllocationColumn& column : allocation_columns) open.push_back(column.member);
  for (int halvings = 0;; ++halvings) {
    std::erase_if(open, [&](double AllocationPoint::* member) { return set_slope_of_points(map, around, member); });
    if (open.empty() || halvings == max_halvings) return;
    const double step = 0.5 * around.step, centre = map.slope.input;
    around = {around.scale, step, around.below, point_at(centre - step), around.centre, point_at(centre + step),
              around.above};
  }
}

std::vector<double> even_inputs(double low, double high, int count) {
  std::vector<double> inputs;
  for (int n = 0; n < count; ++n) inputs.push_back(low + (high - low) * double(n) / double(count - 1));
  return inputs;
}

std::vector<AllocationMap> maps_of(Sides& sides) {
  std::vector<AllocationMap> maps;
  const double voltage = sides.vehicle().voltage;
  const bool direct = drive_of(sides.vehicle()).alternating, two = sides.two();
  const auto add = [&](AllocationInput which, double low, double high, int count, int middle) {
    AllocationMap map{which, sides.points(which, even_inputs(low, high, count)), sides.slope(which), {}, {}, {}};
    set_slopes_of_points(map, std::size_t(middle), sides.arm(),
                         [&](double input) { return sides.point(which, input); });
    maps.push_back(std::move(map));
  };
  add(AllocationInput::voltage, 0.5 * voltage, 1.3 * voltage, 17, 10);
  if (two) add(AllocationInput::differential_voltage, -0.5 * voltage, 0.5 * voltage, 11, 5);
  if (direct) add(AllocationInput::bias_voltage, -0.2 * voltage, 0.2 * voltage, 9, 4);
  if (direct && two) {
    add(AllocationInput::split_cycle, -0.3, 0.3, 7, 3);
    add(AllocationInput::split_cycle_cosine, -0.3, 0.3, 7, 3);
  }
  return maps;
}

}  // namespace

std::vector<AllocationMap> allocation_maps(const Linearisation& linearisation, double hinge_offset) {
  if (!linearisation.model) return {};
  Sides sides(linearisation, hinge_offset);
  return maps_of(sides);
}

std::vector<AllocationMap> allocation_maps(const Linearisation& left, const Linearisation& right, double hinge_offset) {
  if (!left.model || !right.model) return {};
  Sides sides(left, right, hinge_offset);
  return maps_of(sides);
}

std::vector<AllocationPoint> allocation_points(const Linearisation& linearisation, AllocationInput which,
                                               const std::vector<double>& inputs, double hinge_offset) {
  if (!linearisation.model) return {};
  Sides sides(linearisation, hinge_offset);
  return sides.points(which, inputs);
}

}  // namespace wingbeat
