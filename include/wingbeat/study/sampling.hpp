// Samples of the unit cube of which any can be computed from its index alone: the same numbers on any number of threads
// and machines, and no memory that grows with their number.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace wingbeat {

/// Latin hypercube: along each dimension every one of `count` equal intervals holds one sample, at a random place in
/// it. The order of the intervals is a pseudo-random permutation of each dimension's own.
struct LatinHypercube {
  std::uint64_t count = 1;
  std::uint64_t seed = 0;

  /// Coordinate of a sample, between 0 and 1.
  double operator()(std::uint64_t index, std::size_t dimension) const;
};

/// Pseudo-random numbers, independent of each other: plain Monte Carlo.
struct PseudoRandom {
  std::uint64_t seed = 0;

  /// Coordinate of a sample, between 0 and 1.
  double operator()(std::uint64_t index, std::size_t dimension) const;
};

/// The Sobol sequence with the direction numbers of Boost.Random (Joe and Kuo 2008) under Owen's nested scrambling, by
/// the hash of Laine and Karras in Vegdahl's form (Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020).
/// Any 2^k samples from a multiple of 2^k on hold one in each of 2^k equal intervals along each dimension.
class ScrambledSobol {
 public:
  /// The largest number of samples: beyond it they would repeat.
  static constexpr std::uint64_t max_samples = std::uint64_t(1) << 32;
  static constexpr std::size_t max_dimensions = 100;

  /// Throws ParameterError for more dimensions than max_dimensions.
  ScrambledSobol(std::size_t dimensions, std::uint64_t seed);

  /// Coordinate of a sample, between 0 and 1; index < max_samples.
  double operator()(std::uint64_t index, std::size_t dimension) const;

 private:
  struct Dimension {
    std::array<std::uint32_t, 32> directions;
    std::uint32_t seed;
  };
  std::vector<Dimension> dimensions_;
};

}  // namespace wingbeat
