// Steady flapping of the reference vehicle without and with springs, which several solvers must reach.
#pragma once

#include "wingbeat/core/math.hpp"

namespace wingbeat {

struct KnownOrbit {
  bool springs;
  double crank_speed, current;  ///< at the lower dead centre, theta = -90 degrees [rad/s], [A]
  double frequency, power_electrical, lift_mean, rod_force_mean, rod_force_peak;
  double kinks[2];  ///< crank angles where the rod force changes its sign [rad]
};

/// data/published/orbits2022.json: computed in extended precision with located changes of the force's sign, confirmed
/// by an independent integrator to 4e-14.
inline constexpr KnownOrbit known_orbits[] = {{false,
                                               178.90084085877027,
                                               0.15316164053388573,
                                               21.952226143327449,
                                               0.54023365078787118,
                                               0.0087391846723811966,
                                               0.26513989876954032,
                                               0.45536141663819993,
                                               {0.751467892605991, 3.63210320230321}},
                                              {true,
                                               170.18923875426399,
                                               0.16199813776982407,
                                               23.430706596318597,
                                               0.50926842859058386,
                                               0.011644327876553516,
                                               0.1851194883045969,
                                               0.38663637234591627,
                                               {two_pi - 1.34160883181093, 1.31688933007742}}};

}  // namespace wingbeat
