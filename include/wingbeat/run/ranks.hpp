// Processes of one run that exchange messages: the ranks of MPI. The library that talks to MPI is loaded only in a
// process that mpirun (or srun) has started, so that other processes do not wait for it.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace wingbeat {

struct RankModule;

class Ranks {
 public:
  /// Null unless this process was started as one of several. Throws std::runtime_error where it was, but the program
  /// was built without MPI.
  static std::unique_ptr<Ranks> join();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  /// Waits for the other ranks to leave too.
  ~Ranks();

  int rank() const { return rank_; }
  int count() const { return count_; }

  struct Message {
    int from = 0;
    int tag = 0;
    std::vector<std::byte> bytes;
  };
  void send(int to, int tag, std::span<const std::byte> bytes = {});
  /// A message if one has come.
  std::optional<Message> poll();
  Message receive();
  /// Ends all ranks at once.
  [[noreturn]] void abort();

 private:
  explicit Ranks(const RankModule& module);

  const RankModule& module_;
  int rank_ = 0;
  int count_ = 1;
};

/// What the library that talks to MPI offers. Each function gives 0, or an error code of MPI.
struct RankModule {
  int (*start)(int* rank, int* count);
  int (*send)(int to, int tag, const void* bytes, int length);
  /// `wait` 0: *found tells whether there is a message.
  int (*probe)(int wait, int* found, int* from, int* tag, int* length);
  int (*receive)(int from, int tag, void* bytes, int length);
  void (*finish)();
  void (*abort)();
};

}  // namespace wingbeat
