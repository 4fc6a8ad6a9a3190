// Enumerations and their names.
#include "wingbeat/core/names.hpp"

#include <gtest/gtest.h>

#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {
namespace {

template <class E>
class Names : public testing::Test {};

using Enumerations = testing::Types<SupplyType, FrictionLaw, PlanformShape, Formulation, TransmissionType, Condition>;
TYPED_TEST_SUITE(Names, Enumerations);

TYPED_TEST(Names, EveryValueHasOneInItsOrder) {
  int n = 0;
  for (const auto& [name, value] : names_of<TypeParam>) {
    EXPECT_EQ(value, TypeParam(n++));
    EXPECT_STREQ(name_of(value), name);
    EXPECT_EQ(from_name<TypeParam>(name), value);
  }
  EXPECT_EQ(from_name<TypeParam>("unknown"), std::nullopt);
  EXPECT_EQ(from_name<TypeParam>(""), std::nullopt);
}

TEST(ListedNames, AreInWords) {
  EXPECT_EQ(listed_names<Condition>(), "air, vacuum or wingless");
  EXPECT_EQ(listed_names<Formulation>(), "rod-force or virtual-work");
}

}  // namespace
}  // namespace wingbeat
