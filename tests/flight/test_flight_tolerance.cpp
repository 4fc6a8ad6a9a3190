// Vehicles drawn from distributions, each trimmed: the spread of hover and its modes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "flight/flight_vehicles.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/study/flight_tolerance.hpp"

namespace wingbeat {
namespace {

ToleranceStudy study_of(const std::vector<std::pair<const char*, double>>& deviations, std::uint64_t count) {
  ToleranceStudy study;
  study.design = flying_design("friction2022");
  study.indices = false;
  study.count = count;
  for (const auto& [key, relative] : deviations) {
    UncertainParameter p{design_parameter(key), {}, false};
    const double mean = *p.parameter.value(study.design);
    p.distribution = {DistributionKind::normal, mean, relative * std::abs(mean)};
    study.parameters.push_back(std::move(p));
  }
  return study;
}

TEST(FlightTolerance, SamplesAreTrimsOfTheVehiclesDrawn) {
  const ToleranceStudy study = study_of({{"vehicle.mass", 0.02}, {"motor.armature_resistance", 0.04}}, 4);
  const FlightToleranceResult found = flight_tolerance(study, {});
  ASSERT_EQ(found.samples.size(), 4u);
  EXPECT_EQ(found.flies.count, 4u);
  const Sweep sweep = tolerance_sweep(study);
  for (std::size_t n = 0; n < found.samples.size(); ++n) {
    AveragedFlight flight(flight_vehicle(design_at(sweep, n).design));
    const TrimResult alone = trim(flight, {});
    ASSERT_EQ(alone.status, TrimStatus::trimmed);
    EXPECT_NEAR(found.samples[n].voltage, alone.controls[FlightControl::voltage], 1e-5 * found.samples[n].voltage);
    const StabilityResult modes = flight_stability(flight, alone);
    const auto first = std::find_if(modes.modes.begin(), modes.modes.end(),
                                    [](const FlightMode& m) { return m.longitudinal && m.averaged; });
    EXPECT_LT(std::abs(found.samples[n].longitudinal - *first->averaged), 1e-3 * std::abs(*first->averaged));
  }
}

TEST(FlightTolerance, DoesNotDependOnTheOrderOfTheWork) {
  const ToleranceStudy study = study_of({{"vehicle.mass", 0.02}, {"body.inertia_pitch", 0.1}}, 4);
  const FlightToleranceResult forwards = flight_tolerance(study, {});
  const FlightToleranceResult backwards =
      flight_tolerance(study, {}, [](std::size_t count, const std::function<void(std::size_t)>& act) {
        for (std::size_t n = count; n-- > 0;) act(n);
      });
  for (std::size_t n = 0; n < forwards.samples.size(); ++n) {
    EXPECT_EQ(forwards.samples[n].voltage, backwards.samples[n].voltage);
    EXPECT_EQ(forwards.samples[n].longitudinal, backwards.samples[n].longitudinal);
  }
}

TEST(FlightTolerance, SpreadOfASmallDeviationIsThatOfTheSlope) {
  // The weight follows from the mass, the lift from the voltage: to first order both spread by the slope of the trim.
  const ToleranceStudy study = study_of({{"vehicle.mass", 0.01}}, 16);
  const FlightToleranceResult found = flight_tolerance(study, {});
  const auto voltage_of = [](double mass) {
    Design<double> d = flying_design("friction2022");
    d.mass = mass;
    AveragedFlight flight(flight_vehicle(d));
    return trim(flight, {}).controls[FlightControl::voltage];
  };
  const double mass = *study.design.mass, step = 0.01 * mass;
  const double slope = (voltage_of(mass + step) - voltage_of(mass - step)) / (2.0 * step);
  double mean = 0.0, squares = 0.0;
  const std::vector<double> masses = tolerance_sweep(study).axes[0].quantities[0].values;
  for (const double m : masses) mean += m / double(masses.size());
  for (const double m : masses) squares += (m - mean) * (m - mean);
  const double deviation = std::sqrt(squares / double(masses.size() - 1));
  ASSERT_STREQ(flight_quantities()[0].name, "voltage_v");
  EXPECT_NEAR(found.quantity[0].deviation, slope * deviation, 2e-2 * slope * deviation);
  EXPECT_NEAR(found.quantity[0].mean, found.quantity[0].centre, 1e-3 * found.quantity[0].centre);
  EXPECT_EQ(found.unstable.share, 1.0);  // its hover is unstable, see docs/flight.md
}

TEST(FlightTolerance, RefusesWhatTrimDecides) {
  ToleranceStudy held = study_of({{"vehicle.mass", 0.01}}, 2);
  held.hold = Hold{Held::frequency, 30.0};
  EXPECT_THROW(flight_tolerance(held, {}), ParameterError);
  ToleranceStudy airless = study_of({{"vehicle.mass", 0.01}}, 2);
  airless.condition = Condition::vacuum;
  EXPECT_THROW(flight_tolerance(airless, {}), ParameterError);
  ToleranceStudy heavy = study_of({{"vehicle.mass", 0.01}}, 2);
  heavy.design.mass = 0.03;
  for (UncertainParameter& p : heavy.parameters) p.distribution.centre = 0.03;
  const FlightToleranceResult found = flight_tolerance(heavy, {});
  EXPECT_EQ(found.flies.count, 0u);
  EXPECT_TRUE(std::isnan(found.quantity[0].mean));
  EXPECT_THAT(found.centre_detail, testing::Not(testing::IsEmpty()));
}

}  // namespace
}  // namespace wingbeat
