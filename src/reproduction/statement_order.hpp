// Statements as figures and tables list them: shorter, and those that are not reproduced first.
#pragma once

#include <string>
#include <vector>

#include "wingbeat/reproduction/claims.hpp"

namespace wingbeat::reproduction {

/// Shorter, for a row below that heading.
std::string short_statement(const Claim& c, const std::string& heading);
/// The checkable statements of a group: those that are not reproduced, then those that depend on the formulation, then
/// the others, each by the larger deviation.
std::vector<const Claim*> worst_first(const Assessment& a, const ClaimGroup& group);

}  // namespace wingbeat::reproduction
