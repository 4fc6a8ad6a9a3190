// The results of a sweep under way, which survive a kill at any instant: the data set itself, filled chunk by chunk,
// and beside it a journal of the chunks that are there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "wingbeat/files/chunk_layout.hpp"

namespace wingbeat {

/// The data set under way and its journal: a header that says which sweep, then the chunks in the order in which they
/// were stored, each with a check sum. A chunk that was being stored when the process died does not count. One process
/// at a time.
class SweepJournal {
 public:
  /// Makes a file with room for all results and gives the place of each column in it [bytes].
  using Prepare = std::function<std::vector<std::uint64_t>(const std::filesystem::path& file)>;

  /// Opens journal and data set, or creates them. Throws InputError, which leaves what is there as it was, if they
  /// cannot be written, if they belong to a running process, or, unless `force` says that they may be replaced, to
  /// another sweep; std::runtime_error where there is no room for a data set of `size` bytes.
  SweepJournal(const std::filesystem::path& journal, const std::filesystem::path& data_set, bool force,
               std::uint64_t fingerprint, const ChunkLayout& layout, std::uint64_t size, const Prepare& prepare);
  SweepJournal(const SweepJournal&) = delete;
  SweepJournal& operator=(const SweepJournal&) = delete;
  ~SweepJournal();

  /// Removes the journal of a sweep whose data set has got its name: what a process that was killed between the two has
  /// left. A journal of another sweep, or of a running process, stays.
  static void remove_finished(const std::filesystem::path& journal, const std::filesystem::path& data_set,
                              std::uint64_t fingerprint);

  bool holds(std::uint64_t chunk) const { return held_[chunk]; }
  std::uint64_t chunks_held() const { return records_; }
  std::uint64_t designs_held() const;

  /// Stores a packed chunk. Throws std::runtime_error where there is no room for it.
  void append(std::uint64_t chunk, std::span<const std::byte> bytes);
  /// The complete data set gets its name, and the journal goes. Throws std::runtime_error.
  void finish(const std::filesystem::path& name);

 private:
  void lock(std::uint64_t fingerprint, std::uint64_t size, const Prepare& prepare);
  void reserve(std::uint64_t size, bool fresh) const;
  void take_over();
  std::uint64_t frame_sum(int data_file, std::span<const std::uint64_t> places) const;
  void close();
  bool transfer(std::uint64_t chunk, std::byte* bytes, bool write) const;
  std::uint64_t record_at(std::uint64_t record) const;
  [[noreturn]] void refuse(const std::filesystem::path& file, const std::string& reason);
  [[noreturn]] void failed(const std::filesystem::path& file, int reason) const;

  std::filesystem::path journal_, data_set_;
  bool force_;
  ChunkLayout layout_;
  int journal_file_ = -1, data_file_ = -1;
  std::vector<std::uint64_t> places_;
  std::uint64_t frame_ = 0;  ///< check sum of what stands around the columns
  std::uint64_t records_ = 0;
  std::vector<bool> held_;
};

}  // namespace wingbeat
