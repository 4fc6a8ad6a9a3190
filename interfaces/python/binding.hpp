// What the files of the Python module share: arrays, choices by name, long calls.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

/// Thrown by a callback where the user has interrupted.
struct Interrupted {};

/// What the thread that computes and the one that listens to Python share.
class Watch {
 public:
  void report(const SweepProgress& progress) {
    if (stop_) throw Interrupted();
    note(progress);
  }
  void note(const SweepProgress& progress) {
    const std::lock_guard<std::mutex> lock(mutex_);
    progress_ = progress;
  }
  SweepProgress progress() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return progress_;
  }
  void stop() { stop_ = true; }
  bool stopped() const { return stop_; }

 private:
  mutable std::mutex mutex_;
  SweepProgress progress_;
  std::atomic<bool> stop_ = false;
};

/// Does `work(watch)` on another thread, without the GIL. Meanwhile signals reach Python, and `progress(done,
/// designs)`, unless it is None, is called now and then. Where a signal handler or `progress` raises, `work` is told to
/// stop, and the exception goes on once it has.
template <class Work>
auto watched(const py::object& progress, const Work& work) {
  using namespace std::chrono_literals;
  Watch watch;
  std::optional<py::error_already_set> raised;
  std::uint64_t told = 0;
  auto found = std::async(std::launch::async, [&] { return work(watch); });
  while (true) {
    {
      const py::gil_scoped_release others;
      if (found.wait_for(50ms) == std::future_status::ready) break;
    }
    if (raised) continue;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      const SweepProgress now = watch.progress();
      if (!progress.is_none() && now.done != told) progress(told = now.done, now.designs);
    } catch (py::error_already_set& error) {
      raised.emplace(error);
      watch.stop();
    }
  }
  if (raised) {
    try {
      found.get();
    } catch (const Interrupted&) {}
    throw py::error_already_set(*raised);
  }
  return found.get();
}

/// Side by side on at most so many threads (0: one for each core), until the user has interrupted.
inline ForEach until_stopped(const Watch& watch, int threads) {
  return [&watch, threads](std::size_t count, const std::function<void(std::size_t)>& act) {
    const auto unless_stopped = [&](std::size_t n) {
      if (watch.stopped()) throw Interrupted();
      act(n);
    };
    for_each_in_parallel(count, unless_stopped, threads);
  };
}

/// What a study found, as `--json` and as the program's readable report.
inline py::dict told(const std::string& json, const std::string& text) {
  py::dict result;
  result["json"] = json;
  result["text"] = text;
  return result;
}

/// The columns of these rows, in the order of waveform_columns().
py::list columns_of(const std::vector<WaveformRow>& rows);

/// Adds equations of motion and simulations to the module.
void add_motion(py::module_& m);

/// Adds motor curves, force coefficients and kinematics.
void add_parts(py::module_& m);

/// Adds arrays of designs, sweeps and the studies that files describe to the module.
void add_studies(py::module_& m);

/// Adds optima, fronts, and optima by functions of the user's own.
void add_optima(py::module_& m);

}  // namespace wingbeat::python
