// A sweep: a grid of axes over one vehicle's parameters, and the steady flapping of any run of its designs.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/study/hold.hpp"
#include "wingbeat/study/sampling.hpp"
#include "wingbeat/study/sweep_status.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

/// One thing that varies along an axis.
struct SweptQuantity {
  enum class Kind {
    number,  ///< a parameter of the design, through `set`
    held,    ///< what Sweep::hold holds: its value varies
    choice   ///< a choice without a number: condition, springs on or off, a text key; see Sweep::variants
  };
  Kind kind = Kind::number;
  std::string key;      ///< as in the study file: "transmission.crank_radius", "condition"
  std::string name;     ///< of its variable in the data set
  std::string unit;     ///< SI
  std::string meaning;  ///< plain words
  bool (*set)(Design<double>&, const double&) = nullptr;
  std::vector<double> values;       ///< along the axis [SI]; empty for choices and for drawn samples
  std::vector<std::string> labels;  ///< of a choice, along the axis
  double low = 0.0, high = 0.0;     ///< range of drawn samples [SI]
  bool logarithmic = false;         ///< samples are drawn evenly in the logarithm
};

/// One dimension of a sweep. All its quantities vary together.
struct SweepAxis {
  std::string name;  ///< of the dimension in the data set
  std::uint64_t count = 1;
  std::vector<SweptQuantity> quantities;
  bool samples = false;  ///< the order along the axis has no meaning
  std::optional<LatinHypercube> latin_hypercube;
  std::optional<ScrambledSobol> sobol;

  /// A number of that quantity at a place along the axis [SI].
  double value(std::size_t quantity, std::uint64_t place) const;
};

/// The vehicle before numbers are set: one for each combination of choices.
struct SweepVariant {
  Design<double> design;
  Condition condition = Condition::air;
  bool springs = true;  ///< false: any spring is taken out, whatever a key sets
};

struct Sweep {
  std::vector<SweepAxis> axes;  ///< the last varies fastest
  std::vector<SweepVariant> variants;
  std::vector<std::uint64_t> variant_stride;  ///< of each axis in `variants`; 0 for an axis without choices
  /// Where choices are drawn: that in `variants` by place along the last axis, in the stead of variant_stride; or
  /// empty.
  std::vector<std::uint32_t> drawn_variants;
  std::optional<Hold> hold;  ///< its value may be an axis instead
  EnsembleOptions options;
  bool allow_extrapolation = false;  ///< designs outside the model's domain count as best, feasible, ... too

  std::uint64_t size() const;  ///< number of designs
};

/// Place of a design along each axis.
std::vector<std::uint64_t> places(const Sweep& sweep, std::uint64_t index);

/// A design of the sweep, with its variant's condition. Not validated.
struct SweepDesign {
  Design<double> design;
  Condition condition = Condition::air;
  std::optional<Hold> hold;
};
SweepDesign design_at(const Sweep& sweep, std::uint64_t index);

/// Results of designs that follow each other, column by column.
struct SweepColumns {
  std::uint64_t first = 0;
  std::vector<std::int8_t> status;           ///< SweepStatus
  std::vector<std::int8_t> recomputed;       ///< 1: by the scalar solver
  std::vector<std::int16_t> domain;          ///< bits of DomainStatus, of what flaps; 0: inside
  std::vector<double> error_estimate;        ///< relative; absent unless flapping
  std::vector<std::vector<double>> metrics;  ///< those of options.metrics, in the order of Metric

  void resize(std::size_t designs, std::size_t metrics_kept);
  /// Flapping and, unless extrapolation is allowed, inside the model's domain.
  bool counts(std::size_t row, bool allow_extrapolation) const {
    return status[row] == std::int8_t(SweepStatus::flapping) && (allow_extrapolation || domain[row] == 0);
  }
};

/// Computes designs of one sweep on one thread, with memory of its own.
class SweepSolver {
 public:
  SweepSolver(const Sweep& sweep, StartUp start_up);

  /// Designs columns.first + begin to columns.first + end, into the rows begin to end. What comes out for a design does
  /// not depend on how a sweep is divided.
  void solve(SweepColumns& columns, std::size_t begin, std::size_t end);

 private:
  void gather(SweepColumns& columns, std::size_t begin, std::size_t end);
  void fly(SweepColumns& columns, std::size_t row, const Vehicle<double>& found) const;

  const Sweep& sweep_;
  StartUp start_up_;
  std::vector<int> kept_;  ///< metrics
  std::vector<SweepVariant> variants_;
  std::vector<EnsembleMember> members_;
  std::vector<std::size_t> rows_;  ///< of the members
  std::vector<Hold> holds_;
  std::vector<double> angles_;  ///< of attack that C_alpha is found for [rad]; NaN of members without
  std::vector<EnsembleOutcome> outcomes_;
  std::vector<FrequencyOutcome> reached_;
};

/// Designs that are solved together on one thread.
inline constexpr std::size_t sweep_block = 512;

}  // namespace wingbeat
