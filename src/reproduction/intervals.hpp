// Intervals of computed numbers: what the uncertain parameters of a paper do to them.
#pragma once

#include <span>
#include <vector>

#include "wingbeat/reproduction/claims.hpp"
#include "wingbeat/study/tolerance.hpp"

namespace wingbeat {

/// The tolerance study of a design at its supply's voltage or a held frequency. Studies of the same file and count draw
/// the same values for its parameters, so that differences between designs can be taken sample by sample. A parameter
/// that the design does not have leaves it as it is.
ToleranceStudy published_tolerance(const PublishedFile& file, const Design<double>& design,
                                   std::optional<double> frequency, std::uint64_t count);

/// Where the middle 95 % of the finite values lie; absent where fewer than nine in ten are finite.
Interval middle_95(std::vector<double> values);

/// Adds the intervals of all numbers of the assessment that rest on operating points, and the title question's answers
/// with theirs. `files` are those of the variants.
void add_intervals(Assessment& a, std::span<const PublishedFile> files, const ForEach& for_each);

}  // namespace wingbeat
