// Derivatives through the orbits of direct drives and cranks whose wings pitch, against central differences; over
// impacts on stops too.
#include <gtest/gtest.h>

#include <cmath>

#include "vehicle/hinged_design.hpp"
#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/files/design_parameter.hpp"

namespace wingbeat {
namespace {

SteadyFlapping hinged_orbit(const Design<double>& design) {
  return find_steady_flapping(resolve(design),
                              {.tolerance = 1e-12, .stability = false, .reporting = reporting_of(design)});
}

/// By the hinge, the wings, the air, the motor, the supply and the mechanism.
constexpr const char* keys[] = {"pitch.stiffness",
                                "pitch.damping",
                                "pitch.stop",
                                "pitch.damping_coefficient",
                                "wing.areal_density",
                                "wing.planform.root_chord",
                                "motor.inertia",
                                "motor.armature_inductance",
                                "aerodynamics.air_density",
                                "supply.frequency"};

/// `tolerance` is of what a change by all of the parameter would do to a metric, over its error_scale().
void expect_gradients(const Design<double>& design, double tolerance) {
  std::vector<DesignParameter> parameters;
  for (const char* key : keys) {
    const DesignParameter p = design_parameter(key);
    if (p.value(design).value_or(0.0) != 0.0) parameters.push_back(p);
  }
  const SteadyFlapping orbit = hinged_orbit(design);
  ASSERT_EQ(orbit.status, FlappingStatus::flapping) << describe(orbit.evidence);
  const MetricGradients gradients = metric_gradients(design, Condition::air, orbit, parameters);
  ASSERT_TRUE(gradients.regular);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const double value = *parameters[p].value(design), h = 1e-4 * value;
    const auto at = [&](double by) {
      Design<double> moved = design;
      parameters[p].set(moved, value + by);
      return hinged_orbit(moved).metrics;
    };
    const Metrics<double> a = at(-2.0 * h), b = at(-h), c = at(h), d = at(2.0 * h);
    for (int m = 0; m < metric_count; ++m) {
      const Metric which = Metric(m);
      if (which == Metric::floquet_multiplier_max || std::isnan(orbit.metrics[which])) continue;
      const double difference = (8.0 * (c[which] - b[which]) - (d[which] - a[which])) / (12.0 * h) * value;
      EXPECT_NEAR(gradients.by_parameter[p][std::size_t(m)] * value, difference,
                  tolerance * (error_scale(orbit.metrics, which) + std::abs(difference)))
          << parameters[p].key << ", " << metric_info(which).key;
    }
  }
}

TEST(PitchGradient, AgreesWithDifferences) {
  std::mt19937_64 random(41);
  for (int n = 0; n < 2; ++n) {
    SCOPED_TRACE(n);
    Design<double> d = random_hinged_design(random, false);
    d.motor.constants.armature_inductance = n == 0 ? 0.0 : 29e-3;
    expect_gradients(d, 1e-6);
  }
}

TEST(PitchGradient, CrossesImpactsOnStops) {
  std::mt19937_64 random(42);
  for (int n = 0; n < 2; ++n) {
    SCOPED_TRACE(n);
    Design<double> d = random_hinged_design(random, true);
    d.motor.constants.armature_inductance = n == 0 ? 0.0 : 29e-3;
    EXPECT_NEAR(hinged_orbit(d).metrics[Metric::pitch_amplitude], degrees_per_radian * *d.pitch.stop, 1e-9);
    expect_gradients(d, 1e-5);
  }
}

TEST(PitchGradient, OfCranks) {
  std::uint32_t n = 0;
  for (int crank = 0; crank < 2; ++n) {
    Design<double> d = random_hinged_crank(n, 43);
    d.motor.constants.armature_inductance = crank % 2 == 0 ? 0.0 : 4e-4;
    if (hinged_orbit(d).status != FlappingStatus::flapping) continue;
    SCOPED_TRACE(n);
    expect_gradients(d, d.pitch.stop ? 1e-5 : 1e-6);
    ++crank;
  }
}

}  // namespace
}  // namespace wingbeat
