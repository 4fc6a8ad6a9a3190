// The finished chunks of a sweep under way, in a file that survives a kill at any instant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "wingbeat/study/sweep.hpp"

namespace wingbeat {

/// How a sweep is divided into chunks, each a run of designs, and how one is stored.
struct ChunkLayout {
  std::uint64_t designs = 0;
  std::uint64_t chunk = 1;  ///< designs of a chunk; the last may hold fewer
  std::uint64_t metrics = 0;

  std::uint64_t chunks() const { return (designs + chunk - 1) / chunk; }
  std::uint64_t first(std::uint64_t c) const { return c * chunk; }
  std::uint64_t size(std::uint64_t c) const { return std::min(chunk, designs - c * chunk); }
  std::uint64_t bytes() const;  ///< of a packed chunk
};

/// The layout of a sweep: chunks small enough to be lost, large enough to be handed out.
ChunkLayout layout_of(const Sweep& sweep);

/// A chunk as bytes and back; `columns` keeps its memory.
void pack(const ChunkLayout& layout, const SweepColumns& columns, std::vector<std::byte>& bytes);
void unpack(const ChunkLayout& layout, std::uint64_t chunk, std::span<const std::byte> bytes, SweepColumns& columns);

/// A 64-bit check sum.
std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t seed = 0);

/// The file: a header that says which study, then chunks in the order in which they were finished, each with a check
/// sum. A chunk that was being written when the process died is overwritten by the next. One process at a time.
class SweepJournal {
 public:
  /// Opens the file, or creates it. Throws InputError, which leaves the file as it was, if it cannot be written, if it
  /// belongs to another study or to a running process.
  SweepJournal(const std::filesystem::path& file, std::uint64_t fingerprint, const ChunkLayout& layout);
  SweepJournal(const SweepJournal&) = delete;
  SweepJournal& operator=(const SweepJournal&) = delete;
  ~SweepJournal();

  bool holds(std::uint64_t chunk) const { return record_of_chunk_[chunk] != none; }
  std::uint64_t chunks_held() const { return records_; }
  std::uint64_t designs_held() const;

  /// Appends a packed chunk. Throws std::runtime_error where there is no room for it.
  void append(std::uint64_t chunk, std::span<const std::byte> bytes);
  /// Throws std::runtime_error where it cannot be read back as it was written.
  void read(std::uint64_t chunk, std::vector<std::byte>& bytes) const;
  void remove();

 private:
  static constexpr std::uint32_t none = 0xffffffff;
  std::uint64_t offset(std::uint32_t record) const;

  std::filesystem::path file_;
  ChunkLayout layout_;
  int descriptor_ = -1;
  std::uint32_t records_ = 0;
  std::vector<std::uint32_t> record_of_chunk_;
  std::vector<std::byte> buffer_;
};

}  // namespace wingbeat
