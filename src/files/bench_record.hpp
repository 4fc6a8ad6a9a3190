// Records of signals in time: cut into bursts, each becomes a mean cycle.
#pragma once

#include "wingbeat/files/bench_file.hpp"

namespace wingbeat::detail {

/// The mean cycles of a record, whose rows have their time in `crank_angle`: a waveform log in time, with the frequency
/// of each burst in its first row where the voltage was set. A column of the voltage says which voltage that was unless
/// the request does. Throws InputError with the line where a burst starts.
BenchLog mean_cycles(const BenchLog& record, const LogRequest& request, LogNotes& notes);

}  // namespace wingbeat::detail
