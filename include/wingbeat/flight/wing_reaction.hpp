// Wings with mass on a body: what the inertia of their flapping does to the body, and its acceleration to their stroke;
// model.md section 18.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "wingbeat/flight/flight_vehicle.hpp"

namespace wingbeat {

/// The stroke of one drive as the body meets it. The drive, asked for the moment X beside its loads, answers with the
/// acceleration \f$\ddot\beta = \ddot\beta_0 - k X\f$ [rad/s2].
struct StrokeOnBody {
  double angle = 0.0;         ///< beta [rad]
  double velocity = 0.0;      ///< beta' [rad/s]
  double acceleration = 0.0;  ///< beta_0'' [rad/s2]
  double compliance = 0.0;    ///< k [1/(kg m2)]
};

struct BodyWithWings {
  Triple acceleration{}, angular_acceleration{};  ///< V' and W' in body axes [m/s2], [rad/s2]
  std::vector<double> moments;                    ///< X of each drive [N m], against a positive beta''
};

/// The accelerations under loads of the air, and gravity g [m/s2]. Each wing is a thin rod of the mass m_w with its
/// centre at r_c and J_w about the stroke axis; the rest of the vehicle is such that all of it, the wings at stroke
/// angle 0, has the body's mass, centre of mass and inertia. Momentum and energy are kept exactly.
BodyWithWings body_with_wings(const FlightVehicle& vehicle, const std::vector<const OnsetFlow*>& flows,
                              const std::vector<StrokeOnBody>& strokes, const BodyState& body, const BodyLoads& air,
                              double gravity);

/// Kinetic and potential energy of body and wings beside the kinetic energy \f$\tfrac12 J_\mathrm{w} \dot\beta^2\f$ of
/// each wing that is the drive's, over the height of the origin [J].
double energy_with_wings(const FlightVehicle& vehicle, const std::vector<const OnsetFlow*>& flows,
                         const std::vector<StrokeOnBody>& strokes, const BodyState& body, double gravity);

/// Linear and angular momentum about the centre of mass of body and wings, in body axes [N s], [N m s].
BodyLoads momentum_with_wings(const FlightVehicle& vehicle, const std::vector<const OnsetFlow*>& flows,
                              const std::vector<StrokeOnBody>& strokes, const BodyState& body);

}  // namespace wingbeat
