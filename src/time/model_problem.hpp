// The equations of a model in time as an integrator takes them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

#include "time/integrator.hpp"
#include "time/time_model.hpp"
#include "time/transient_tools.hpp"

namespace wingbeat::detail {

/// The model's unknowns, all its indicators being roots. `relative`: admissible error of a step. Model and tolerance
/// are referred to and may change between steps.
template <class Model>
IntegratorProblem problem_of(const Model& model, const double& relative) {
  IntegratorProblem p;
  p.size = p.coupled = model.coupled;
  p.roots = int(Model::indicator_count);
  p.stiff = model.stiff();
  p.rates = [&](double t, const double* y, double* dy) { return model.rates(t, y, dy, false); };
  p.root_functions = [&](double t, const double* y, double* values) {
    const auto indicators = model.indicators(t, y);
    std::copy(indicators.begin(), indicators.end(), values);
  };
  p.tolerated = [&](const double* y, double* errors) { model.tolerated(relative, y, errors); };
  p.longest_step = model.longest_step();
  const auto typical = model.typical();
  p.typical.assign(typical.begin(), typical.end());
  return p;
}

template <class Model>
std::unique_ptr<Integrator> integrator_for(TimeIntegrator which, const Model& model, const double& relative) {
  return make_integrator(which, problem_of(model, relative));
}

/// Adds `quadratures` behind the unknowns, which are of the sizes `scale`; the rates are to be those with them.
inline void add_quadratures(IntegratorProblem& p, const TimeModel& model, const double& relative,
                            const double (&scale)[quadrature_count]) {
  p.size += quadrature_count;
  p.tolerated = [&](const double* y, double* errors) {
    model.tolerated(relative, y, errors);
    for (int k = model.coupled; k < model.coupled + quadrature_count; ++k) {
      errors[k] = relative * (std::abs(y[k]) + 0.01 * scale[k - model.coupled]);
    }
  };
}

}  // namespace wingbeat::detail
