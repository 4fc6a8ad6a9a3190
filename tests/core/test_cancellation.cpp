// Requests to stop, and whom they reach.
#include <gtest/gtest.h>

#include <thread>

#include "wingbeat/core/cancellation.hpp"

namespace wingbeat {
namespace {

TEST(Cancellation, ReachesTheThreadsThatHaveItsScope) {
  Cancellation cancellation;
  EXPECT_NO_THROW(check_cancellation());
  {
    const CancellationScope scope(&cancellation);
    EXPECT_NO_THROW(check_cancellation());
    std::thread([&] {
      cancellation.request();
      EXPECT_NO_THROW(check_cancellation());
    }).join();
    EXPECT_THROW(check_cancellation(), Cancelled);
    {
      Cancellation another;
      const CancellationScope within(&another);
      EXPECT_NO_THROW(check_cancellation());
    }
    EXPECT_THROW(check_cancellation(), Cancelled);
    const CancellationScope none(nullptr);
    EXPECT_NO_THROW(check_cancellation());
  }
  EXPECT_NO_THROW(check_cancellation());
}

TEST(Cancellation, MayLookForAReasonItself) {
  class Third : public Cancellation {
    void look() override {
      if (++looks_ == 3) request();
    }
    int looks_ = 0;
  };
  Third third;
  const CancellationScope scope(&third);
  EXPECT_NO_THROW(check_cancellation());
  EXPECT_NO_THROW(check_cancellation());
  EXPECT_THROW(check_cancellation(), Cancelled);
}

}  // namespace
}  // namespace wingbeat
