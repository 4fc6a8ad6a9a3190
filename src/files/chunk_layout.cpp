#include "wingbeat/files/chunk_layout.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace wingbeat {

constexpr std::uint64_t largest_chunk = 8192;

std::uint64_t ChunkLayout::begin(std::size_t column) const {
  // Flags are a byte each, but for the last, the domain, of two.
  const std::uint64_t all_flags = (bytes_of_flags * chunk + 7) & ~std::uint64_t(7);
  return column < flags ? column * chunk : all_flags + 8 * chunk * (column - flags);
}

ChunkLayout layout_of(const Sweep& sweep) {
  const std::uint64_t designs = sweep.size();
  return {designs, std::min(designs, largest_chunk), sweep.options.metrics.count()};
}

void pack(const ChunkLayout& layout, const SweepColumns& columns, std::vector<std::byte>& bytes) {
  const std::size_t n = columns.status.size();
  bytes.resize(layout.bytes());
  if (n < layout.chunk) std::fill(bytes.begin(), bytes.end(), std::byte(0));
  std::fill(bytes.begin() + std::ptrdiff_t(layout.bytes_of_flags * layout.chunk),
            bytes.begin() + std::ptrdiff_t(layout.begin(layout.flags)), std::byte(0));
  std::memcpy(bytes.data(), columns.status.data(), n);
  std::memcpy(bytes.data() + layout.begin(1), columns.recomputed.data(), n);
  std::memcpy(bytes.data() + layout.begin(2), columns.domain.data(), 2 * n);
  std::memcpy(bytes.data() + layout.begin(3), columns.error_estimate.data(), 8 * n);
  for (std::size_t m = 0; m < columns.metrics.size(); ++m) {
    std::memcpy(bytes.data() + layout.begin(4 + m), columns.metrics[m].data(), 8 * n);
  }
}

std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t seed) {
  // Four sums side by side, so that their multiplications overlap.
  constexpr std::uint64_t factor = 0x9e3779b97f4a7c15;
  std::uint64_t lanes[4] = {seed ^ 1, seed ^ 2, seed ^ 3, seed ^ 4};
  std::size_t position = 0;
  const auto take = [&](std::uint64_t& lane, std::uint64_t word) { lane = std::rotl((lane ^ word) * factor, 29); };
  for (; position + 32 <= bytes.size(); position += 32) {
    for (int k = 0; k < 4; ++k) {
      std::uint64_t word;
      std::memcpy(&word, bytes.data() + position + 8 * k, 8);
      take(lanes[k], word);
    }
  }
  for (; position < bytes.size(); ++position) take(lanes[position % 4], std::uint64_t(bytes[position]) + 0x100);
  std::uint64_t sum = bytes.size();
  for (const std::uint64_t lane : lanes) take(sum, lane);
  return sum ^ (sum >> 32);
}

}  // namespace wingbeat
