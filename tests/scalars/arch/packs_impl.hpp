// The bodies of packs.hpp for one instruction set. No containers: what this file instantiates must belong to its own
// instruction set alone.
#pragma once

#include "scalars/arch/packs.hpp"
#include "wingbeat/core/pack.hpp"

namespace wingbeat::lanes {

template <class Arch>
void evaluate(const Case* cases, int count, double* out) {
  using B = Pack<Arch, 2>;
  constexpr int size = ScalarTraits<B>::lanes;
  constexpr int outputs = instant_size + step_size;
  for (int start = 0; start < count; start += size) {
    alignas(64) double numbers[size];
    // The last batch is filled up with its last case.
    const auto gather = [&](const auto& number_of) {
      for (int lane = 0; lane < size; ++lane) {
        const int n = start + lane < count ? start + lane : count - 1;
        numbers[lane] = number_of(cases[n]);
      }
      return B::load(numbers);
    };
    const Vehicle<B> vehicle = in_packs<B, Vehicle>([&](int lane) -> const Vehicle<double>& {
      return cases[start + lane < count ? start + lane : count - 1].vehicle;
    });
    const B omega = gather([](const Case& c) { return c.omega; });
    const B current = gather([](const Case& c) { return c.current; });
    const B force = gather([](const Case& c) { return c.force; });
    const Point<B> point{gather([](const Case& c) { return std::sin(c.theta); }),
                         gather([](const Case& c) { return std::cos(c.theta); }),
                         omega,
                         current,
                         gather([](const Case& c) { return c.voltage; }),
                         force,
                         force};
    const auto numbers_at = instant<B>(vehicle, point);
    // Steps start a little off rest, as a crank speed of zero ends a cycle.
    const auto step = crank_step<B>(vehicle, gather([](const Case& c) { return c.theta; }),
                                    {B(120.0) + abs(omega), current}, B(0.1), {force, B(1.0), B(1.0), B(1.0), B(1.0)});
    for (int n = 0; n < outputs; ++n) {
      (n < instant_size ? numbers_at[std::size_t(n)] : step[std::size_t(n - instant_size)]).store(numbers);
      for (int lane = 0; lane < size && start + lane < count; ++lane) {
        out[(start + lane) * outputs + n] = numbers[lane];
      }
    }
  }
}

template <class Arch>
int check_select() {
  using B = Pack<Arch, 2>;
  constexpr int size = ScalarTraits<B>::lanes;
  alignas(64) double x[size], a[size], b[size], got[size];
  const double values[] = {-1.0, 0.0, -0.0, 2.0, -3.0, 1e-300, -1e-300, 5.0};
  for (int lane = 0; lane < size; ++lane) {
    x[lane] = values[lane % 8];
    a[lane] = 10.0 + lane;
    b[lane] = -10.0 - lane;
  }
  const B batch = B::load(x);
  sign_of(batch).store(got);
  for (int lane = 0; lane < size; ++lane) {
    if (got[lane] != (x[lane] >= 0.0 ? 1.0 : -1.0)) return 1;
  }
  select<B>(batch > B(0.0), B::load(a), B::load(b)).store(got);
  for (int lane = 0; lane < size; ++lane) {
    if (got[lane] != (x[lane] > 0.0 ? a[lane] : b[lane])) return 2;
  }
  for (int only = 0; only < size; ++only) {
    for (int lane = 0; lane < size; ++lane) x[lane] = lane == only ? 1.0 : -1.0;
    const B one = B::load(x);
    if (!any<B>(one > B(0.0)) || all<B>(one > B(0.0)) || all<B>(one < B(0.0)) || any<B>(one > B(1.0))) return 3;
    if (only == 0 ? value_of(one) != 1.0 : value_of(one) != -1.0) return 4;
  }
  if (!all<B>(B(1.0) > B(0.0)) || any<B>(B(-1.0) > B(0.0))) return 5;
  square(batch).store(got);
  for (int lane = 0; lane < size; ++lane) {
    if (got[lane] != values[lane % 8] * values[lane % 8]) return 6;
  }
  // A cycle that takes no electrical power in one lane has no efficiency in that lane alone.
  for (int only = 0; only < size; ++only) {
    for (int lane = 0; lane < size; ++lane) x[lane] = lane == only ? 0.0 : 2.0;
    CycleIntegrals<B> integrals;
    CycleExtremes<B> extremes;
    integrals.fill(B(0.5));
    extremes.fill(B(1.0));
    integrals[std::size_t(Integral::electrical_work)] = B::load(x);
    const Vehicle<B> vehicle = cast<B>(Vehicle<double>{});
    const Metrics<B> m = cycle_metrics(vehicle, integrals, extremes, B(0.0), {});
    m[Metric::efficiency_system].store(got);
    for (int lane = 0; lane < size; ++lane) {
      if (lane == only ? got[lane] == got[lane] : got[lane] != 0.25) return 7;
    }
  }
  return 0;
}

template <class Arch>
void functions(const double* x, int count, double* out) {
  using B = Pack<Arch, 2>;
  for (int start = 0; start < count; start += B::lanes) {
    alignas(64) double numbers[B::lanes];
    for (int lane = 0; lane < B::lanes; ++lane) numbers[lane] = x[start + lane];
    const B argument = B::load(numbers), positive = abs(argument) + B(1e-3);
    const auto root = root_of(positive);
    const auto reduced = sine_cosine_of_reduced(argument);
    const B results[function_count] = {sin(argument),           cos(argument), atan(argument),
                                       inverse_of(positive),    root.value,    root.inverse,
                                       nearest_whole(argument), reduced.sine,  reduced.cosine};
    for (int f = 0; f < function_count; ++f) {
      results[f].store(numbers);
      for (int lane = 0; lane < B::lanes; ++lane) out[(start + lane) * function_count + f] = numbers[lane];
    }
  }
}

}  // namespace wingbeat::lanes
