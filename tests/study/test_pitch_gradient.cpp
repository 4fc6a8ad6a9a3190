// Derivatives through the orbits of direct drives and cranks whose wings pitch, against central differences; over
// impacts on stops too.
#include <gtest/gtest.h>

#include <cmath>

#include "study/metric_differences.hpp"
#include "vehicle/hinged_design.hpp"

namespace wingbeat {
namespace {

/// By the hinge, the wings, the air, the motor, the supply and the mechanism.
constexpr const char* keys[] = {"pitch.stiffness",
                                "pitch.damping",
                                "pitch.stop",
                                "pitch.damping_coefficient",
                                "pitch.leading_edge_suction",
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
  compare_with_differences(
      design, parameters,
      [&](const auto& key, Metric m, const Metrics<double>& metrics, double exact, double difference) {
        EXPECT_NEAR(exact, difference, tolerance * (error_scale(metrics, m) + std::abs(difference)))
            << key << ", " << metric_info(m).key;
      });
}

/// Direct drives without and with inductance.
void expect_gradients_of_direct_drives(std::uint64_t seed, bool stops, double tolerance) {
  std::mt19937_64 random(seed);
  for (const double inductance : {0.0, 29e-3}) {
    SCOPED_TRACE(inductance);
    Design<double> d = random_hinged_design(random, stops);
    d.motor.constants.armature_inductance = inductance;
    d.pitch.edge_suction = 0.3;
    if (stops) {
      EXPECT_NEAR(accurate_orbit(d).metrics[Metric::pitch_amplitude], degrees_per_radian * *d.pitch.stop, 1e-9);
    }
    expect_gradients(d, tolerance);
  }
}

TEST(PitchGradient, AgreesWithDifferences) { expect_gradients_of_direct_drives(41, false, 1e-6); }

TEST(PitchGradient, CrossesImpactsOnStops) { expect_gradients_of_direct_drives(42, true, 1e-5); }

TEST(PitchGradient, OfCranks) {
  std::uint32_t n = 0;
  for (int crank = 0; crank < 2; ++n) {
    Design<double> d = random_hinged_crank(n, 43);
    d.motor.constants.armature_inductance = crank % 2 == 0 ? 0.0 : 4e-4;
    if (accurate_orbit(d).status != FlappingStatus::flapping) continue;
    SCOPED_TRACE(n);
    expect_gradients(d, d.pitch.stop ? 1e-5 : 1e-6);
    ++crank;
  }
}

}  // namespace
}  // namespace wingbeat
