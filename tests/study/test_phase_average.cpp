#include "wingbeat/study/phase_average.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "wingbeat/core/status.hpp"

namespace wingbeat {
namespace {

/// A course over the cycle with six harmonics, of phase in turns.
double course(double turns) {
  double sum = 0.4;
  for (int h = 1; h <= 6; ++h) sum += std::cos(two_pi * h * turns + 0.7 * h) / (h * h);
  return sum;
}

struct Record {
  double frequency = 21.7, rate = 0.0, duration = 2.0, sampling = 2000.0, noise = 0.0, memory = 0.0;
  std::uint64_t seed = 1;

  /// Turns since the middle of the record.
  double turns(double time) const {
    const double t = time - 0.5 * duration;
    return (frequency + 0.5 * rate * t) * t;
  }
  template <class Course>
  SignalRecord signals(const Course& of_turns) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    SignalRecord record;
    record.channels.resize(1);
    double error = normal(random);
    for (double t = 0.0; t <= duration; t += 1.0 / sampling) {
      record.time.push_back(t);
      record.channels[0].push_back(of_turns(turns(t)) + noise * error);
      error = memory * error + std::sqrt(1.0 - memory * memory) * normal(random);
    }
    return record;
  }
};

double largest_error(const PhaseAverage& mean, const Record& record, double (*of_turns)(double)) {
  double worst = 0.0;
  for (std::size_t k = 0; k < mean.phase.size(); ++k) {
    const double truth = of_turns(mean.phase[k] / two_pi + record.turns(0.0));
    worst = std::max(worst, std::abs(mean.channels[0].mean[k] - truth));
  }
  return worst;
}

TEST(PhaseAverage, FindsThePeriodAndTheCourse) {
  for (const double frequency : {9.3, 21.7, 48.1}) {
    for (const double duration : {0.5, 2.0, 7.0}) {
      Record r;
      r.frequency = frequency;
      r.duration = duration;
      const PhaseAverage mean = phase_average(r.signals(course));
      EXPECT_NEAR(mean.frequency, frequency, 1e-6 * frequency) << duration;
      EXPECT_NEAR(mean.cycles, frequency * duration, 0.1);
      EXPECT_LT(largest_error(mean, r, course), 1e-5) << frequency << " " << duration;
    }
  }
}

TEST(PhaseAverage, FollowsARampOfTheFrequency) {
  for (const double rate : {-1.5, 0.4, 3.0}) {
    Record r;
    r.rate = rate;
    r.noise = 0.02;
    const PhaseAverage mean = phase_average(r.signals(course));
    EXPECT_NEAR(mean.frequency, r.frequency, 5.0 * mean.frequency_error) << rate;
    EXPECT_NEAR(mean.rate, rate, 0.02) << rate;
    EXPECT_LT(largest_error(mean, r, course), 0.03) << rate;
  }
}

// The standard errors are those of the noise: the squares of the errors in units of them have the mean 1, also where
// neighbouring samples err alike, of which a course takes the low frequencies.
TEST(PhaseAverage, DeviationsAreThoseOfTheNoise) {
  for (const double memory : {0.0, 0.8}) {
    double harmonic_squares = 0.0, frequency_squares = 0.0;
    constexpr int records = 60;
    for (int n = 0; n < records; ++n) {
      Record r;
      r.noise = 0.2;
      r.memory = memory;
      r.seed = 100 + std::uint64_t(n);
      const PhaseAverage mean = phase_average(r.signals(course));
      frequency_squares += square((mean.frequency - r.frequency) / mean.frequency_error) / records;
      // The amplitude of the fundamental, which an error of the phase leaves as it is.
      double error = 0.0, variance = 0.0;
      for (std::size_t k = 0; k < mean.phase.size(); ++k) {
        const double turns = mean.phase[k] / two_pi + r.turns(0.0), weight = std::cos(two_pi * turns + 0.7);
        error += weight * (mean.channels[0].mean[k] - course(turns));
        variance += square(weight * mean.channels[0].deviation[k]);
      }
      harmonic_squares += error * error / variance / records;
    }
    EXPECT_GT(harmonic_squares, 0.5) << memory;
    EXPECT_LT(harmonic_squares, 2.0) << memory;
    EXPECT_GT(frequency_squares, 0.5) << memory;
    EXPECT_LT(frequency_squares, 2.0) << memory;
  }
}

// A current whose half-strokes are nearly alike has its strongest component at twice the frequency.
TEST(PhaseAverage, TellsTheCycleFromItsHalf) {
  Record r;
  r.noise = 0.05;
  const auto uneven = [](double turns) { return std::cos(2.0 * two_pi * turns) + 0.15 * std::cos(two_pi * turns); };
  const auto even = [](double turns) { return std::cos(2.0 * two_pi * turns); };
  EXPECT_NEAR(phase_average(r.signals(uneven)).frequency, r.frequency, 0.01);
  EXPECT_NEAR(phase_average(r.signals(even)).frequency, 2.0 * r.frequency, 0.01);
  PhaseAverageOptions about;
  about.frequency = 20.0;
  EXPECT_NEAR(phase_average(r.signals(even), about).frequency, r.frequency, 0.01);
}

// A camera takes a few pictures in each cycle, at uneven times.
TEST(PhaseAverage, FewSamplesInACycle) {
  Record r;
  r.sampling = 130.0;
  r.duration = 6.0;
  SignalRecord record =
      r.signals([](double turns) { return std::cos(two_pi * turns) + 0.1 * std::sin(2 * two_pi * turns); });
  for (std::size_t n = 0; n < record.time.size(); n += 7) record.channels[0][n] = NAN;
  const PhaseAverage mean = phase_average(record);
  EXPECT_NEAR(mean.frequency, r.frequency, 1e-6 * r.frequency);
  EXPECT_GE(mean.phase.size(), 16u);
}

TEST(PhaseAverage, RefusesWhatHasNoPeriod) {
  const auto refusal = [](const SignalRecord& record, const PhaseAverageOptions& options = {}) {
    try {
      phase_average(record, options);
    } catch (const ParameterError& error) {
      return error.reason();
    }
    return std::string();
  };
  Record r;
  r.duration = 0.01;
  EXPECT_THAT(refusal(r.signals(course)), testing::HasSubstr("needs at least 32 samples, got "));
  r.duration = 0.1;
  PhaseAverageOptions about;
  about.frequency = 21.0;
  EXPECT_THAT(refusal(r.signals(course), about), testing::HasSubstr("2.1 cycles"));
  r.duration = 1.0;
  EXPECT_THAT(refusal(r.signals([](double) { return 3.0; })), testing::HasSubstr("no period"));
  SignalRecord uneven = r.signals(course);
  uneven.time.back() = 1e12;
  EXPECT_THAT(refusal(uneven), testing::HasSubstr("too uneven"));
  for (double& t : uneven.time) t = 1.0;
  EXPECT_THAT(refusal(uneven), testing::HasSubstr("too uneven"));
}

}  // namespace
}  // namespace wingbeat
