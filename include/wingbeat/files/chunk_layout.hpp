// The results of a sweep as runs of designs, column after column: how data set and journal store them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "wingbeat/study/sweep.hpp"

namespace wingbeat {

/// How a sweep is divided into chunks, each a run of designs.
struct ChunkLayout {
  std::uint64_t designs = 0;
  std::uint64_t chunk = 1;  ///< designs of a chunk; the last may hold fewer
  std::uint64_t metrics = 0;

  std::uint64_t chunks() const { return (designs + chunk - 1) / chunk; }
  std::uint64_t first(std::uint64_t c) const { return c * chunk; }
  std::uint64_t size(std::uint64_t c) const { return std::min(chunk, designs - c * chunk); }
  /// Columns of results: status, recomputed, domain, error estimate, metrics.
  static constexpr std::size_t flags = 3;
  static constexpr std::uint64_t bytes_of_flags = 4;  ///< of one design
  std::size_t columns() const { return flags + 1 + std::size_t(metrics); }
  std::size_t bytes_of_value(std::size_t column) const { return column < 2 ? 1 : column == 2 ? 2 : 8; }
  /// Place of a column in a packed chunk [bytes].
  std::uint64_t begin(std::size_t column) const;
  std::uint64_t bytes() const { return begin(columns()); }
};

/// The layout of a sweep: chunks small enough to be lost, large enough to be handed out.
ChunkLayout layout_of(const Sweep& sweep);

/// A chunk as bytes, column after column; what the last chunk lacks is zero.
void pack(const ChunkLayout& layout, const SweepColumns& columns, std::vector<std::byte>& bytes);

/// A 64-bit check sum.
std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t seed = 0);

}  // namespace wingbeat
