#include "scalars/arch/lanes_impl.hpp"

namespace wingbeat::lanes {

void evaluate_avx2(const Case* cases, int count, double* out) { evaluate<xsimd::avx2>(cases, count, out); }
int check_select_avx2() { return check_select<xsimd::avx2>(); }

}  // namespace wingbeat::lanes
