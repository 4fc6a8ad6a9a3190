// Batches of one instruction set behind plain functions, so that files for different instruction sets share nothing
// but numbers.
#pragma once

#include "scalars/kernel.hpp"

namespace wingbeat::lanes {

/// One design at one point, for a lane.
struct Case {
  Vehicle<double> vehicle;
  double theta, omega, current, voltage;
  double force;  ///< assumed sign of the rod force
};

/// Evaluates instant() and crank_step() for `count` cases that share formulation and whether there is an
/// inductance. `out` receives instant_size + step_size numbers for each.
void evaluate_base(const Case* cases, int count, double* out);
void evaluate_avx2(const Case* cases, int count, double* out);
void evaluate_avx512(const Case* cases, int count, double* out);

/// Small functions on mixed lanes; the number of the first check that fails, 0 if none does.
int check_select_base();
int check_select_avx2();
int check_select_avx512();

/// sin, cos, atan of x; inverse, root and inverse root of |x| + 1e-3; the nearest whole number; sine and cosine without
/// reduction. `count` is a multiple of the lanes; `out` receives function_count numbers for each x.
inline constexpr int function_count = 9;
void functions_base(const double* x, int count, double* out);
void functions_avx2(const double* x, int count, double* out);
void functions_avx512(const double* x, int count, double* out);

}  // namespace wingbeat::lanes
