// The flexure transmission of a piezo against its definition, its derivatives, what its electronics lose.
#include "wingbeat/parts/piezo.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/core/members.hpp"

namespace wingbeat {
namespace {

Piezo<double> bee() { return {.force_per_volt = 4e-4, .stiffness = 240.0, .mass = 6e-6, .transmission_ratio = 2666.6}; }

TEST(Piezo, ThePlaceOfTheTransmissionIsTheRootOfItsCubic) {
  for (const double cubic : {0.0, 1e6, 4e9, 1e13}) {
    Piezo<double> p = bee();
    p.transmission_cubic = cubic;
    for (const double beta : {-1.5, -0.3, -1e-9, 0.0, 1e-4, 0.7, 1.2}) {
      const FlexurePlace<double> at_beta = flexure_at(p, beta);
      const double x = at_beta.tip;
      EXPECT_NEAR(p.transmission_ratio * x + cubic * x * x * x, beta, 4e-16 * std::abs(beta) + 1e-300);
      EXPECT_DOUBLE_EQ(at_beta.slope, p.transmission_ratio + 3.0 * cubic * x * x);
      EXPECT_DOUBLE_EQ(at_beta.second, 6.0 * cubic * x);
      // dx/dbeta = 1/T', dx/dT_3 = -x^3/T'.
      Piezo<Jet<2>> dual = cast<Jet<2>>(p);
      dual.transmission_cubic = Jet<2>(cubic, 1);
      const Jet<2> tip = flexure_at(dual, Jet<2>(beta, 0)).tip;
      EXPECT_NEAR(tip.v[0] * at_beta.slope, 1.0, 1e-14);
      EXPECT_NEAR(tip.v[1], -x * x * x / at_beta.slope, 1e-13 * std::abs(x * x * x) / at_beta.slope);
    }
  }
}

TEST(Piezo, ElectronicsLoseTheEnergyThatTheyDoNotRecover) {
  Piezo<double> p = bee();
  p.capacitance = 2e-8;
  p.loss_tangent = 0.02;
  for (const double offset : {0.0, 30.0, 90.0, -120.0}) {
    // Sum of all increases of C V^2 / 2 over a period, sampled.
    constexpr int samples = 200000;
    const double amplitude = 90.0, frequency = 150.0;
    const auto energy = [&](int n) {
      return 0.5 * p.capacitance * square(offset + amplitude * std::sin(two_pi * n / samples));
    };
    double stored = 0.0;
    for (int n = 0; n < samples; ++n) stored += std::max(0.0, energy(n + 1) - energy(n));
    const double dielectric = pi * frequency * p.loss_tangent * p.capacitance * square(amplitude);
    for (const double recovered : {0.0, 0.4, 1.0}) {
      p.recovered_share = recovered;
      EXPECT_NEAR(electronics_loss(p, offset, amplitude, frequency),
                  dielectric + (1.0 - recovered) * frequency * stored, 1e-7 * frequency * stored);
    }
  }
}

TEST(Piezo, ConstantsOutOfRangeAreNamed) {
  const auto refused = [](auto change) {
    Piezo<double> p = bee();
    change(p);
    try {
      validate(p);
    } catch (const ParameterError& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refused([](auto&) {}), "accepted");
  EXPECT_EQ(refused([](auto& p) { p.mass = 0.0; }), "piezo.mass: must be > 0 [kg], got 0");
  EXPECT_EQ(refused([](auto& p) { p.transmission_cubic = -1.0; }),
            "piezo.transmission_cubic: must be >= 0 [rad/m3], got -1");
}

}  // namespace
}  // namespace wingbeat
