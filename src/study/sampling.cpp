#include "wingbeat/study/sampling.hpp"

#include <bit>
#include <boost/random/sobol.hpp>

#include "wingbeat/core/status.hpp"

namespace wingbeat {
namespace {

/// A well-mixed 64-bit number for each input (splitmix64: Steele, Lea and Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

std::uint64_t mixed(std::uint64_t seed, std::uint64_t a) { return mixed(mixed(seed) ^ a); }

/// A permutation of 0 .. count - 1 chosen by the key. A few rounds of reversible operations permute the next power of
/// two; results beyond count are permuted again.
std::uint64_t permuted(std::uint64_t x, std::uint64_t count, std::uint64_t key) {
  const int bits = std::bit_width(count - 1);
  if (bits == 0) return 0;
  const std::uint64_t mask = bits == 64 ? ~std::uint64_t(0) : (std::uint64_t(1) << bits) - 1;
  const int half = (bits + 1) / 2;
  do {
    std::uint64_t round_key = key;
    for (int round = 0; round < 4; ++round) {
      round_key = mixed(round_key);
      x = (x * (round_key | 1) + (round_key >> 32)) & mask;
      x ^= x >> half;
    }
  } while (x >= count);
  return x;
}

std::uint32_t reversed(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  return __builtin_bswap32(x);
}

/// Each bit is flipped by a hash of the bits above it: with the bits reversed, of those below.
std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
  x = reversed(x);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reversed(x);
}

}  // namespace

double LatinHypercube::operator()(std::uint64_t index, std::size_t dimension) const {
  const std::uint64_t key = mixed(seed, 2 * dimension);
  const double within = (double(mixed(key ^ 0x5bf03635, index) >> 12) + 0.5) * 0x1p-52;
  return (double(permuted(index, count, key)) + within) / double(count);
}

double PseudoRandom::operator()(std::uint64_t index, std::size_t dimension) const {
  return (double(mixed(mixed(seed, 2 * dimension), index) >> 12) + 0.5) * 0x1p-52;
}

ScrambledSobol::ScrambledSobol(std::size_t dimensions, std::uint64_t seed) {
  require(dimensions >= 1 && dimensions <= max_dimensions, "samples", "must vary 1 to 100 parameters", "1",
          double(dimensions));
  dimensions_.resize(dimensions);
  for (std::size_t d = 0; d < dimensions; ++d) dimensions_[d].seed = std::uint32_t(mixed(seed, 2 * d + 1) >> 32);
  // In the order of Gray codes sample n is sample n - 1 with direction k exclusive-ored, k the number of trailing zeros
  // of n: two neighbours show a direction. The engine leaves out sample 0, which is 0.
  using Engine = boost::random::sobol_engine<std::uint32_t, 32, boost::random::default_sobol_table>;
  std::vector<std::uint32_t> before(dimensions, 0), at(dimensions);
  for (unsigned k = 0; k < 32; ++k) {
    Engine engine(dimensions);
    if (k > 0) {
      engine.seed((std::uint32_t(1) << k) - 2);  // the next is the sample after this one
      for (auto& x : before) x = engine();
    }
    for (auto& x : at) x = engine();
    for (std::size_t d = 0; d < dimensions; ++d) dimensions_[d].directions[k] = before[d] ^ at[d];
  }
}

double ScrambledSobol::operator()(std::uint64_t index, std::size_t dimension) const {
  const Dimension& d = dimensions_[dimension];
  std::uint32_t x = 0;
  // Natural order instead of that of Gray codes: the same points in every aligned run of 2^k.
  for (std::uint32_t rest = std::uint32_t(index); rest != 0; rest &= rest - 1)
    x ^= d.directions[std::countr_zero(rest)];
  return (double(scrambled(x, d.seed)) + 0.5) * 0x1p-32;
}

}  // namespace wingbeat
