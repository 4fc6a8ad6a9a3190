// Wings on a body that moves, or in wind: where each is mounted, and how the air meets its strips; model.md section 18.
//
// Body axes as in flight dynamics: x forward, y to the right, z down, origin at the centre of mass. A wing flaps in its
// stroke plane, which is the body's x-y plane turned about y by the tilt of the mount, leading edge of the body up.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/scalar.hpp"

namespace wingbeat {

using Triple = std::array<double, 3>;

inline Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// One wing, or as many as move alike on one side.
struct WingMount {
  double side = 1.0;        ///< +1 right, -1 left
  double sense = 1.0;       ///< -1 of a wing that flaps against the stroke angle: of two on one side
  double share = 1.0;       ///< part of all wings [1]
  Triple shoulder{};        ///< where the stroke axis meets the span, from the centre of mass [m]
  double tilt = 0.0;        ///< of its stroke plane, nose up [rad]
  double mean_angle = 0.0;  ///< of the span at stroke angle 0, forwards [rad]
  double incidence = 0.0;   ///< by which the pitch of a wing under the pitch law is larger than the law's [rad]
};
inline constexpr std::size_t max_mounts = 4;

/// How the body, and with it the shoulders, moves through the air, the flapping of the wings apart.
struct OnsetFlow {
  std::array<WingMount, max_mounts> mounts;
  std::size_t count = 0;  ///< of mounts
  Triple velocity{};      ///< of the centre of mass against the air, in body axes [m/s]
  Triple rates{};         ///< angular velocity in body axes [rad/s]
  /// What the body's acceleration adds to the moment about the stroke axis, against a positive stroke velocity [N m].
  double reaction_moment = 0.0;
};

/// Axes of a wing's stroke plane in body axes, and its span at a stroke angle: \f$e_r\f$, \f$e_t = \partial e_r /
/// \partial \beta\f$ and the plane's normal n, downwards. In the axes of the plane, with s = +1 right, -1 left:
/// \f[
/// e_r = (\sin\beta,\ s \cos\beta,\ 0), \qquad e_t = (\cos\beta,\ -s \sin\beta,\ 0), \qquad n = (0, 0, 1)
/// \f]
template <Scalar S>
struct WingAxes {
  std::array<S, 3> span, ahead;
  Triple down;
};

/// `stroke_angle`: beta of the vehicle [rad].
template <Scalar S>
WingAxes<S> wing_axes(const WingMount& mount, const S& stroke_angle) {
  using std::cos;
  using std::sin;
  const S beta = S(mount.sense) * stroke_angle + S(mount.mean_angle), s = sin(beta), c = cos(beta);
  const S side(mount.side), cos_tilt(std::cos(mount.tilt)), sin_tilt(std::sin(mount.tilt));
  // (x, y, z) of the plane is (x cos + z sin, y, -x sin + z cos) of the body.
  return {{s * cos_tilt, side * c, -(s * sin_tilt)},
          {c * cos_tilt, -(side * s), -(c * sin_tilt)},
          {std::sin(mount.tilt), 0.0, std::cos(mount.tilt)}};
}

/// How a strip at r moves against the air, the body's share: along e_t \f$u_0 + u_1 r\f$, along n \f$w_0 + w_1 r\f$
/// [m/s], both of the wing's own axes.
/// \f[
/// u_0 = (V + W \times r_\mathrm{s}) \cdot e_t, \quad u_1 = (W \times e_r) \cdot e_t, \qquad
/// w_0 = (V + W \times r_\mathrm{s}) \cdot n, \quad w_1 = (W \times e_r) \cdot n
/// \f]
template <Scalar S>
struct StripDrift {
  S u0, u1, w0, w1;
};

template <Scalar S>
StripDrift<S> strip_drift(const OnsetFlow& flow, const WingMount& mount, const WingAxes<S>& axes) {
  const Triple turning = cross(flow.rates, mount.shoulder);
  StripDrift<S> drift{S(0.0), S(0.0), S(0.0), S(0.0)};
  const Triple& W = flow.rates;
  const std::array<S, 3> along = {S(W[1]) * axes.span[2] - S(W[2]) * axes.span[1],
                                  S(W[2]) * axes.span[0] - S(W[0]) * axes.span[2],
                                  S(W[0]) * axes.span[1] - S(W[1]) * axes.span[0]};
  for (std::size_t k = 0; k < 3; ++k) {
    const S V(flow.velocity[k] + turning[k]);
    drift.u0 = drift.u0 + V * axes.ahead[k];
    drift.u1 = drift.u1 + along[k] * axes.ahead[k];
    drift.w0 = drift.w0 + V * S(axes.down[k]);
    drift.w1 = drift.w1 + along[k] * S(axes.down[k]);
  }
  return drift;
}

/// The vehicle's, where it is on a body that moves; SIMD lanes have none.
template <Scalar S>
using OnsetFlowOf = std::conditional_t<ScalarTraits<S>::reads_tables, std::shared_ptr<const OnsetFlow>, std::nullptr_t>;

/// The angle of attack [rad] of a strip whose chord hangs down turned ahead by the pitch \f$\psi\f$: with its velocity
/// (u, w) against the air along e_t and n, of the size U > 0, \f$v_\mathrm{n} = u \cos\psi - w \sin\psi\f$ normal to
/// the chord and \f$v_\mathrm{c} = u \sin\psi + w \cos\psi\f$ along it towards the trailing edge, and the sign s of the
/// stroke velocity of the wing:
/// \f[
/// \alpha = \operatorname{atan2}(s\, v_\mathrm{n}, -v_\mathrm{c})
/// \f]
/// Where the body rests it is \f$\pi/2 + s \psi\f$.
template <Scalar S>
S flow_angle(const S& u, const S& w, const S& speed, const S& sin_psi, const S& cos_psi, const S& stroke) {
  using std::abs;
  using std::atan;
  const S y = stroke * (u * cos_psi - w * sin_psi), x = -(u * sin_psi + w * cos_psi);
  // By half the angle, which no division makes large.
  const S acute = S(2.0) * atan(S(abs(y) / (speed + abs(x))));
  const S size = select<S>(x < S(0.0), S(S(pi) - acute), acute);
  return select<S>(y < S(0.0), S(-size), size);
}

}  // namespace wingbeat
