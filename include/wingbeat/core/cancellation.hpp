// Computations that can be asked to stop, from another thread or from within.
//
//   Cancellation cancellation;                        // shared with the thread that may ask
//   const CancellationScope scope(&cancellation);     // on the thread that computes
//   solve(design);                                    // throws Cancelled soon after cancellation.request()
//
// Every solver asks at each of its steps, whatever called it. Threads that share the work of one computation each need
// a scope: for_each_in_parallel and sweeps hand theirs on.
#pragma once

#include <atomic>
#include <utility>

namespace wingbeat {

/// What a computation throws that was asked to stop; its results are gone. Not derived from std::exception, so that no
/// handler of errors takes it for one.
struct Cancelled {};

class Cancellation {
 public:
  Cancellation() = default;
  Cancellation(const Cancellation&) = delete;
  Cancellation& operator=(const Cancellation&) = delete;
  virtual ~Cancellation() = default;

  /// From any thread.
  void request() { requested_.store(true, std::memory_order_relaxed); }
  bool requested() const { return requested_.load(std::memory_order_relaxed); }

  /// By the thread that computes, every microsecond or so. Throws Cancelled.
  void check() {
    look();
    if (requested()) throw Cancelled();
  }

 private:
  /// A place for whoever has no other thread to look for a reason to stop.
  virtual void look() {}

  std::atomic<bool> requested_ = false;
};

namespace detail {
inline constinit thread_local Cancellation* current_cancellation = nullptr;
}

/// That of the calling thread, or null.
inline Cancellation* current_cancellation() { return detail::current_cancellation; }

/// Throws Cancelled where the calling thread's computation has been asked to stop.
inline void check_cancellation() {
  if (Cancellation* const current = detail::current_cancellation) [[unlikely]]
    current->check();
}

/// While it lives, what the calling thread computes stops at the request of `cancellation` (null: at no request).
class CancellationScope {
 public:
  explicit CancellationScope(Cancellation* cancellation)
      : before_(std::exchange(detail::current_cancellation, cancellation)) {}
  CancellationScope(const CancellationScope&) = delete;
  CancellationScope& operator=(const CancellationScope&) = delete;
  ~CancellationScope() { detail::current_cancellation = before_; }

 private:
  Cancellation* before_;
};

}  // namespace wingbeat
