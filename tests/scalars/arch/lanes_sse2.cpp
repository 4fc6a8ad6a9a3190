#include "scalars/arch/lanes_impl.hpp"

namespace wingbeat::lanes {

void evaluate_sse2(const Case* cases, int count, double* out) { evaluate<xsimd::sse2>(cases, count, out); }
int check_select_sse2() { return check_select<xsimd::sse2>(); }
void functions_sse2(const double* x, int count, double* out) { functions<xsimd::sse2>(x, count, out); }

}  // namespace wingbeat::lanes
