// The description of a run, which the explorer's answers hold, too.
#pragma once

#include "report/described.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat::described {

const Description<RunResult>& run_description();

}  // namespace wingbeat::described
