// Loads of the air from a table over the motion of the wings, as CFD or a rig gives them, in place of blade elements;
// model.md section 17.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "wingbeat/core/names.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"

namespace wingbeat {

/// What the loads of a table depend on, in the order of its rows.
enum class LoadCoordinate { stroke_angle, flapping_velocity, pitch_angle, pitch_velocity };
inline constexpr std::size_t load_coordinate_count = 4;
/// Lift, moment about the stroke axis, moment about the pitch axis.
inline constexpr std::size_t table_load_count = 3;

/// A table of loads on a grid, interpolated by cubics between its lines. Along a line a cubic has the slopes of
/// parabolas through three points, limited so that it is monotone where the data are (Fritsch and Carlson, SIAM J.
/// Numer. Anal. 17, 1980); across several coordinates it is the tensor product, with continuous first derivatives.
/// Beyond the grid the loads go on linearly.
class LoadTable {
 public:
  /// Coordinates [rad, rad/s, rad, rad/s], then lift [N] and the moments that oppose positive velocities [N m]. What a
  /// table does not have is not a number.
  static constexpr std::size_t columns = load_coordinate_count + table_load_count;
  using Row = std::array<double, columns>;

  /// Rows in any order, which make a grid in the coordinates that have more than one value. Where the flapping velocity
  /// has no negative values, both half-strokes are alike, as mirror images. Throws ParameterError with the row or the
  /// place that is wrong.
  explicit LoadTable(const std::vector<Row>& rows);

  struct Axis {
    LoadCoordinate coordinate;
    std::vector<double> knots;  ///< growing, two or more
    std::size_t stride;         ///< nodes from one knot to the next
  };
  const std::vector<Axis>& axes() const { return axes_; }
  /// Null where the loads do not depend on it.
  const Axis* axis(LoadCoordinate coordinate) const;
  bool has_pitch_moment() const { return has_pitch_moment_; }
  /// The whole grid, both half-strokes, coordinates without an axis and absent loads as 0.
  std::vector<Row> rows() const;

  /// The loads at a node, and their derivatives along the axes whose bits are set in `along`.
  const std::array<double, table_load_count>& at(std::size_t node, std::size_t along) const {
    return values_[(node << axes_.size()) + along];
  }

 private:
  void check_rest() const;
  void find_slopes();

  std::vector<Axis> axes_;
  std::vector<std::array<double, table_load_count>> values_;  ///< of each node, by derivative
  bool has_pitch_moment_ = false;
};

/// A vehicle's table.
template <Scalar S>
struct TabulatedLoads {
  /// SIMD lanes have none.
  using Table = std::conditional_t<ScalarTraits<S>::reads_tables, std::shared_ptr<const LoadTable>, std::nullptr_t>;

  Table table = nullptr;
  /// \f$\rho\, N_\mathrm{w} / (\rho_\mathrm{t} N_\mathrm{t})\f$, the density of the air and the number of wings over
  /// those of the table [1]
  S factor = S(1.0);

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.table, self.factor);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace load_table_key {
inline constexpr const char* type = "aerodynamics.type";
inline constexpr const char* file = "aerodynamics.file";
inline constexpr const char* rows = "aerodynamics.load_table";
inline constexpr ParameterKey air_density{"aerodynamics.table_air_density", "kg/m3", range::positive};
inline constexpr ParameterKey wings{"aerodynamics.table_wings", "1", range::positive};
}  // namespace load_table_key

template <Scalar S>
bool is_given(const TabulatedLoads<S>& loads) {
  return loads.table != nullptr;
}

/// Whether loads depend on where the stroke is.
template <Scalar S>
bool knows_stroke_angle(const TabulatedLoads<S>& loads) {
  if constexpr (ScalarTraits<S>::reads_tables) {
    return loads.table && loads.table->axis(LoadCoordinate::stroke_angle) != nullptr;
  }
  return false;
}

/// The motion of the wings at an instant, in the order of LoadCoordinate [rad, rad/s, rad, rad/s].
template <Scalar S>
using WingPlace = std::array<S, load_coordinate_count>;

/// Loads of all wings, as a table has them.
template <Scalar S>
struct TableLoads {
  S lift = S(0.0);           ///< [N]
  S stroke_moment = S(0.0);  ///< [N m]
  S pitch_moment = S(0.0);   ///< [N m]
};

namespace detail {

/// Of one axis at a place: the knot below, and what value and slope at that knot and at the next count for.
template <Scalar S>
struct HermiteWeights {
  std::size_t knot;
  std::array<S, 4> weight;  ///< value and slope [unit of the axis] below, then above
};
template <Scalar S>
HermiteWeights<S> hermite_weights(const std::vector<double>& knots, const S& x) {
  const double place = value_of(x);
  std::size_t k = 0;
  while (k + 2 < knots.size() && place >= knots[k + 1]) ++k;
  const double h = knots[k + 1] - knots[k];
  if (place < knots[k]) return {k, {S(1.0), x - S(knots[k]), S(0.0), S(0.0)}};
  if (place > knots[k + 1]) return {k, {S(0.0), S(0.0), S(1.0), x - S(knots[k + 1])}};
  const S t = (x - S(knots[k])) * S(1.0 / h), u = S(1.0) - t;
  return {k, {u * u * (S(1.0) + S(2.0) * t), S(h) * t * u * u, t * t * (S(1.0) + S(2.0) * u), -(S(h) * t * t * u)}};
}

/// Adds what the corners of a cell give, from `axis` on; `weight` is that of the axes before.
template <std::size_t axis, Scalar S>
void add_corners(const LoadTable& table, const std::array<HermiteWeights<S>, load_coordinate_count>& weights,
                 std::size_t node, std::size_t along, const S& weight, std::array<S, table_load_count>& sum) {
  if constexpr (axis < load_coordinate_count) {
    if (axis < table.axes().size()) {
      for (std::size_t k = 0; k < 4; ++k) {
        add_corners<axis + 1, S>(table, weights, node + (k / 2) * table.axes()[axis].stride, along | ((k % 2) << axis),
                                 S(weight * weights[axis].weight[k]), sum);
      }
      return;
    }
  }
  const std::array<double, table_load_count>& value = table.at(node, along);
  for (std::size_t q = 0; q < table_load_count; ++q) sum[q] = sum[q] + weight * S(value[q]);
}

}  // namespace detail

/// The loads of the table of `loads`, which has one, at a place, times the factor.
/// \f[
/// \frac{\rho N_\mathrm{w}}{\rho_\mathrm{t} N_\mathrm{t}} \sum_{n \in \{0,1\}^d} \sum_{m \in \{0,1\}^d}
/// \frac{\partial^{|m|} L}{\partial x^m}(x_n) \prod_{k=1}^{d} h_{n_k m_k}(x_k)
/// \f]
template <Scalar S>
[[gnu::noinline]] TableLoads<S> table_loads(const TabulatedLoads<S>& loads, const WingPlace<S>& place) {
  const LoadTable& table = *loads.table;
  std::array<detail::HermiteWeights<S>, load_coordinate_count> weights{};
  std::size_t node = 0;
  for (std::size_t k = 0; k < table.axes().size(); ++k) {
    const LoadTable::Axis& axis = table.axes()[k];
    weights[k] = detail::hermite_weights(axis.knots, place[std::size_t(axis.coordinate)]);
    node += weights[k].knot * axis.stride;
  }
  std::array<S, table_load_count> sum{S(0.0), S(0.0), S(0.0)};
  detail::add_corners<0, S>(table, weights, node, 0, S(1.0), sum);
  return {loads.factor * sum[0], loads.factor * sum[1], loads.factor * sum[2]};
}

}  // namespace wingbeat
