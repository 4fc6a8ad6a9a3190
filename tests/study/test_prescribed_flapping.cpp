// Means along a stated motion against sums over strips and instants that share nothing with the program's formulas, and
// passive pitching against the closed form in vacuum and against orbits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/study/prescribed_flapping.hpp"
#include "wingbeat/vehicle/parameters.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

constexpr double one_degree = pi / 180.0;

Planform<double> tabulated_wing() {
  Planform<double> p;
  p.shape = PlanformShape::tabulated;
  p.chord_table = {{0.0, 2e-3}, {3e-3, 5e-3}, {8e-3, 4.5e-3}, {13e-3, 1e-3}};
  p.hub_offset = 2e-3;
  return p;
}

PrescribedFlapping two_harmonics() {
  PrescribedFlapping f;
  f.frequency = 150.0;
  f.stroke = {3.0 * one_degree, {{40.0 * one_degree, 0.2}, {4.0 * one_degree, 1.1}}};
  f.pitch = {-2.0 * one_degree, {{-38.0 * one_degree, 0.2 + 0.5 * pi + 0.3}, {5.0 * one_degree, 2.0}}};
  return f;
}

struct Sums {
  double lift_translation = 0.0, lift_rotation = 0.0, lift_added_mass = 0.0, power = 0.0;
};

/// Strip by strip, at instants in the middle of equal intervals: velocities from differences of the stated angles, the
/// force of each strip from its own velocity, the inertia of the air from differences of its momentum.
Sums summed(const PrescribedFlapping& f, double rho, double C_rot, bool robofly, double C_rd, int instants) {
  const auto angle = [&](const PeriodicAngle& a, double t) {
    double x = a.mean;
    for (std::size_t k = 0; k < a.harmonics.size(); ++k) {
      x += a.harmonics[k].amplitude * std::sin(2.0 * M_PI * double(k + 1) * f.frequency * t + a.harmonics[k].phase);
    }
    return x;
  };
  // Exact derivatives of a sine by the complex exponential.
  const auto rate = [&](const PeriodicAngle& a, double t, int order) {
    std::complex<double> sum = 0.0;
    for (std::size_t k = 0; k < a.harmonics.size(); ++k) {
      const double w = 2.0 * M_PI * double(k + 1) * f.frequency;
      sum += a.harmonics[k].amplitude * std::pow(std::complex<double>(0.0, w), order) *
             std::exp(std::complex<double>(0.0, w * t + a.harmonics[k].phase));
    }
    return sum.imag();
  };
  const std::vector<std::pair<double, double>> rows = tabulated_wing().chord_table;
  const double dt = 1.0 / (f.frequency * instants);
  Sums mean;
  constexpr double node[] = {-0.906179845938664, -0.538469310105683, 0.0, 0.538469310105683, 0.906179845938664};
  constexpr double weight[] = {0.236926885056189, 0.478628670499366, 0.568888888888889, 0.478628670499366,
                               0.236926885056189};
  for (int n = 0; n < instants; ++n) {
    const double t = (n + 0.5) * dt;
    const double b1 = rate(f.stroke, t, 1), b2 = rate(f.stroke, t, 2), psi = angle(f.pitch, t);
    const double p1 = rate(f.pitch, t, 1), p2 = rate(f.pitch, t, 2);
    const double s = b1 > 0.0 ? 1.0 : -1.0, alpha = 0.5 * M_PI + s * psi;
    const double C_L = robofly ? 1.8 * std::sin(2.0 * alpha) : 0.225 + 1.58 * std::sin(2.13 * alpha - 7.2 * one_degree);
    const double C_D =
        robofly ? 1.95 - 1.5 * std::cos(2.0 * alpha) : 1.92 - 1.55 * std::cos(2.04 * alpha - 9.82 * one_degree);
    const double C_N = C_L * std::cos(alpha) + C_D * std::sin(alpha);
    const double centre =
        0.46 - 0.332 * std::cos(alpha) - 0.037 * std::cos(3.0 * alpha) - 0.013 * std::cos(5.0 * alpha);
    for (std::size_t k = 1; k < rows.size(); ++k) {
      const double half = 0.5 * (rows[k].first - rows[k - 1].first);
      for (int q = 0; q < 5; ++q) {
        const double share = 0.5 * (1.0 + node[q]);
        const double c = rows[k - 1].second + share * (rows[k].second - rows[k - 1].second);
        const double r = 2e-3 + rows[k - 1].first + share * 2.0 * half;
        const double dr = half * weight[q];
        const double translation = 0.5 * rho * C_N * std::abs(r * b1) * (r * b1) * c * dr;
        const double rotation = C_rot * rho * std::abs(r * b1) * p1 * c * c * dr;
        // The strip's middle lies half a chord behind the axis and moves normal to the chord with r b1 cos(psi) + p1
        // c/2.
        const double acceleration = r * (b2 * std::cos(psi) - b1 * p1 * std::sin(psi)) + 0.5 * c * p2;
        const double air = 0.25 * M_PI * rho * c * c * acceleration * dr;
        mean.lift_translation -= translation * std::sin(psi) / instants;
        mean.lift_rotation -= rotation * std::sin(psi) / instants;
        mean.lift_added_mass -= air * std::sin(psi) / instants;
        const double damping = 0.125 * rho * C_rd * std::abs(p1) * p1 * std::pow(c, 4) * dr;
        mean.power += ((translation + rotation) * r * std::cos(psi) * b1 +
                       (translation * centre * c + rotation * 0.5 * c + damping) * p1) /
                      instants;
      }
    }
  }
  return mean;
}

TEST(PrescribedFlapping, AgreesWithSumsOverStrips) {
  const PrescribedFlapping f = two_harmonics();
  for (const bool robofly : {false, true}) {
    const char* name = robofly ? "normal-force-robofly" : "translational-2022";
    const PrescribedLoads loads = prescribed_loads(prescribed_wings(tabulated_wing(), 1.0, 1.2, name, true, true), f);
    const Sums sums = summed(f, 1.2, robofly ? 0.0 : 0.75 * M_PI, robofly, robofly ? 5.0 : 0.0, 40000);
    EXPECT_NEAR(loads.lift_translation, sums.lift_translation, 1e-8 * std::abs(sums.lift_translation));
    EXPECT_NEAR(loads.lift_rotation, sums.lift_rotation, 1e-8 * std::abs(sums.lift_translation));
    EXPECT_NEAR(loads.lift_added_mass, sums.lift_added_mass, 1e-8 * std::abs(sums.lift_translation));
    EXPECT_NEAR(loads.power, sums.power, 1e-8 * sums.power);
    EXPECT_NEAR(loads.lift, loads.lift_translation + loads.lift_rotation + loads.lift_added_mass, 1e-15);
    EXPECT_NEAR(loads.power, loads.power_translation + loads.power_rotation + loads.power_damping, 1e-15);
    if (robofly) {
      EXPECT_EQ(loads.lift_rotation, 0.0);
      EXPECT_GT(loads.power_damping, 0.0);
    } else {
      EXPECT_NE(loads.lift_rotation, 0.0);
      EXPECT_EQ(loads.power_damping, 0.0);
    }
    EXPECT_GT(std::abs(loads.lift_added_mass), 1e-3 * loads.lift);
  }
}

TEST(PrescribedFlapping, LeavesOutTheTermsThatAreNotAskedFor) {
  const PrescribedFlapping f = two_harmonics();
  const PrescribedWings bare = prescribed_wings(tabulated_wing(), 1.0, 1.2, "translational-2022", false, false);
  const PrescribedLoads alone = prescribed_loads(bare, f);
  const PrescribedLoads all =
      prescribed_loads(prescribed_wings(tabulated_wing(), 1.0, 1.2, "translational-2022", true, true), f);
  EXPECT_EQ(alone.lift_rotation, 0.0);
  EXPECT_EQ(alone.lift_added_mass, 0.0);
  EXPECT_NEAR(alone.lift, all.lift_translation, 1e-12 * alone.lift);
  // Two wings lift twice as much as one.
  const PrescribedLoads two =
      prescribed_loads(prescribed_wings(tabulated_wing(), 2.0, 1.2, "translational-2022", true, true), f);
  EXPECT_NEAR(two.lift, 2.0 * all.lift, 1e-12 * two.lift);
}

TEST(PrescribedFlapping, LiftAndDragAtAConstantAngleHasItsClosedForm) {
  // A sine of amplitude B at angle of attack a over each half stroke: mean lift rho C_L(a) S_2 (2 pi f B)^2 / 4, which
  // a pitch that is square over time has; here the angle is reached at mid-stroke, so the pitch is taken as constant in
  // one direction alone: the two half strokes have the angles 90 + psi and 90 - psi degrees.
  PrescribedWings wings = prescribed_wings(tabulated_wing(), 1.0, 1.2, "translational-2022", false, false);
  wings.direction = StripForceDirection::lift_and_drag;
  PrescribedFlapping f;
  f.frequency = 20.0;
  f.stroke.harmonics = {{0.8, 0.0}};
  f.pitch.mean = -0.6;
  const auto C_L = [](double a) { return 0.225 + 1.58 * std::sin(2.13 * a - 7.2 * one_degree); };
  const double both = 0.5 * (C_L(0.5 * M_PI - 0.6) + C_L(0.5 * M_PI + 0.6));
  const double expected = 0.25 * 1.2 * both * wings.blades.s2 * std::pow(2.0 * M_PI * 20.0 * 0.8, 2);
  EXPECT_NEAR(prescribed_loads(wings, f).lift, expected, 1e-12 * std::abs(expected));
}

TEST(PrescribedFlapping, RefusesWhatItCannotCompute) {
  EXPECT_THROW(prescribed_wings(tabulated_wing(), 1.0, 1.2, "no-such-set", false, false), ParameterError);
  const PrescribedWings wings = prescribed_wings(tabulated_wing(), 1.0, 1.2, "translational-2022", false, false);
  EXPECT_THROW(prescribed_loads(wings, {}), ParameterError);
  const Design<double> law = read_design(std::string(WINGBEAT_DATA) + "/designs/hawkmoth.toml");
  EXPECT_THROW(passive_pitch(resolve(law), {0.0, {{0.5, 0.0}}}, 20.0), ParameterError);
  const Design<double> stops = read_design(std::string(WINGBEAT_DATA) + "/designs/two-wing-direct-hinge.toml");
  EXPECT_THROW(passive_pitch(resolve(stops), {0.0, {{0.5, 0.0}}}, 34.0), ParameterError);
}

Design<double> robobee() { return read_design(std::string(WINGBEAT_DATA) + "/designs/robobee-piezo.toml"); }

TEST(PassivePitch, OfSmallStrokesInVacuumHasItsClosedForm) {
  // I psi'' + c psi' + k psi = -P beta'' for small angles.
  Design<double> design = robobee();
  design.pitch.damping = 1e-9;
  const Vehicle<double> v = resolve(design, Condition::vacuum);
  const double f = 120.0, w = 2.0 * M_PI * f, amplitude = 1e-5;
  const PassivePitch found = passive_pitch(v, {0.0, {{amplitude, 0.0}}}, f);
  ASSERT_TRUE(found.settled);
  const double I = v.pitch.pitch_inertia, k = *design.pitch.stiffness;
  const std::complex<double> response =
      v.pitch.mass_product * w * w * amplitude / std::complex<double>(k - I * w * w, 1e-9 * w);
  EXPECT_NEAR(found.amplitude, std::abs(response), 2e-4 * std::abs(response));
  EXPECT_NEAR(found.mean, 0.0, 1e-9);
}

TEST(PassivePitch, IsThatOfTheOrbitWithTheOrbitsOwnStroke) {
  // Found as a periodic orbit in the phase of the drive, of pitch and stroke together.
  const Vehicle<double> v = resolve(robobee());
  const SteadyFlapping orbit = find_steady_flapping(v, {.tolerance = 1e-9});
  ASSERT_EQ(orbit.status, FlappingStatus::flapping);
  const int count = 512;
  const std::vector<WaveformRow> rows = orbit.record.waveform(count + 1);
  PeriodicAngle stroke;
  for (int k = 1; k <= 40; ++k) {
    std::complex<double> c = 0.0;
    for (int n = 0; n < count; ++n) {
      c += rows[std::size_t(n)].stroke_angle * std::exp(std::complex<double>(0.0, -2.0 * M_PI * k * n / count));
    }
    c *= 2.0 / count;
    stroke.harmonics.push_back({std::abs(c), std::arg(c) + 0.5 * M_PI});
  }
  for (int n = 0; n < count; ++n) stroke.mean += rows[std::size_t(n)].stroke_angle / count;
  const PassivePitch found = passive_pitch(v, stroke, v.drive_frequency);
  ASSERT_TRUE(found.settled);
  EXPECT_NEAR(found.amplitude / one_degree, orbit.metrics[Metric::pitch_amplitude], 1e-3);
  EXPECT_NEAR(found.phase / one_degree, orbit.metrics[Metric::pitch_phase], 1e-2);
}

}  // namespace
}  // namespace wingbeat
