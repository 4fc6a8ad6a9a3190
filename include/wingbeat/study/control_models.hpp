// All that `wingbeat linearise` computes: linear model, static maps for allocation, body derivatives.
#pragma once

#include <optional>
#include <vector>

#include "wingbeat/study/allocation.hpp"
#include "wingbeat/study/body_derivatives.hpp"
#include "wingbeat/study/linear_model.hpp"

namespace wingbeat {

struct ControlOptions {
  RunOptions operating_point = {};  ///< the operating point
  int step_cycles = 0;              ///< of the step responses; 0: see linear_model_of()
  double hinge_offset = 0.0;        ///< from the body's middle plane to either stroke axis [m], >= 0
  bool allocation_maps = true;
};

struct ControlModels {
  Linearisation linear;
  ControlOptions options;
  std::vector<AllocationMap> maps;      ///< none without a linear model
  std::optional<BodyDerivatives> body;  ///< likewise
};

/// Throws ParameterError as linearise() and for options out of range.
ControlModels control_models(const Design<double>& design, const ControlOptions& options = {});

}  // namespace wingbeat
