#include "scalars/arch/packs_impl.hpp"

namespace wingbeat::lanes {

#ifdef __x86_64__
using Base = xsimd::sse2;
#else
using Base = xsimd::neon64;
#endif

void evaluate_base(const Case* cases, int count, double* out) { evaluate<Base>(cases, count, out); }
int check_select_base() { return check_select<Base>(); }
void functions_base(const double* x, int count, double* out) { functions<Base>(x, count, out); }

}  // namespace wingbeat::lanes
