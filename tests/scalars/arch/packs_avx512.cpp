#include "scalars/arch/packs_impl.hpp"

namespace wingbeat::lanes {

void evaluate_avx512(const Case* cases, int count, double* out) { evaluate<xsimd::avx512f>(cases, count, out); }
int check_select_avx512() { return check_select<xsimd::avx512f>(); }
void functions_avx512(const double* x, int count, double* out) { functions<xsimd::avx512f>(x, count, out); }

}  // namespace wingbeat::lanes
