// A solution whose energy balance stays open is none.
#include "wingbeat/cycle/energy_audit.hpp"

#include <gtest/gtest.h>

#include "vehicle/pitching_vehicle.hpp"
#include "wingbeat/cycle/cycle_system.hpp"
#include "wingbeat/cycle/orbit_search.hpp"

namespace wingbeat {
namespace {

/// A direct drive whose input is integrated `leak` times as large as it is.
template <Scalar S>
struct LeakyDirect : DirectSystem<S, 3> {
  using Base = DirectSystem<S, 3>;
  double leak = 1.0;

  LeakyDirect(const Base& base, double by) : Base(base), leak(by) {}
  template <Scalar T>
  LeakyDirect<T> cast() const {
    return {Base::template cast<T>(), leak};
  }
  template <bool quadratures>
  solver::Rates<LeakyDirect> rates(const S& phi, const typename Base::State& y,
                                   const typename Base::Signs& signs) const {
    const auto exact = Base::template rates<quadratures>(phi, y, signs);
    solver::Rates<LeakyDirect> r;
    r.dy = exact.dy;
    r.switches = exact.switches;
    if constexpr (quadratures) {
      r.dq = exact.dq;
      r.dq[std::size_t(Integral::electrical_work)] = S(leak) * r.dq[std::size_t(Integral::electrical_work)];
    }
    return r;
  }
};

TEST(EnergyAudit, OrbitsThatLeaveItOpenAreRefused) {
  Vehicle<double> v = pitching_vehicle(1e-3);
  v.pitch = {};
  const DirectSystem<double, 3> system(v, {0.5, 60.0, 0.1});
  for (const double leak : {1.0, 1.0 + 3e-6, 1.0 + 3e-5, 1.001}) {
    const SteadyOptions options{.tolerance = 1e-6};
    solver::WorkBudget work;
    detail::OrbitSearch<LeakyDirect<double>> orbit({system, leak}, options, work);
    const bool within = leak < 1.0 + 1e-5;
    EXPECT_EQ(orbit.search({}), within) << leak;
    EXPECT_EQ(orbit.summary().status, within ? solver::PeriodicStatus::converged : solver::PeriodicStatus::unbalanced);
    if (within) continue;
    EXPECT_NEAR(orbit.imbalance(), leak - 1.0, 0.01 * (leak - 1.0));
  }
}

TEST(EnergyAudit, CountsAsClosedUpToTenTimesTheTolerance) {
  EnergyAudit a{1.0, 0.4, 0.1, 0.0, 0.1, 0.1, 0.1, 0.2 - 1e-6, 0.0, 1e-6};
  EXPECT_TRUE(closes(a, 1e-6));
  EXPECT_TRUE(closes(a, 1.01e-7));
  EXPECT_FALSE(closes(a, 0.99e-7));
  EXPECT_TRUE(closes(a, 1e-9, 1e-6));  // the vehicle stores the rest
  const EnergyAudit idle{1e-13, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-13};
  EXPECT_FALSE(closes(idle, 1e-6));
  EXPECT_TRUE(closes(idle, 1e-6, 0.0, 1e-2));  // ten times the rounding of what the blocked motor takes
  EXPECT_FALSE(closes(idle, 1e-6, 0.0, 1e-4));
  a.imbalance = absent;
  EXPECT_FALSE(closes(a, 1.0));
}

}  // namespace
}  // namespace wingbeat
