// What the files of the Python module share: arrays, choices by name, long calls.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "report/report_tools.hpp"
#include "wingbeat/core/cancellation.hpp"
#include "wingbeat/core/names.hpp"
#include "wingbeat/files/file_record.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/run/parallel.hpp"
#include "wingbeat/run/sweep_run.hpp"
#include "wingbeat/study/for_each.hpp"
#include "wingbeat/wingbeat.hpp"

namespace wingbeat::python {

namespace py = pybind11;

/// The numbers as an array that owns them.
template <class T>
py::array_t<T> array_of(std::vector<T>&& numbers) {
  auto* kept = new std::vector<T>(std::move(numbers));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array_t<T>(py::ssize_t(kept->size()), kept->data(), owner);
}

template <std::size_t N>
py::array_t<double> array_of(const std::array<double, N>& numbers) {
  return py::array_t<double>(py::ssize_t(N), numbers.data());
}

/// A process of Python runs many commands: what an earlier one read or wrote does not bind a later one.
inline void forget_files() { FileRecord::of_this_program().clear(); }

template <NamedEnum E>
E choice(const char* name, const std::string& text) {
  if (const auto value = from_name<E>(text)) return *value;
  throw InputError("", 0, 0, name, "must be " + std::string(listed_names<E>()) + ", got " + in_quotes(text));
}

// ---- with and without the GIL

/// Does what makes the calling thread enter Python. Where Python is being shut down, the thread stops there for good,
/// as Python 3.14 does itself: earlier ones unwind the thread's stack, which destructors do not survive.
template <class Enter>
void entering(const Enter& enter) noexcept {
  const auto for_ever = [] {
    while (true) std::this_thread::sleep_for(std::chrono::hours(1));
  };
#if PY_VERSION_HEX >= 0x030D0000
  if (Py_IsFinalizing()) for_ever();
#else
  if (_Py_IsFinalizing()) for_ever();
#endif
  try {
    enter();
  } catch (...) {
    for_ever();
  }
}

/// With the GIL, on a thread that may be without it.
class Entered {
 public:
  Entered() {
    entering([this] { own_.emplace(); });
  }

 private:
  std::optional<py::gil_scoped_acquire> own_;
};

/// Without the GIL, so that other threads of Python run.
class Left {
 public:
  Left() : state_(PyEval_SaveThread()) {}
  Left(const Left&) = delete;
  Left& operator=(const Left&) = delete;
  ~Left() {
    entering([this] { PyEval_RestoreThread(state_); });
  }

 private:
  PyThreadState* state_;
};

// ---- computations

/// A computation that Python waits for: where one of its signal handlers raises, as that of Ctrl-C does, or the user's
/// progress function, the computation is asked to stop, and the exception goes on once it has.
class Watch : public Cancellation {
 public:
  static constexpr std::chrono::milliseconds interval{50};  ///< between two looks at signals

  explicit Watch(py::object progress = py::none()) : progress_(std::move(progress)) {}

  /// From any thread.
  void report(const SweepProgress& progress) {
    const std::lock_guard<std::mutex> lock(mutex_);
    reported_ = progress;
  }

  /// Lets signal handlers run, and calls `progress(done, designs)`, unless it is None, where that has changed. With the
  /// GIL, on the thread that called.
  void listen() {
    if (raised_) return;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      const SweepProgress now = progress();
      if (!progress_.is_none() && now.done != shown_) progress_(shown_ = now.done, now.designs);
    } catch (py::error_already_set& error) {
      raised_.emplace(error);
      request();
    }
  }

  /// Throws what was raised, if anything was. With the GIL.
  void raise_again() const {
    if (raised_) throw py::error_already_set(*raised_);
  }

 private:
  SweepProgress progress() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return reported_;
  }

  const py::object progress_;
  mutable std::mutex mutex_;
  SweepProgress reported_;
  std::uint64_t shown_ = 0;
  std::optional<py::error_already_set> raised_;
};

/// Of a computation on the thread that called: it listens itself, now and then.
class WatchWithin : public Watch {
 private:
  void look() override {
    // The clock is not asked at each of the solver's steps.
    if (++looks_ % 64 != 0) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - listened_ < interval) return;
    const Entered own;
    listen();
    listened_ = std::chrono::steady_clock::now();
  }

  unsigned looks_ = 0;
  std::chrono::steady_clock::time_point listened_ = std::chrono::steady_clock::now();
};

/// Does `work()` on the calling thread, without the GIL; signals reach Python meanwhile. For work on one thread,
/// however short.
template <class Work>
auto listening(const Work& work) {
  WatchWithin watch;
  try {
    const CancellationScope scope(&watch);
    const Left others;
    return work();
  } catch (...) {
    watch.raise_again();
    throw;
  }
}

/// Does `work(watch)` on another thread, without the GIL, while the calling one listens. For work on several threads:
/// the calling one may have to wait for the others.
template <class Work>
auto watched(const py::object& progress, const Work& work) {
  Watch watch(progress);
  auto found = std::async(std::launch::async, [&] {
    const CancellationScope scope(&watch);
    return work(watch);
  });
  while (true) {
    {
      const Left others;
      if (found.wait_for(Watch::interval) == std::future_status::ready) break;
    }
    watch.listen();
  }
  try {
    auto result = found.get();
    watch.raise_again();
    return result;
  } catch (...) {
    watch.raise_again();
    throw;
  }
}

/// Side by side on at most so many threads (0: one for each core).
inline ForEach side_by_side(int threads) {
  return [threads](std::size_t count, const std::function<void(std::size_t)>& act) {
    for_each_in_parallel(count, act, threads);
  };
}

/// A tree of a result as dicts, lists, texts and numbers.
py::object object_of(const detail::Json& tree);

/// What a study found: the values of `--json`, and the program's readable report.
inline py::dict reported(const detail::Json& values, const std::string& text) {
  py::dict result;
  result["values"] = object_of(values);
  result["text"] = text;
  return result;
}

/// Status, evidence, domain, warnings and metrics of a run.
py::dict outcome_of(const RunResult& found);

/// The columns of these rows, in the order of waveform_columns().
py::list columns_of(const std::vector<WaveformRow>& rows);

/// Adds equations of motion and simulations to the module.
void add_motion(py::module_& m);

/// Adds flights that are stepped, trim and stability.
void add_flight(py::module_& m);

/// Adds motor curves, force coefficients and kinematics.
void add_parts(py::module_& m);

/// Adds arrays of designs, sweeps and the studies that files describe to the module.
void add_studies(py::module_& m);

/// Adds optima, fronts, and optima by functions of the user's own.
void add_optima(py::module_& m);

}  // namespace wingbeat::python
