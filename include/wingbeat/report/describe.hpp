// What studies found, in words: a sentence without a full stop for each.
#pragma once

#include <string>

namespace wingbeat {

struct DesignPoint;
struct EnduranceResult;
struct Hold;
struct RunResult;
struct SearchFinding;
struct UnreachedRow;

/// What the search found, or which frequencies or lifts can be reached: "60 Hz cannot be reached inside the domain of
/// validity: at ...".
std::string describe(const SearchFinding& finding);
/// What a study holds: "flapping held at 22 Hz".
std::string describe(const Hold& hold);

/// What shows the status, or why the frequency or the lift asked for cannot be reached.
std::string describe(const RunResult& result);

/// What the design does, or why it is invalid.
std::string describe(const DesignPoint& point);

/// Why the model does not reach the row.
std::string describe(const UnreachedRow& row);

/// How the flight ends, or why it does not start.
std::string describe(const EnduranceResult& result);

}  // namespace wingbeat
