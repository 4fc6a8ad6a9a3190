// What becomes of a design of a study.
#pragma once

#include <cstdint>

#include "wingbeat/core/status.hpp"

namespace wingbeat {

/// What became of a design of a sweep: FlappingStatus, and two cases more. The numbers are those of data sets.
enum class SweepStatus : std::int8_t {
  flapping,
  stalled,
  locked,
  jammed,
  unreached,  ///< it flaps, but not at the frequency asked for
  invalid,    ///< a parameter out of its physical range, for itself or beside the others
  undecided   ///< start-up showed none of these within the solvers' limits
};
inline constexpr int sweep_status_count = 7;
const char* name_of(SweepStatus status);
SweepStatus sweep_status(FlappingStatus status);

}  // namespace wingbeat
