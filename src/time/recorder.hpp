// Samples and the inrush current of a start-up, as its options ask for them.
#pragma once

#include "wingbeat/time/transient.hpp"

namespace wingbeat::detail {

class Recorder {
 public:
  Recorder(const TransientOptions& options, TransientResult& result) : options_(options), result_(result) {}

  void start(double current) {
    result_.inrush_current = current;
    next_ = options_.record_interval;
  }
  void note_current(double t, double i) {
    if (i <= result_.inrush_current) return;
    result_.inrush_current = i;
    result_.inrush_current_time = t;
  }
  void sample(const TransientSample& here) {
    if (options_.record) result_.samples.push_back(here);
  }
  /// At the interval asked for, sample_at(t) being the sample there.
  template <class SampleAt>
  void samples_until(double t, const SampleAt& sample_at) {
    if (!options_.record || options_.record_interval == 0.0) return;
    for (; next_ <= t; next_ += options_.record_interval) result_.samples.push_back(sample_at(next_));
  }
  /// The end of a step, or what lies within it.
  template <class SampleAt>
  void step_taken(const TransientSample& end, const SampleAt& sample_at) {
    if (options_.record_interval == 0.0) sample(end);
    samples_until(end.time, sample_at);
  }

 private:
  const TransientOptions& options_;
  TransientResult& result_;
  double next_ = 0.0;
};

}  // namespace wingbeat::detail
