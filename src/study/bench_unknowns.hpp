// Numbers of the bench that are fitted beside the vehicle's parameters: of a balance, phases and zeros of logs.
#pragma once

#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat {

/// The fit with a free phase for each burst of a log in time whose phase is not known, and a free zero for each column
/// that a log states one of.
BenchFit with_bench_unknowns(BenchFit fit);

/// Range within which a direction of the fit counts as known: phases and zeros have no size of their own [SI].
double unknown_scale(const FreeParameter& parameter);

/// Throws ParameterError for unknowns, balances and waveforms that cannot be fitted.
void check_bench(const BenchFit& fit);

}  // namespace wingbeat
