#include "wingbeat/study/control_models.hpp"

#include <cmath>

#include "wingbeat/core/status.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

ControlModels control_models(const Design<double>& design, const ControlOptions& options) {
  require(options.hinge_offset >= 0.0, "hinge_offset", "must be >= 0", "m", options.hinge_offset);
  require(options.step_cycles >= 0 && options.step_cycles <= 100000, "cycles", "must be 0 to 100000", "1",
          options.step_cycles);
  require(options.hinge_offset >= 0.0 && std::isfinite(options.hinge_offset), "hinge_offset", "must be >= 0", "m",
          options.hinge_offset);
  ControlModels models;
  models.options = options;
  models.linear = linearise(design, options.operating_point, options.step_cycles);
  if (!models.linear.model) return models;
  const Design<double>& operated = models.linear.operating_point.design;
  models.body = body_derivatives(operated, resolve(operated, options.operating_point.condition),
                                 models.linear.orbit.record, options.hinge_offset);
  if (options.allocation_maps) models.maps = allocation_maps(models.linear, options.hinge_offset);
  return models;
}

}  // namespace wingbeat
