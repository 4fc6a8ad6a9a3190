#include "wingbeat/flight/wing_reaction.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace wingbeat {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

Vector3d vector_of(const Triple& t) { return {t[0], t[1], t[2]}; }
Triple triple_of(const Vector3d& v) { return {v[0], v[1], v[2]}; }

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0;
  return m;
}

/// Mass, first moment and second moments about the origin of what is rigid.
struct Rigid {
  double mass;
  Vector3d first;
  Matrix3d inertia;
};

/// A wing as a rod from its shoulder along the unit vector e: so many of them.
struct Rod {
  double count, mass, first, second;  ///< of one: m_w, m_w r_c, J_w
  Vector3d shoulder, span, ahead;
  double sense;
};

Rod rod_of(const FlightVehicle& v, std::size_t drive, const WingMount& mount, double stroke_angle) {
  const WingAxes<double> axes = wing_axes(mount, stroke_angle);
  return {mount.share * v.wings_of_drive,
          v.wing_mass,
          v.wing_mass * v.wing_centre,
          v.drives[drive].vehicle.wing_inertia,
          vector_of(mount.shoulder),
          {axes.span[0], axes.span[1], axes.span[2]},
          {axes.ahead[0], axes.ahead[1], axes.ahead[2]},
          mount.sense};
}

/// Second moments about the origin of a rod.
Matrix3d inertia_of(const Rod& r) {
  const auto moment = [](const Vector3d& a, const Vector3d& b) {
    return Matrix3d(a.dot(b) * Matrix3d::Identity() - 0.5 * (a * b.transpose() + b * a.transpose()));
  };
  return r.mass * moment(r.shoulder, r.shoulder) + 2.0 * r.first * moment(r.shoulder, r.span) +
         r.second * moment(r.span, r.span);
}

/// The vehicle without its wings.
Rigid core_of(const FlightVehicle& v) {
  const Body& b = v.body;
  Rigid core{b.mass, Vector3d::Zero(), Matrix3d::Zero()};
  core.inertia << b.inertia_roll, 0.0, -b.inertia_product, 0.0, b.inertia_pitch, 0.0, -b.inertia_product, 0.0,
      b.inertia_yaw;
  for (std::size_t n = 0; n < v.drives.size(); ++n) {
    for (std::size_t k = 0; k < v.drives[n].flow.count; ++k) {
      const Rod rod = rod_of(v, n, v.drives[n].flow.mounts[k], 0.0);
      core.mass -= rod.count * rod.mass;
      core.first -= rod.count * (rod.mass * rod.shoulder + rod.first * rod.span);
      core.inertia -= rod.count * inertia_of(rod);
    }
  }
  return core;
}

template <class Use>
void for_rods(const FlightVehicle& v, const std::vector<const OnsetFlow*>& flows,
              const std::vector<StrokeOnBody>& strokes, const Use& use) {
  for (std::size_t n = 0; n < strokes.size(); ++n) {
    for (std::size_t k = 0; k < flows[n]->count; ++k) {
      use(n, rod_of(v, n, flows[n]->mounts[k], strokes[n].angle));
    }
  }
}

}  // namespace

BodyWithWings body_with_wings(const FlightVehicle& v, const std::vector<const OnsetFlow*>& flows,
                              const std::vector<StrokeOnBody>& strokes, const BodyState& body, const BodyLoads& air,
                              double gravity) {
  const Vector3d V = vector_of(body.velocity), W = vector_of(body.rates);
  const Vector3d g = vector_of(to_body(body.attitude, {0.0, 0.0, gravity}));
  // The acceleration of the origin less gravity at rest of V' and W'.
  const Vector3d origin = W.cross(V) - g;
  const Rigid core = core_of(v);
  Matrix6d A = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  const auto add_mass = [&](double count, double mass, const Vector3d& first, const Matrix3d& inertia) {
    const Matrix3d across = cross_matrix(first);
    A.block<3, 3>(0, 0) += count * mass * Matrix3d::Identity();
    A.block<3, 3>(0, 3) -= count * across;
    A.block<3, 3>(3, 0) += count * across;
    A.block<3, 3>(3, 3) += count * inertia;
    b.head<3>() += count * (mass * origin + W.cross(W.cross(first)));
    b.tail<3>() += count * (first.cross(origin) + W.cross(inertia * W));
  };
  add_mass(1.0, core.mass, core.first, core.inertia);
  const std::size_t drives = strokes.size();
  std::vector<Vector6d> column(drives, Vector6d::Zero());
  std::vector<double> own(drives, 0.0);
  for_rods(v, flows, strokes, [&](std::size_t n, const Rod& rod) {
    const Vector3d first = rod.mass * rod.shoulder + rod.first * rod.span;
    add_mass(rod.count, rod.mass, first, inertia_of(rod));
    const double beta_dot = rod.sense * strokes[n].velocity;
    // A strip at r has r (beta'' e_t - beta'^2 e_r + 2 beta' W x e_t) beside what is rigid.
    const Vector3d along = -square(beta_dot) * rod.span + 2.0 * beta_dot * W.cross(rod.ahead);
    const auto moment = [&](const Vector3d& a) {
      return Vector3d(rod.first * rod.shoulder.cross(a) + rod.second * rod.span.cross(a));
    };
    b.head<3>() += rod.count * rod.first * along;
    b.tail<3>() += rod.count * moment(along);
    column[n].head<3>() += rod.count * rod.sense * rod.first * rod.ahead;
    column[n].tail<3>() += rod.count * rod.sense * moment(rod.ahead);
    const Vector3d shoulder = origin + W.cross(W.cross(rod.shoulder));
    own[n] += rod.count * rod.sense *
              (rod.first * rod.ahead.dot(shoulder) + rod.second * rod.ahead.dot(W.cross(W.cross(rod.span))));
  });
  Vector6d right;
  right << vector_of(air.force), vector_of(air.moment);
  right -= b;
  for (std::size_t n = 0; n < drives; ++n) {
    const double k = strokes[n].compliance;
    A -= k * column[n] * column[n].transpose();
    right -= column[n] * (strokes[n].acceleration - k * own[n]);
  }
  const Vector6d x = A.partialPivLu().solve(right);
  BodyWithWings result{triple_of(x.head<3>()), triple_of(x.tail<3>()), {}};
  for (std::size_t n = 0; n < drives; ++n) result.moments.push_back(column[n].dot(x) + own[n]);
  return result;
}

BodyLoads momentum_with_wings(const FlightVehicle& v, const std::vector<const OnsetFlow*>& flows,
                              const std::vector<StrokeOnBody>& strokes, const BodyState& body) {
  const Vector3d V = vector_of(body.velocity), W = vector_of(body.rates);
  const Rigid core = core_of(v);
  Vector3d linear = core.mass * V + W.cross(core.first), angular = core.first.cross(V) + core.inertia * W;
  for_rods(v, flows, strokes, [&](std::size_t n, const Rod& rod) {
    const Vector3d first = rod.mass * rod.shoulder + rod.first * rod.span;
    const Vector3d flaps = rod.sense * strokes[n].velocity * rod.ahead;
    linear += rod.count * (rod.mass * V + W.cross(first) + rod.first * flaps);
    angular += rod.count * (first.cross(V) + inertia_of(rod) * W + rod.first * rod.shoulder.cross(flaps) +
                            rod.second * rod.span.cross(flaps));
  });
  return {triple_of(linear), triple_of(angular)};
}

double energy_with_wings(const FlightVehicle& v, const std::vector<const OnsetFlow*>& flows,
                         const std::vector<StrokeOnBody>& strokes, const BodyState& body, double gravity) {
  const Vector3d V = vector_of(body.velocity), W = vector_of(body.rates);
  const Vector3d down = vector_of(to_body(body.attitude, {0.0, 0.0, 1.0}));
  const Rigid core = core_of(v);
  const auto rigid = [&](double mass, const Vector3d& first, const Matrix3d& inertia) {
    return 0.5 * mass * V.dot(V) + V.dot(W.cross(first)) + 0.5 * W.dot(inertia * W) - gravity * first.dot(down);
  };
  double energy = rigid(core.mass, core.first, core.inertia) - v.body.mass * gravity * body.position[2];
  for_rods(v, flows, strokes, [&](std::size_t n, const Rod& rod) {
    const Vector3d flaps = rod.sense * strokes[n].velocity * rod.ahead;
    energy +=
        rod.count * (rigid(rod.mass, rod.mass * rod.shoulder + rod.first * rod.span, inertia_of(rod)) +
                     rod.first * flaps.dot(V + W.cross(rod.shoulder)) + rod.second * flaps.dot(W.cross(rod.span)));
  });
  return energy;
}

}  // namespace wingbeat
