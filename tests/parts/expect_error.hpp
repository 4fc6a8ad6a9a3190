#pragma once

#include <gtest/gtest.h>

#include <string>

#include "wingbeat/core/status.hpp"

namespace wingbeat {

/// The text of the ParameterError that f() throws; "no error" if it throws none.
template <class F>
std::string error_of(const F& f) {
  try {
    f();
  } catch (const ParameterError& error) {
    EXPECT_EQ(error.what(), error.key() + ": " + error.reason());
    return error.what();
  }
  return "no error";
}

/// The text with which validate() refuses a part after `spoil` has changed it.
template <class Part, class Spoil>
std::string refusal(Part part, const Spoil& spoil) {
  spoil(part);
  return error_of([&] { validate(part); });
}

}  // namespace wingbeat
