// Sobol's indices: how much of a function's variance each of its independent inputs accounts for.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace wingbeat {

/// Indices of one input, or of a group of inputs, with 95 % intervals by the bootstrap (percentiles).
struct SobolIndex {
  double first = 0.0, first_lower = 0.0, first_upper = 0.0;  ///< share of the variance by this input alone
  double total = 0.0, total_lower = 0.0, total_upper = 0.0;  ///< with all interactions that it takes part in
};

struct SobolIndices {
  std::uint64_t rows = 0;  ///< used: those in which every value is there
  double variance = 0.0;
  std::vector<SobolIndex> inputs;
};

/// From two independent samples of the inputs, A and B: `a` and `b` hold f of each row, `mixed[i]` f of A with input i
/// taken from B. First-order indices by Saltelli and others, total ones by Jansen (Saltelli et al., "Variance based
/// sensitivity analysis of model output", Comput. Phys. Commun. 181, 2010, Table 2: b and f). Rows with a NaN anywhere
/// are left out. `resamples` 0: no intervals (NaN). Without two rows or without variance the indices are NaN. With f
/// counted from its mean, V its variance over A and B, and \f$A_B^{(i)}\f$ for A with input i taken from B:
/// \f[
/// S_i = \frac{1}{V} \overline{f(B) \left( f(A_B^{(i)}) - f(A) \right)}, \qquad
/// S_{\mathrm{T}i} = \frac{1}{2 V} \overline{\left( f(A) - f(A_B^{(i)}) \right)^2}
/// \f]
SobolIndices sobol_indices(std::span<const double> a, std::span<const double> b,
                           std::span<const std::vector<double>> mixed, int resamples, std::uint64_t seed);

}  // namespace wingbeat
