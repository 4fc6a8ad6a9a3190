// The 2022 friction paper, assessed once for all tests of its statements.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "wingbeat/reproduction/claims.hpp"
#include "wingbeat/run/parallel.hpp"

namespace wingbeat {

inline const PublishedFile& paper() {
  static const PublishedFile file = read_published(WINGBEAT_DATA "/published/friction2022.toml");
  return file;
}

/// Assessed once, at its first use.
inline const Assessment& assessment() {
  static const Assessment a = assess(paper(), [](std::size_t count, const std::function<void(std::size_t)>& act) {
    for_each_in_parallel(count, act, 0);
  });
  return a;
}

inline const Claim& claim(const std::string& beginning) {
  for (const Claim& c : assessment().claims) {
    if (c.statement.rfind(beginning, 0) == 0) return c;
  }
  ADD_FAILURE() << "no statement begins with: " << beginning;
  static const Claim none{};
  return none;
}

}  // namespace wingbeat
