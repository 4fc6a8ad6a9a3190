// Which design of a sweep is the best: one rule for reports and plots.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

namespace wingbeat {

/// The design with most of a metric, or least. Where lift over weight is known and some of the designs carry their
/// weight, it is sought among these alone: of two vehicles, the one that cannot hover is not the better one.
class SweepBest {
 public:
  explicit SweepBest(bool least = false) : least_(least) {}

  struct Design {
    std::uint64_t index;
    double value;
  };

  /// Offers a design that counts: one that flaps, inside the model's domain unless extrapolation is allowed. Of equal
  /// values the first offered stays; what is no number is passed over. `lift_to_weight` is NaN where it is not known.
  void offer(std::uint64_t index, double value, double lift_to_weight) {
    if (!std::isfinite(value)) return;
    if (!any_ || better(value, any_->value)) any_ = {index, value};
    if (lift_to_weight >= 1.0 && (!carrying_ || better(value, carrying_->value))) carrying_ = {index, value};
  }

  const std::optional<Design>& design() const { return carrying_ ? carrying_ : any_; }
  /// The design was sought among those that carry their weight.
  bool carries_weight() const { return carrying_.has_value(); }

 private:
  bool better(double a, double b) const { return least_ ? a < b : a > b; }

  bool least_;
  std::optional<Design> any_, carrying_;
};

}  // namespace wingbeat
