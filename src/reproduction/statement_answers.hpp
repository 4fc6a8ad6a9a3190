// What the model answers to one statement of a paper.
#pragma once

#include <string>

#include "wingbeat/files/published.hpp"

namespace wingbeat {

struct Answer {
  double value = absent;  ///< in the statement's unit
  std::string text;       ///< for reading
  bool holds = false;     ///< of a statement without a number
  bool outside = false;   ///< of the domain, by the residual of the formulation alone
};

/// `file` holds the designs in the formulation, and with the chord moments, to be asked for.
Answer answer_to(const PublishedFile& file, const PublishedTrend& statement);

}  // namespace wingbeat
