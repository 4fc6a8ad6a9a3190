// Intervals of numbers that are searched for: optima, crossings, ranges, calibrated coefficients.
#pragma once

#include <functional>
#include <vector>

#include "reproduction/statement_answers.hpp"
#include "wingbeat/reproduction/claims.hpp"

namespace wingbeat {

/// Numbers that a search finds for the designs of a file; absent where it finds none.
using SearchedNumbers = std::function<std::vector<double>(const PublishedFile&)>;

/// 95 % intervals about `centre` by propagation of the file's uncertain parameters: the search is solved anew with each
/// of them one standard deviation to either side, all others kept, and half of the difference is its contribution;
/// contributions add in squares. Absent where any of these searches finds nothing.
std::vector<Interval> propagated(const PublishedFile& file, const std::vector<double>& centre,
                                 const SearchedNumbers& numbers);

/// The interval of a statement's number: of a searched one, the condition of its place (equal values to either side of
/// a peak, a ratio of 1, equal values at both ends of a range) is solved anew. Absent where the place is an end of the
/// window or an edge of the domain; but the highest value at an end of the window has one, at that end.
Interval searched_interval(const PublishedFile& file, const PublishedTrend& statement, const Answer& answer,
                           SolvedPoints& points);

}  // namespace wingbeat
