// A sweep from study to data set: chunks computed by all cores, and by other ranks, kept in a journal on the way.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "wingbeat/files/study_file.hpp"
#include "wingbeat/files/sweep_data_set.hpp"
#include "wingbeat/run/ranks.hpp"

namespace wingbeat {

struct SweepProgress {
  std::uint64_t designs = 0;   ///< of the whole sweep
  std::uint64_t done = 0;      ///< designs whose results are there
  std::uint64_t computed = 0;  ///< of these, by this process and its ranks
  double seconds = 0.0;        ///< since the beginning
};

struct SweepRunOptions {
  std::filesystem::path output;
  std::string version;                                 ///< of the program, for the data set
  int threads = 0;                                     ///< at most; 0: one for each core
  std::function<void(const SweepProgress&)> progress;  ///< called now and then, by one thread at a time
  std::function<bool()> stop;                          ///< true: no chunk is begun any more
  bool force = false;                                  ///< replaces files that are not of this sweep
  Ranks* ranks = nullptr;                              ///< rank 0 of several, or null
};

struct SweepResult {
  enum class Outcome {
    finished,
    was_finished,  ///< the data set was there already
    stopped        ///< what is done is kept, and the same call continues from there
  };
  Outcome outcome = Outcome::finished;
  SweepProgress progress;
  std::uint64_t resumed = 0;  ///< designs that an earlier call had done
  SweepDigest digest;         ///< empty where stopped
};

/// The data set until it is complete, and the journal of what it holds: beside it, with .part and .journal added.
std::filesystem::path unfinished_file(const std::filesystem::path& output);
std::filesystem::path journal_file(const std::filesystem::path& output);

/// Computes what is missing and writes the data set, which then appears under its name at once. The file is the same,
/// byte for byte, whatever the number of threads, ranks and interruptions. Throws InputError where the output cannot be
/// written or is something else, std::runtime_error where there is no room; what is finished is kept then.
SweepResult run_sweep(const Study& study, const SweepRunOptions& options);

/// A whole sweep that fits into memory, by at most so many threads (0: one for each core). `progress` is called as that
/// of run_sweep is.
SweepColumns solve_sweep(const Sweep& sweep, int threads = 0,
                         const std::function<void(const SweepProgress&)>& progress = {});

/// On rank 0: lets the other ranks go in the end, whatever happens.
class SweepRelease {
 public:
  explicit SweepRelease(Ranks* ranks) : ranks_(ranks) {}
  SweepRelease(const SweepRelease&) = delete;
  SweepRelease& operator=(const SweepRelease&) = delete;
  ~SweepRelease();

 private:
  Ranks* ranks_;
};

/// What every other rank does: computes the chunks that rank 0 hands out until it has no more.
void serve_sweep(Ranks& ranks, int threads);

}  // namespace wingbeat
