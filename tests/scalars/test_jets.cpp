// Dual numbers against central differences, and at the places where a careless formula has no derivative.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "scalars/kernel.hpp"
#include "scalars/vehicle_parameters.hpp"
#include "vehicle/random_vehicle.hpp"
#include "wingbeat/core/jet.hpp"
#include "wingbeat/solve/implicit_step.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

/// A vehicle with no parameter at zero: all friction laws at once, springs, an odd mid-stroke height.
Vehicle<double> generic_vehicle(Formulation formulation) {
  Vehicle<double> v = resolve(reference_design());
  v.motor.friction_torque = 2e-4;
  v.motor.gear_efficiency = 0.85;
  v.transmission.slider_crank.mid_stroke_height = 20.7e-3;
  v.transmission.slider_crank.formulation = formulation;
  v.transmission.four_bar = {5e-3, 20e-3, 8e-3, 20.5e-3, 1.6, 1.8};
  v.transmission.tabulated.reference_radius = 7e-3;
  v.friction = {1.5e-3, 3e-6, 2e-8, 1e-4};
  v.spring.stiffness = 1.1e-3;
  v.spring.rest_angle = 0.1;
  v.source_resistance = 1.7;
  v.wings.angle_of_attack_min = 0.2;
  v.wings.added_inertia = 4e-8;
  v.wings.coefficients.tangential = 1e-6;  // differences meet the kink of its curvature at 45 degrees
  v.wings.tip = {1e-7, 8e-9, 2e-9, 0.4};
  v.wings.clap = {0.3, 0.5, 0.2, 0.9};
  v.wings.wake = {1.3, 0.7, 9e-3, 0.02, {}};
  for (std::size_t k = 0; k < wake_strip_count; ++k) {
    v.wings.wake.strips.at[k] = {5e-3 + 3.5e-3 * double(k), 1.5e-4 + 4e-6 * double(k), 2e-2 - 5e-4 * double(k)};
  }
  v.thermal = {20.0, 48.0, 303.0, 298.0, 3.9e-3, -1e-3, 358.0};
  v.drive_frequency = 22.0;
  v.load_torque = 2e-5;
  v.pitch.hinge = {3e-4, 2e-8, -0.8, 0.7, 1e-6};
  v.pitch.axis = 0.1;
  v.pitch.torsion = {2e-4, 1e-8, 0.063, 0.025, 0.004, 2.0, {}};
  v.voltage_offset = 0.3;
  v.electronics = {0.9, 20.0, true};
  v.piezo = {4e-4, 1e-3, 240.0, 0.02, 6e-6, 1e-8, 0.02, 0.4, 2666.0, 1e9, 1e3};
  v.pitch.pitch_inertia = 6e-9;
  v.pitch.mass_product = 1e-8;
  v.pitch.moments = {1.2e-6, 4.2e-8, 1.2e-6, 2.5e-8, 2.6e-8};
  v.pitch.air = {4e-8, 1.2e-8, 7e-9, 1.2e-6, 6e-7};
  v.pitch.edge_suction = 0.3;
  v.wing_limits = {82.0, 100.0, 26000.0, 1.6};
  return v;
}

std::shared_ptr<const CoefficientTable> generic_table() {
  std::vector<double> alpha, lift, drag;
  for (int n = 0; n <= 12; ++n) {
    alpha.push_back(0.15 * n - 0.1);
    lift.push_back(std::sin(2.0 * alpha.back()) + 0.1 * n);
    drag.push_back(2.0 - std::cos(2.1 * alpha.back()));
  }
  return std::make_shared<CoefficientTable>(alpha, lift, drag);
}

constexpr int state_count = 3;  // crank angle, crank speed, current
constexpr int variable_count = parameter_count + state_count;

template <Scalar S>
struct Inputs {
  Vehicle<S> vehicle;
  S theta, omega, current;

  S& variable(int n) {
    if (n < parameter_count) return *parameters(vehicle)[std::size_t(n)];
    return n == parameter_count ? theta : n == parameter_count + 1 ? omega : current;
  }
};

/// Checks the dual numbers of f, a function of Inputs of any scalar, against differences in every variable.
/// `residual` and `motor_work` say where those stand among its outputs.
template <class F>
void expect_derivatives(const F& f, const Inputs<double>& inputs, double tolerance, std::size_t residual,
                        std::size_t motor_work) {
  using J = Jet<variable_count>;
  Inputs<J> dual{cast<J>(inputs.vehicle), J(inputs.theta), J(inputs.omega), J(inputs.current)};
  for (int n = 0; n < variable_count; ++n) dual.variable(n).v[n] = 1.0;
  const auto jets = f(dual);
  const auto values = f(inputs);
  for (std::size_t out = 0; out < values.size(); ++out) {
    if (std::isnan(values[out])) continue;  // a metric that no cycle has
    const double beside = out == residual ? values[motor_work] : 0.0;
    EXPECT_NEAR(jets[out].a, values[out], 1e-13 * (std::abs(values[out]) + std::abs(beside))) << "output " << out;
  }
  for (int n = 0; n < variable_count; ++n) {
    const double value = Inputs<double>(inputs).variable(n);
    ASSERT_NE(value, 0.0) << "variable " << n << " is not generic";
    const double h = 2e-4 * std::abs(value);
    const auto moved = [&](double by) {
      Inputs<double> there = inputs;
      there.variable(n) += by;
      return f(there);
    };
    const auto p1 = moved(h), m1 = moved(-h), p2 = moved(2.0 * h), m2 = moved(-2.0 * h);
    for (std::size_t out = 0; out < values.size(); ++out) {
      if (std::isnan(values[out])) {
        EXPECT_TRUE(std::isnan(jets[out].a)) << "output " << out;
        continue;
      }
      const double difference = (8.0 * (p1[out] - m1[out]) - (p2[out] - m2[out])) / (12.0 * h);
      const double derivative = jets[out].v[n];
      double size = std::abs(derivative) + std::abs(values[out] / value);
      // What must vanish up to rounding is assessed beside what it is the difference of.
      if (out == residual) size += std::abs(values[motor_work] / value) + std::abs(jets[motor_work].v[n]);
      EXPECT_NEAR(derivative, difference, tolerance * size) << "output " << out << " by variable " << n;
    }
  }
}

/// Outputs of instant() at the inputs, under the vehicle's voltage, on the force branch `force`.
struct InstantOf {
  double force;
  template <Scalar S>
  std::array<S, instant_size> operator()(const Inputs<S>& in) const {
    using std::cos;
    using std::sin;
    return instant<S>(in.vehicle, {sin(in.theta), cos(in.theta), in.omega, in.current,
                                   terminal_voltage(in.vehicle, in.vehicle.voltage, in.current), S(force), S(1.0)});
  }
};

TEST(Jets, InstantAgreesWithDifferencesInEveryParameter) {
  for (const Formulation formulation : {Formulation::rod_force, Formulation::virtual_work}) {
    for (const double theta : {0.3, 1.1, 2.6, 4.0, 5.9}) {
      const Inputs<double> inputs{generic_vehicle(formulation), theta, 140.0, 0.13};
      for (const double force : {1.0, -1.0})
        expect_derivatives(InstantOf{force}, inputs, 1e-8, residual_at, motor_work_at);
    }
  }
}

TEST(Jets, OtherTransmissionsAgreeWithDifferences) {
  std::vector<std::pair<double, double>> rows;
  for (int n = 0; n < 40; ++n) rows.emplace_back(0.05 + 0.157 * n, 0.6 * std::sin(0.157 * n));
  for (const TransmissionType type : {TransmissionType::four_bar, TransmissionType::tabulated}) {
    for (const double theta : {0.3, 2.6, 4.0}) {
      Inputs<double> inputs{generic_vehicle(Formulation::virtual_work), theta, 140.0, 0.13};
      inputs.vehicle.transmission.type = type;
      inputs.vehicle.transmission.tabulated.curve = std::make_shared<const StrokeCurve>(rows);
      for (const double force : {1.0, -1.0})
        expect_derivatives(InstantOf{force}, inputs, 1e-7, residual_at, motor_work_at);
    }
  }
}

TEST(Jets, BackwardRotationAgreesWithDifferences) {
  const Inputs<double> inputs{generic_vehicle(Formulation::rod_force), 0.8, -90.0, -0.2};
  for (const double force : {1.0, -1.0}) expect_derivatives(InstantOf{force}, inputs, 1e-8, residual_at, motor_work_at);
}

TEST(Jets, TabulatedCoefficientsAgreeWithDifferences) {
  Inputs<double> inputs{generic_vehicle(Formulation::rod_force), 0.3, 140.0, 0.13};
  inputs.vehicle.wings.coefficients.table = generic_table();
  expect_derivatives(InstantOf{1.0}, inputs, 1e-7, residual_at, motor_work_at);
}

/// The vehicle without derivatives.
template <Scalar S>
Vehicle<double> plain(const Vehicle<S>& vehicle) {
  Vehicle<double> values = generic_vehicle(vehicle.transmission.slider_crank.formulation);
  std::vector<double> numbers;
  for_each_number(vehicle, [&](const S& x) { numbers.push_back(x.a); });
  std::size_t n = 0;
  for_each_number(values, [&](double& x) { x = numbers[n++]; });
  return values;
}

/// One step from a given angle on a fixed branch.
struct StepOf {
  bool implicit = false;
  template <Scalar S>
  std::array<S, step_size> operator()(const Inputs<S>& in) const {
    const std::array<S, 2> state = {in.omega, in.current};
    typename CrankSystem<S, 2>::Signs signs;
    signs.fill(S(1.0));
    if (!implicit) return crank_step<S>(in.vehicle, in.theta, state, S(0.3), signs);
    const CrankSystem<S, 2> system{in.vehicle, {in.omega, S(1.0)}};
    solver::StepResult<CrankSystem<S, 2>> result;
    if constexpr (std::is_same_v<S, double>) {
      const auto first = system.template rates<true>(in.theta, state, signs);
      result = solver::implicit_step<true>(system, in.theta, state, 0.3, signs, first);
    } else {
      const CrankSystem<double, 2> values{plain(in.vehicle), {1.0, 1.0}};
      result = solver::implicit_step<true>(system, values, in.theta, state, S(0.3), signs);
    }
    EXPECT_TRUE(result.admissible);
    std::array<S, step_size> out;
    out[0] = result.y[0];
    out[1] = result.y[1];
    for (std::size_t n = 0; n < result.dq.size(); ++n) out[2 + n] = result.dq[n];
    return out;
  }
};

TEST(Jets, ExplicitStepAgreesWithDifferencesInEveryParameter) {
  for (const Formulation formulation : {Formulation::rod_force, Formulation::virtual_work}) {
    expect_derivatives(StepOf{false}, {generic_vehicle(formulation), 0.2, 140.0, 0.13}, 1e-8,
                       2 + std::size_t(Integral::residual_work), 2 + std::size_t(Integral::motor_work));
  }
}

TEST(Jets, ImplicitStepAgreesWithDifferencesInEveryParameter) {
  for (const Formulation formulation : {Formulation::rod_force, Formulation::virtual_work}) {
    expect_derivatives(StepOf{true}, {generic_vehicle(formulation), 0.2, 140.0, 0.13}, 1e-8,
                       2 + std::size_t(Integral::residual_work), 2 + std::size_t(Integral::motor_work));
  }
}

/// The metrics of a cycle as if the integrands of one instant held all the time.
struct MetricsOf {
  template <Scalar S>
  std::array<S, metric_count> operator()(const Inputs<S>& in) const {
    const auto numbers = InstantOf{1.0}(in);
    CycleIntegrals<S> integrals;
    CycleExtremes<S> extremes;
    for (std::size_t n = 0; n < integrals.size(); ++n) integrals[n] = S(0.05) * numbers[motion_size + n];
    for (std::size_t n = 0; n < extremes.size(); ++n) extremes[n] = numbers[motion_size + integrals.size() + n];
    Metrics<S> m = cycle_metrics(in.vehicle, integrals, extremes, S(0.01), ReportingOf<S>{S(3.34e-3), S(7.664e-3)});
    // Those of wings that pitch come from the cycle itself.
    for (const Metric which : {Metric::power_hinge, Metric::pitch_amplitude, Metric::pitch_phase,
                               Metric::angle_of_attack_max, Metric::lift_added_mass_share}) {
      m[which] = S(1.0);
    }
    return m.values;
  }
};

TEST(Jets, MetricsAgreeWithDifferencesInEveryParameter) {
  expect_derivatives(MetricsOf{}, {generic_vehicle(Formulation::rod_force), 0.3, 140.0, 0.13}, 1e-8,
                     std::size_t(Metric::power_residual), std::size_t(Metric::power_motor));
}

template <class Outputs>
void expect_finite(const Outputs& jets) {
  for (std::size_t out = 0; out < jets.size(); ++out) {
    EXPECT_TRUE(std::isfinite(jets[out].a)) << "output " << out;
    for (int n = 0; n < variable_count; ++n) {
      EXPECT_TRUE(std::isfinite(jets[out].v[n])) << "output " << out << " by variable " << n;
    }
  }
}

Inputs<Jet<variable_count>> dual_inputs(const Inputs<double>& inputs) {
  using J = Jet<variable_count>;
  Inputs<J> dual{cast<J>(inputs.vehicle), J(inputs.theta), J(inputs.omega), J(inputs.current)};
  for (int n = 0; n < variable_count; ++n) dual.variable(n).v[n] = 1.0;
  return dual;
}

TEST(Jets, DerivativesAreFiniteAndContinuousAtTheDeadCentres) {
  for (const Formulation formulation : {Formulation::rod_force, Formulation::virtual_work}) {
    for (const double sine : {1.0, -1.0}) {
      const Vehicle<double> v = generic_vehicle(formulation);
      using J = Jet<variable_count>;
      // Exactly at the dead centre: the cosine is zero and carries the derivative by the angle.
      auto dual = dual_inputs({v, 0.0, 140.0, 0.13});
      J sin_theta(sine), cos_theta(0.0);
      cos_theta.v[parameter_count] = -sine;
      for (const double force : {1.0, -1.0}) {
        const J v_t = terminal_voltage(dual.vehicle, dual.vehicle.voltage, dual.current);
        const auto numbers_at =
            instant<J>(dual.vehicle, {sin_theta, cos_theta, dual.omega, dual.current, v_t, J(force), J(1.0)});
        expect_finite(numbers_at);
        for (const double aside : {-1e-9, 1e-9}) {
          const auto near = InstantOf{force}(dual_inputs({v, std::asin(sine) + aside, 140.0, 0.13}));
          // Integrals with an absolute value have a kink here: all but those and the extremes must agree.
          for (std::size_t out = 0; out < motion_size; ++out) {
            for (int n = 0; n < variable_count; ++n) {
              const double size = std::abs(numbers_at[out].v[n]) + std::abs(numbers_at[out].a / dual.variable(n).a) +
                                  std::abs(numbers_at[out].v[parameter_count]);
              if (n == parameter_count) continue;
              EXPECT_NEAR(near[out].v[n], numbers_at[out].v[n], 1e-5 * size + 1e-12) << "output " << out << " by " << n;
            }
          }
        }
      }
    }
  }
}

TEST(Jets, DerivativesAreFiniteAtRestAndWithoutForce) {
  for (const Formulation formulation : {Formulation::rod_force, Formulation::virtual_work}) {
    for (const double theta : {0.7, 0.5 * pi, 3.0, 1.5 * pi}) {
      for (const double force : {1.0, -1.0}) {
        expect_finite(InstantOf{force}(dual_inputs({generic_vehicle(formulation), theta, 0.0, 0.0})));
      }
    }
    // No force: no wings, no springs.
    Inputs<double> wingless{resolve(reference_design(), Condition::wingless), 0.7, 150.0, 0.1};
    for (const double force : {1.0, -1.0}) expect_finite(InstantOf{force}(dual_inputs(wingless)));
    expect_finite(StepOf{false}(dual_inputs(wingless)));
    expect_finite(StepOf{true}(dual_inputs(wingless)));
  }
}

TEST(Jets, AccelerationIsContinuousAcrossZeroForce) {
  Inputs<double> inputs{generic_vehicle(Formulation::rod_force), 2.3, 140.0, 0.0};
  const auto switch_at = [&](double current) {
    inputs.current = current;
    return InstantOf{1.0}(inputs)[9];
  };
  const double s0 = switch_at(0.0), s1 = switch_at(1.0);
  inputs.current = -s0 / (s1 - s0);
  const auto up = InstantOf{1.0}(dual_inputs(inputs)), down = InstantOf{-1.0}(dual_inputs(inputs));
  expect_finite(up);
  expect_finite(down);
  EXPECT_NEAR(up[6].a, down[6].a, 1e-10 * std::abs(up[6].a));
  // The derivatives jump with the branch: that is the kink of |F|, not an error.
  EXPECT_GT(std::abs(up[6].v[parameter_count] - down[6].v[parameter_count]), 1e-3);
}

TEST(Jets, StiffnessZeroStillHasItsDerivative) {
  Inputs<double> inputs{generic_vehicle(Formulation::virtual_work), 0.9, 140.0, 0.13};
  inputs.vehicle.spring.stiffness = 0.0;
  const auto numbers = parameters(inputs.vehicle);
  const auto stiffness = std::find(numbers.begin(), numbers.end(), &inputs.vehicle.spring.stiffness) - numbers.begin();
  const double derivative = InstantOf{1.0}(dual_inputs(inputs))[6].v[stiffness];
  const double h = 1e-4;
  Inputs<double> more = inputs, less = inputs;
  more.vehicle.spring.stiffness = h;
  less.vehicle.spring.stiffness = -h;
  // Negative stiffness is no vehicle, but the same formula: F and omega' are linear in it.
  const double one_sided = (InstantOf{1.0}(more)[6] - InstantOf{1.0}(inputs)[6]) / h;
  EXPECT_NEAR(derivative, one_sided, 1e-8 * std::abs(derivative));
  EXPECT_NE(derivative, 0.0);
}

TEST(Jets, TableIsDifferentiableAtItsPointsAndFlatBeyondThem) {
  using J = Jet<1>;
  ForceCoefficients<J> c = cast<J>(translational_2022());
  c.table = generic_table();
  for (const double alpha : c.table->alpha()) {
    EXPECT_TRUE(std::isfinite(lift_coefficient(c, J(alpha, 0)).v[0]));
    EXPECT_TRUE(std::isfinite(drag_coefficient(c, J(alpha, 0)).v[0]));
  }
  EXPECT_EQ(lift_coefficient(c, J(-0.2, 0)).v[0], 0.0);
  EXPECT_EQ(drag_coefficient(c, J(2.0, 0)).v[0], 0.0);
}

/// All operators of two numbers and of one, each used with either operand in either place.
template <class J>
std::vector<J> combined(const J& x, const J& y) {
  using T = decltype(x.a);
  const T s(1.7);
  return {x + y, x - y, -x, x * y, x / y, x * s, s * x, x / s, s / x, (x + s) * (s - y) / (x * y - s)};
}

/// The numbers 1, 2, ... of partials, scattered over magnitudes and signs.
template <int N>
void expect_those_of_ceres() {
  using Wide = ceres::Jet<long double, N>;  // the operators of Ceres
  std::mt19937_64 random(N);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 100; ++n) {
    Jet<N> x, y;
    for (Jet<N>* const jet : {&x, &y}) {
      jet->a = normal(random);
      for (int k = 0; k < N; ++k) jet->v[k] = std::exp(3.0 * normal(random)) * normal(random);
    }
    const auto wide = [](const Jet<N>& jet) { return Wide(jet.a, jet.v.template cast<long double>()); };
    const std::vector<Jet<N>> ours = combined(x, y);
    const std::vector<Wide> theirs = combined(wide(x), wide(y));
    for (std::size_t k = 0; k < ours.size(); ++k) {
      const double size = double(theirs[k].v.cwiseAbs().maxCoeff()) * (1.0 + std::abs(1.0 / y.a));
      EXPECT_NEAR(ours[k].a, double(theirs[k].a), 1e-13 * (1.0 + std::abs(double(theirs[k].a)))) << N << ", " << k;
      for (int p = 0; p < N; ++p) {
        EXPECT_NEAR(ours[k].v[p], double(theirs[k].v[p]), 1e-12 * size) << N << ", " << k << ", partial " << p;
      }
    }
  }
}

TEST(Jets, ArithmeticIsThatOfCeres) {
  expect_those_of_ceres<1>();
  expect_those_of_ceres<2>();
  expect_those_of_ceres<5>();
  expect_those_of_ceres<8>();
  expect_those_of_ceres<11>();
}

TEST(Jets, SelectAndSignCarryTheRightBranch) {
  using J = Jet<1>;
  EXPECT_EQ(sign_of(J(0.0, 0)).a, 1.0);
  EXPECT_EQ(sign_of(J(-1e-300, 0)).a, -1.0);
  EXPECT_EQ(sign_of(J(-2.0, 0)).v[0], 0.0);
  EXPECT_EQ(select(true, J(1.0, 0), J(2.0)).v[0], 1.0);
  EXPECT_EQ(select(false, J(1.0, 0), J(2.0)).v[0], 0.0);
}

/// Derivatives of what happens before the equations of motion: gear, planform, amplitude, resonance.
template <Scalar S>
std::array<S, 8> resolved(const std::array<S, 8>& x) {
  Design<S> d;
  d.supply = {SupplyType::pwm, x[0], S(1000.0), x[1]};
  d.motor.gear_ratio = x[2];
  d.motor.constants = {S(9.0), S(29e-3), S(5e-4), S(3e-10), S(7e-9), S(1e-6)};
  d.transmission.crank_radius = S(5e-3);
  d.transmission.rod_length = S(20e-3);
  d.transmission.stroke_amplitude = x[3];
  d.spring.resonance = x[4];
  d.wing.inertia = S(7e-8);
  d.wing.planform.shape = PlanformShape::semi_ellipse;
  d.wing.planform.length = x[5];
  d.wing.planform.root_chord = x[6];
  d.wing.planform.hub_offset = x[7];
  d.aerodynamics.coefficients = cast<S>(translational_2022());
  const Vehicle<S> v = resolve(d);
  return {v.voltage,
          v.motor.torque_constant,
          v.motor.inertia,
          v.motor.viscous_damping,
          v.transmission.slider_crank.hinge_offset,
          v.spring.stiffness,
          v.wings.s2,
          v.wings.s3};
}

TEST(Jets, ResolvedDesignAgreesWithDifferences) {
  using J = Jet<8>;
  const std::array<double, 8> values = {4.0, 0.6, 20.0, 0.7, 22.0, 63e-3, 25e-3, 4e-3};
  std::array<J, 8> dual;
  for (int n = 0; n < 8; ++n) dual[std::size_t(n)] = J(values[std::size_t(n)], n);
  const auto jets = resolved(dual);
  for (std::size_t n = 0; n < 8; ++n) {
    std::array<double, 8> more = values, less = values;
    const double h = 1e-5 * values[n];
    more[n] += h;
    less[n] -= h;
    const auto high = resolved(more), low = resolved(less), mid = resolved(values);
    for (std::size_t out = 0; out < 8; ++out) {
      EXPECT_NEAR(jets[out].v[int(n)], (high[out] - low[out]) / (2.0 * h), 1e-8 * std::abs(mid[out] / values[n]))
          << "output " << out << " by " << n;
    }
  }
}

}  // namespace
}  // namespace wingbeat
