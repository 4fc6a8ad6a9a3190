// Every part lists all of its members, in the order of declaration.
#include "wingbeat/core/members.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/core/jet.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

template <Scalar S>
struct WithoutItsLast {
  S listed = S(0);
  FrictionLaw law = FrictionLaw::none;
  S forgotten = S(0);

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.listed, self.law);
  }
};

template <Scalar S>
struct WithoutItsFirst {
  S forgotten = S(0);
  std::optional<S> listed;
  S last = S(0);

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.listed, self.last);
  }
};

template <Scalar S>
struct WithoutItsChoice {
  S listed = S(0);
  FrictionLaw forgotten = FrictionLaw::none;

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.listed);
  }
};

static_assert(!lists_every_member<WithoutItsLast<double>>);
static_assert(!lists_every_member<WithoutItsFirst<double>>);
static_assert(!lists_every_member<WithoutItsChoice<double>>);

/// Where the members listed stand within a part.
struct Offsets {
  const char* part;
  template <class... M>
  std::vector<std::ptrdiff_t> operator()(const M&... member) const {
    return {reinterpret_cast<const char*>(&member) - part...};
  }
};

template <class Part>
class Members : public testing::Test {};

using Parts =
    testing::Types<Battery<double>, CoefficientWave<double>, ForceCoefficients<double>, BladeElement<double>,
                   Friction<double>, Motor<double>, MotorThermal<double>, MotorThermalDesign<double>, GearMotor<double>,
                   Planform<double>, SliderCrank<double>, HingeSpring<double>, Supply<double>, Vehicle<double>,
                   MotorDesign<double>, TransmissionDesign<double>, FrictionDesign<double>, SpringDesign<double>,
                   WingDesign<double>, PitchDesign<double>, PitchHinge<double>, PitchingWings<double>, Piezo<double>,
                   Electronics<double>, InducedVelocity<double>, WakeStrip<double>, WakeStrips<double>,
                   AerodynamicsDesign<double>, ItemMasses<double>, Design<double>>;
TYPED_TEST_SUITE(Members, Parts);

TYPED_TEST(Members, AreAllListedInTheOrderOfDeclaration) {
  static_assert(lists_every_member<TypeParam>);
  const TypeParam part{};
  const auto offsets = TypeParam::members(part, Offsets{reinterpret_cast<const char*>(&part)});
  for (std::size_t n = 1; n < offsets.size(); ++n) EXPECT_LT(offsets[n - 1], offsets[n]) << "member " << n;
}

/// Numbers of a design or a vehicle in the order of the lists; absent ones are left out.
template <class Part>
std::vector<double> numbers_of(const Part& part) {
  std::vector<double> numbers;
  const auto visit = [&](const auto& x) {
    if constexpr (Scalar<std::remove_cvref_t<decltype(x)>>) {
      numbers.push_back(value_of(x));
    } else if (x) {
      numbers.push_back(value_of(*x));
    }
  };
  for_each_number(part, visit);
  return numbers;
}

/// A design with a different number at every place.
Design<double> numbered_design() {
  Design<double> d = reference_design();
  double next = 1.0;
  for_each_number(d, [&](auto& x) { x = next++; });
  return d;
}

TEST(Members, CastCarriesEveryNumberAndChoice) {
  Design<double> d = numbered_design();
  EXPECT_EQ(numbers_of(d).size(), std::size_t(number_count<Design<double>>));
  d.name = "numbered";
  d.supply.type = SupplyType::battery;
  d.supply.battery.discharge_curve = {{0.0, 3.0}, {1.0, 4.2}};
  d.transmission.formulation = Formulation::virtual_work;
  d.friction.law = FrictionLaw::viscous;
  d.wing.planform.shape = PlanformShape::rectangle;
  d.wing.resonance.reset();
  const auto dual = cast<Jet<2>>(d);
  EXPECT_EQ(numbers_of(dual), numbers_of(d));
  EXPECT_EQ(dual.name, d.name);
  EXPECT_EQ(dual.supply.type, d.supply.type);
  EXPECT_EQ(dual.supply.battery.discharge_curve, d.supply.battery.discharge_curve);
  EXPECT_EQ(dual.transmission.formulation, d.transmission.formulation);
  EXPECT_EQ(dual.friction.law, d.friction.law);
  EXPECT_EQ(dual.wing.planform.shape, d.wing.planform.shape);
  EXPECT_FALSE(dual.wing.resonance);
}

TEST(Members, CastCarriesTheVehicle) {
  Vehicle<double> v = resolve(reference_design());
  double next = 1.0;
  for_each_number(v, [&](double& x) { x = next++; });
  v.transmission.type = TransmissionType::direct;
  v.wings.coefficients.table = std::make_shared<CoefficientTable>(
      std::vector{0.0, 0.5, 1.0}, std::vector{0.0, 1.0, 0.0}, std::vector{0.1, 1.0, 2.0});
  const auto dual = cast<Jet<1>>(v);
  EXPECT_EQ(numbers_of(dual), numbers_of(v));
  EXPECT_EQ(dual.transmission.type, v.transmission.type);
  EXPECT_EQ(dual.wings.coefficients.table, v.wings.coefficients.table);
}

}  // namespace
}  // namespace wingbeat
