#include "wingbeat/study/sampling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "wingbeat/core/status.hpp"

namespace wingbeat {
namespace {

/// How many samples from `first` on fall into each of `count` equal intervals.
template <class Sampler>
std::vector<int> histogram(const Sampler& sampler, std::size_t dimension, std::uint64_t first, std::uint64_t count) {
  std::vector<int> hits(count, 0);
  for (std::uint64_t n = first; n < first + count; ++n) {
    const double u = sampler(n, dimension);
    EXPECT_GT(u, 0.0);
    EXPECT_LT(u, 1.0);
    ++hits[std::size_t(u * double(count))];
  }
  return hits;
}

TEST(LatinHypercube, PutsOneSampleIntoEachInterval) {
  for (const std::uint64_t count : {1U, 2U, 3U, 10U, 64U, 1000U, 4097U}) {
    const LatinHypercube sampler{count, 7};
    for (std::size_t d = 0; d < 5; ++d) {
      EXPECT_EQ(histogram(sampler, d, 0, count), std::vector<int>(count, 1)) << count << " samples, dimension " << d;
    }
  }
}

TEST(LatinHypercube, DimensionsAndSeedsAreUnrelated) {
  const std::uint64_t count = 2000;
  const auto correlation = [&](const LatinHypercube& a, std::size_t da, const LatinHypercube& b, std::size_t db) {
    double sum = 0.0;
    for (std::uint64_t n = 0; n < count; ++n) sum += (a(n, da) - 0.5) * (b(n, db) - 0.5);
    return 12.0 * sum / double(count);
  };
  const LatinHypercube one{count, 1}, two{count, 2};
  for (std::size_t d = 0; d < 6; ++d) {
    // The correlation of 2000 unrelated pairs has a standard deviation of 0.022.
    EXPECT_LT(std::abs(correlation(one, d, one, d + 1)), 0.1);
    EXPECT_LT(std::abs(correlation(one, d, two, d)), 0.1);
    EXPECT_EQ(one(17, d), LatinHypercube(one)(17, d));
  }
}

TEST(ScrambledSobol, EveryAlignedRunIsStratified) {
  const ScrambledSobol sampler(8, 3);
  for (std::size_t d = 0; d < 8; ++d) {
    for (const std::uint64_t count : {1U, 2U, 16U, 256U, 4096U}) {
      EXPECT_EQ(histogram(sampler, d, 0, count), std::vector<int>(count, 1));
      EXPECT_EQ(histogram(sampler, d, 5 * count, count), std::vector<int>(count, 1));
    }
  }
}

TEST(ScrambledSobol, TheFirstTwoDimensionsFillEveryElementaryRectangle) {
  const ScrambledSobol sampler(2, 11);
  constexpr int bits = 8;
  for (int split = 0; split <= bits; ++split) {
    const int across = 1 << split, up = 1 << (bits - split);
    std::set<int> cells;
    for (std::uint64_t n = 0; n < (1U << bits); ++n) {
      cells.insert(int(sampler(n, 0) * across) * up + int(sampler(n, 1) * up));
    }
    EXPECT_EQ(cells.size(), std::size_t(1) << bits) << across << " x " << up;
  }
}

TEST(ScrambledSobol, IntegratesFarBetterThanRandomNumbers) {
  const ScrambledSobol sampler(4, 5);
  double sum = 0.0;
  const int count = 4096;
  for (int n = 0; n < count; ++n) {
    double product = 1.0;
    for (std::size_t d = 0; d < 4; ++d) product *= 1.0 + (sampler(std::uint64_t(n), d) - 0.5);
    sum += product;
  }
  // Random numbers: a standard deviation of 0.01.
  EXPECT_NEAR(sum / count, 1.0, 3e-4);
}

TEST(ScrambledSobol, SeedsScrambleDifferentlyAndLateSamplesExist) {
  const ScrambledSobol one(3, 1), two(3, 2);
  EXPECT_NE(one(0, 0), two(0, 0));
  EXPECT_NE(one(0, 0), one(0, 1));
  EXPECT_EQ(one(12345, 2), ScrambledSobol(3, 1)(12345, 2));
  std::set<double> late;
  for (std::uint64_t n = ScrambledSobol::max_samples - 100; n < ScrambledSobol::max_samples; ++n)
    late.insert(one(n, 2));
  EXPECT_EQ(late.size(), 100U);
  EXPECT_THROW(ScrambledSobol(0, 1), ParameterError);
  EXPECT_THROW(ScrambledSobol(101, 1), ParameterError);
}

}  // namespace
}  // namespace wingbeat
