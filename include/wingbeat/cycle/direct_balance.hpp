// What a direct drive can do, from its statics and from the first harmonic alone; model.md section 6.
#pragma once

#include <complex>
#include <vector>

#include "wingbeat/vehicle/coordinates.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// Amplitudes of a response at the drive frequency w to v = V sin(w t): each quantity is the imaginary part of its
/// amplitude times exp(j w t).
struct HarmonicResponse {
  std::complex<double> stroke;   ///< of beta [rad]
  std::complex<double> speed;    ///< of beta' [rad/s]
  std::complex<double> current;  ///< of i [A]
};

struct DirectBalance {
  /// Amplitude of the torque on a shaft that stands still [N m]:
  /// \f$K V / |R_\mathrm{a} + \mathrm{j} w L_\mathrm{a}|\f$, of a piezo that of its force over T'.
  double drive_torque;
  double breakaway_torque;  ///< T_c, the constant friction that holds the shaft [N m]
  /// Responses in which drag and friction are replaced by the viscous damping that takes the same power from a harmonic
  /// motion (harmonic balance), slowest first: first guesses for periodic orbits. More than one hints at several
  /// orbits. None: constant friction is too strong for a nearly harmonic motion.
  std::vector<HarmonicResponse> responses;

  /// No motion outlasts the start: the drive's torque does not exceed the friction.
  bool stalled() const { return drive_torque <= breakaway_torque; }
};

/// Harmonic balance at the drive's angular frequency w: the amplitude \f$\Omega\f$ of the flapping velocity [rad/s],
/// with the amplitude \f$M_1(|\Omega|)\f$ of the first harmonic of aerodynamic moment, friction and damping [N m]
/// (model.md section 6).
/// \f[
/// \left( \frac{M_1(|\Omega|)}{|\Omega|}
/// + \mathrm{j} \left( w\, (J + N_\mathrm{w} J_\mathrm{w}) - \frac{N_\mathrm{w} k}{w} \right)
/// + \frac{K^2}{R_\mathrm{a} + \mathrm{j} w L_\mathrm{a}} \right) \Omega
/// = \frac{K V}{R_\mathrm{a} + \mathrm{j} w L_\mathrm{a}}
/// \f]
DirectBalance direct_balance(const Vehicle<double>& vehicle);

/// About how large the current is [A].
double typical_current(const Vehicle<double>& vehicle, const DirectBalance& balance);

/// Of wings that pitch, about how far [rad] at a stroke velocity [rad/s]: what inertia and drag of an upright wing ask
/// of the hinge, at most a radian.
double typical_pitch(const Vehicle<double>& vehicle, double stroke_velocity);
/// typical_pitch() of wings that swing at an angular frequency [rad/s] which the supply does not set.
double typical_pitch(const Vehicle<double>& vehicle, double stroke_velocity, double angular_frequency);
/// Puts typical sizes of what moves in such wings into `typical`; nothing of wings under the pitch law.
void add_typical_wings(const Vehicle<double>& vehicle, double stroke_velocity, double angular_frequency,
                       Coordinates<double>& typical);

}  // namespace wingbeat
