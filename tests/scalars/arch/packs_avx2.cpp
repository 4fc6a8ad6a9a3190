#include "scalars/arch/packs_impl.hpp"

namespace wingbeat::lanes {

void evaluate_avx2(const Case* cases, int count, double* out) { evaluate<xsimd::avx2>(cases, count, out); }
int check_select_avx2() { return check_select<xsimd::avx2>(); }
void functions_avx2(const double* x, int count, double* out) { functions<xsimd::avx2>(x, count, out); }

}  // namespace wingbeat::lanes
