#include "wingbeat/run/sweep_run.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <deque>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "wingbeat/core/cancellation.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/file_record.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/run/parallel.hpp"
#include "wingbeat/run/sweep_journal.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// One solver for each thread that ever computes.
using Solvers = tbb::enumerable_thread_specific<SweepSolver>;

Solvers make_solvers(const Sweep& sweep) {
  return Solvers([&sweep] { return SweepSolver(sweep, start_up_in_time()); });
}

/// Computes a chunk with all threads that are free.
template <class BlockDone>
void solve_chunk(Solvers& solvers, const ChunkLayout& layout, std::uint64_t chunk, SweepColumns& columns,
                 const BlockDone& block_done) {
  const std::size_t size = std::size_t(layout.size(chunk));
  columns.first = layout.first(chunk);
  columns.resize(size, std::size_t(layout.metrics));
  const std::size_t blocks = (size + sweep_block - 1) / sweep_block;
  for_each_in_parallel(blocks, [&](std::size_t b) {
    const std::size_t begin = b * sweep_block, end = std::min(size, begin + sweep_block);
    solvers.local().solve(columns, begin, end);
    block_done(end - begin);
  });
}

// What ranks say to each other.
enum Tag { tag_study, tag_chunk, tag_result, tag_stop };

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

std::string setup_message(const Study& study) {
  const EnsembleOptions& o = study.sweep.options;
  return nlohmann::json{{"study_name", study.input.study_name},
                        {"study", study.input.study},
                        {"vehicle", study.input.vehicle},
                        {"table_name", study.input.table_name},
                        {"table", study.input.table},
                        {"tolerance", o.tolerance},
                        {"isa", int(o.isa)}}
      .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Study study_in(const Ranks::Message& message) {
  const auto json = nlohmann::json::parse(reinterpret_cast<const char*>(message.bytes.data()),
                                          reinterpret_cast<const char*>(message.bytes.data()) + message.bytes.size());
  Study study = parse_study({json["study_name"], json["study"], json["vehicle"], json["table_name"], json["table"]});
  study.sweep.options.tolerance = json["tolerance"];
  study.sweep.options.isa = InstructionSet(json["isa"].get<int>());
  return study;
}

/// A sweep under way on rank 0.
class Run {
 public:
  Run(const Study& study, const SweepRunOptions& options, SweepJournal& journal)
      : options_(options),
        layout_(layout_of(study.sweep)),
        journal_(journal),
        solvers_(make_solvers(study.sweep)),
        start_(Clock::now()),
        shown_(start_) {
    progress_.designs = layout_.designs;
    progress_.done = journal.designs_held();
  }

  /// True if every chunk is there.
  bool compute(const Study& study) {
    if (options_.ranks) {
      compute_with_ranks(*options_.ranks, study);
    } else {
      compute_here();
    }
    if (failure_) std::rethrow_exception(failure_);
    return journal_.chunks_held() == layout_.chunks();
  }

  SweepProgress progress() {
    progress_.seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    return progress_;
  }

 private:
  /// The next chunk to be computed, by anybody.
  std::optional<std::uint64_t> next() {
    const std::lock_guard lock(mutex_);
    if (failure_ || (options_.stop && options_.stop())) return std::nullopt;
    while (next_ < layout_.chunks() && journal_.holds(next_)) ++next_;
    if (next_ == layout_.chunks()) return std::nullopt;
    return next_++;
  }

  /// Keeps a chunk. Where that fails no more are handed out.
  void keep(std::uint64_t chunk, std::span<const std::byte> bytes) {
    const std::lock_guard lock(mutex_);
    try {
      if (!failure_) journal_.append(chunk, bytes);
    } catch (...) {
      failure_ = std::current_exception();
    }
  }

  void count(std::uint64_t designs) {
    const std::lock_guard lock(progress_mutex_);
    progress_.done += designs;
    progress_.computed += designs;
    const auto now = Clock::now();
    if (!options_.progress || now - shown_ < std::chrono::milliseconds(200)) return;
    shown_ = now;
    options_.progress(progress());
  }

  void compute_here() {
    struct Work {
      std::uint64_t chunk;
      SweepColumns columns;
      std::vector<std::byte> bytes;
    };
    // One chunk more than threads, so that no thread waits for the end of a chunk.
    const std::size_t max_pieces = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism) + 1;
    std::mutex pool_mutex;
    std::deque<Work> works;  // those under way, too: where a stage throws, none is lost
    std::vector<Work*> idle;
    const auto begin = [&](tbb::flow_control& flow) -> Work* {
      const auto chunk = next();
      if (!chunk) {
        flow.stop();
        return nullptr;
      }
      const std::lock_guard lock(pool_mutex);
      if (idle.empty()) idle.push_back(&works.emplace_back());
      Work* const work = idle.back();
      idle.pop_back();
      work->chunk = *chunk;
      return work;
    };
    Cancellation* const cancellation = current_cancellation();
    const auto solve = [&](Work* work) {
      const CancellationScope scope(cancellation);
      solve_chunk(solvers_, layout_, work->chunk, work->columns, [&](std::size_t designs) { count(designs); });
      pack(layout_, work->columns, work->bytes);
      return work;
    };
    const auto end = [&](Work* work) {
      keep(work->chunk, work->bytes);
      const std::lock_guard lock(pool_mutex);
      idle.push_back(work);
    };
    tbb::parallel_pipeline(max_pieces, tbb::make_filter<void, Work*>(tbb::filter_mode::serial_in_order, begin) &
                                           tbb::make_filter<Work*, Work*>(tbb::filter_mode::parallel, solve) &
                                           tbb::make_filter<Work*, void>(tbb::filter_mode::serial_out_of_order, end));
  }

  void compute_with_ranks(Ranks& ranks, const Study& study) {
    const std::string setup = setup_message(study);
    for (int r = 1; r < ranks.count(); ++r) ranks.send(r, tag_study, bytes_of(setup));
    std::uint64_t abroad = 0;
    const auto hand_out = [&](int rank) {
      const auto chunk = next();
      if (!chunk) return;
      ranks.send(rank, tag_chunk, std::as_bytes(std::span(&*chunk, 1)));
      ++abroad;
    };
    // Two chunks each, so that no rank waits for a message.
    for (int round = 0; round < 2; ++round) {
      for (int r = 1; r < ranks.count(); ++r) hand_out(r);
    }
    std::atomic<bool> at_work = true;
    Cancellation* const cancellation = current_cancellation();
    std::thread here([&] {
      const CancellationScope scope(cancellation);
      try {
        compute_here();
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::current_exception();
      }
      at_work = false;
    });
    while (at_work || abroad > 0) {
      const auto message = ranks.poll();
      if (!message) {
        std::this_thread::sleep_for(std::chrono::microseconds(300));
        continue;
      }
      std::uint64_t chunk = 0;
      std::memcpy(&chunk, message->bytes.data(), sizeof chunk);
      keep(chunk, std::span(message->bytes).subspan(sizeof chunk));
      --abroad;
      hand_out(message->from);
      count(layout_.size(chunk));
    }
    here.join();
  }

  const SweepRunOptions& options_;
  ChunkLayout layout_;
  SweepJournal& journal_;
  Solvers solvers_;
  Clock::time_point start_, shown_;
  std::mutex mutex_, progress_mutex_;
  std::uint64_t next_ = 0;
  std::exception_ptr failure_;
  SweepProgress progress_;
};

}  // namespace

SweepRelease::~SweepRelease() {
  if (!ranks_) return;
  for (int r = 1; r < ranks_->count(); ++r) {
    try {
      ranks_->send(r, tag_stop);
    } catch (const std::exception&) {
      // A rank out of reach cannot be told.
    }
  }
}

fs::path journal_file(const fs::path& output) { return output.string() + ".journal"; }
fs::path unfinished_file(const fs::path& output) { return output.string() + ".part"; }

SweepResult run_sweep(const Study& study, const SweepRunOptions& options) {
  const std::uint64_t print = fingerprint(study, options.version);
  SweepResult result;
  FileRecord& record = FileRecord::of_this_program();
  // A symbolic link keeps pointing where it did: the file behind it is made.
  const fs::path output = followed("-o", options.output);
  // A data set may be named as study and output: it is not written where it holds that very sweep.
  const bool is_input = record.name_read(output).has_value();
  if (standing_of(output, print, "-o", options.force || is_input) == Standing::same_sweep) {
    SweepJournal::remove_finished(journal_file(output), unfinished_file(output), print);
    result.outcome = SweepResult::Outcome::was_finished;
    result.progress.designs = result.progress.done = study.sweep.size();
    result.digest = digest_of(output, study);
    return result;
  }

  const std::pair<fs::path, fs::path> written[] = {{options.output, output},
                                                   {journal_file(options.output), journal_file(output)},
                                                   {unfinished_file(options.output), unfinished_file(output)}};
  for (const auto& [shown, file] : written) {
    check_not_read("-o", shown, file);
    if (const auto other = record.add_output(file, "-o")) {
      throw InputError("-o " + shown.string(), 0, 0, "",
                       fmt::format("is also the file of {}; give another name", *other));
    }
  }
  std::optional<tbb::global_control> limit;
  if (options.threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(options.threads));
  }
  SweepJournal journal(journal_file(output), unfinished_file(output), options.force, print, layout_of(study.sweep),
                       data_set_size(study),
                       [&](const fs::path& file) { return prepare_data_set(file, study, options.version); });
  result.resumed = journal.designs_held();
  Run run(study, options, journal);
  const bool complete = run.compute(study);
  result.progress = run.progress();
  if (!complete) {
    result.outcome = SweepResult::Outcome::stopped;
    return result;
  }

  journal.finish(output);
  result.digest = digest_of(output, study);
  result.progress = run.progress();
  return result;
}

SweepColumns solve_sweep(const Sweep& sweep, int threads, const std::function<void(const SweepProgress&)>& progress) {
  std::optional<tbb::global_control> limit;
  if (threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
  Solvers solvers = make_solvers(sweep);
  const ChunkLayout layout{sweep.size(), sweep.size(), sweep.options.metrics.count()};
  SweepColumns columns;
  SweepProgress state;
  state.designs = sweep.size();
  std::mutex mutex;
  const Clock::time_point start = Clock::now();
  Clock::time_point shown = start;
  solve_chunk(solvers, layout, 0, columns, [&](std::size_t designs) {
    const std::lock_guard<std::mutex> lock(mutex);
    state.done = state.computed += designs;
    const Clock::time_point now = Clock::now();
    if (!progress || now - shown < std::chrono::milliseconds(100)) return;
    shown = now;
    state.seconds = std::chrono::duration<double>(now - start).count();
    progress(state);
  });
  return columns;
}

void serve_sweep(Ranks& ranks, int threads) {
  std::optional<tbb::global_control> limit;
  if (threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
  Study study;
  std::optional<Solvers> solvers;
  ChunkLayout layout;
  SweepColumns columns;
  std::vector<std::byte> bytes, message;
  while (true) {
    const Ranks::Message order = ranks.receive();
    if (order.tag == tag_stop) return;
    if (order.tag == tag_study) {
      study = study_in(order);
      layout = layout_of(study.sweep);
      const Sweep& sweep = study.sweep;
      solvers.emplace([&sweep] { return SweepSolver(sweep, start_up_in_time()); });
      continue;
    }
    std::uint64_t chunk = 0;
    std::memcpy(&chunk, order.bytes.data(), sizeof chunk);
    solve_chunk(*solvers, layout, chunk, columns, [](std::size_t) {});
    pack(layout, columns, bytes);
    message.resize(sizeof chunk + bytes.size());
    std::memcpy(message.data(), &chunk, sizeof chunk);
    std::memcpy(message.data() + sizeof chunk, bytes.data(), bytes.size());
    ranks.send(0, tag_result, message);
  }
}

}  // namespace wingbeat
