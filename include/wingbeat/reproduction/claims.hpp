// Every checkable statement of a paper, assessed: published value, computed ones in both formulations, deviation,
// outcome.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "wingbeat/files/published.hpp"
#include "wingbeat/reproduction/comparison.hpp"
#include "wingbeat/study/moment_calibration.hpp"
#include "wingbeat/study/reproduction.hpp"

namespace wingbeat {

enum class StatementOutcome {
  reproduced,              ///< within the tolerance in both formulations
  not_reproduced,          ///< in neither
  depends_on_formulation,  ///< in one of them
  not_checkable,           ///< for a reason that is given
  no_published_value
};
const char* name_of(StatementOutcome outcome);

/// In the order rod-force, virtual-work.
inline constexpr std::array<Formulation, 2> both_formulations = {Formulation::rod_force, Formulation::virtual_work};

/// What each statement is computed for: both formulations with the chord moments of the vehicle files, which suit
/// rod-force, and virtual-work with chord moments calibrated for it to the same values.
inline constexpr std::size_t variant_count = 3;
inline constexpr std::size_t recalibrated = 2;
const char* variant_name(std::size_t variant);
inline constexpr std::array<Formulation, variant_count> variant_formulations = {
    Formulation::rod_force, Formulation::virtual_work, Formulation::virtual_work};

struct Claim {
  std::string statement, where;
  Basis basis;
  std::string unit;                 ///< SI; "1": a ratio or no number at all
  std::optional<double> published;  ///< SI; of a range its centre
  double tolerance = absent;        ///< accepted relative deviation; absent: a bound, or no number
  std::array<double, variant_count> ours{absent, absent, absent};
  std::array<double, variant_count> deviation{absent, absent, absent};  ///< ours / published - 1
  std::array<bool, variant_count> within{};
  std::array<bool, variant_count> outside{};         ///< of the domain, by the residual of the formulation
  std::string published_text;                        ///< for reading, with the digits of the paper
  std::array<std::string, variant_count> ours_text;  ///< for reading, with what is to be said about it
  StatementOutcome outcome = StatementOutcome::no_published_value;  ///< of the first two variants
  std::string reading;  ///< "hinge offset held" or "stroke held", where the crank radius varies; else empty
  std::string reason, note, erratum;  ///< as in the published file
  bool restates = false;

  /// Whether the headline counts it: a prediction with an outcome, and not the same fact once more.
  bool counted() const;
};

/// A friction law, calibrated without springs, and what it then says about the published values with springs.
struct LawPrediction {
  std::size_t variant = 0;
  CalibratedLaw law;
  Comparison comparison;           ///< of all published values, with that law
  std::vector<std::size_t> tests;  ///< those with springs that no calibration has seen
  std::vector<std::size_t> seen;   ///< those with springs that were used when S_2 and S_3 were chosen: not scored
  double rms = absent;             ///< of the tests' relative deviations
  LossCurve loss;                  ///< at the published frequency, as springs are added; of the first two variants
};

/// How many counted statements there are, and how many each variant meets.
struct Score {
  int statements = 0, reproduced = 0, not_reproduced = 0, depends = 0;
  std::array<int, variant_count> met{};
  double rms_crank_radius = absent;  ///< of a reading: deviations of the crank radii, by rod-force [1]
};

struct Assessment {
  std::vector<Claim> claims;        ///< values, then trends, in the order of the file
  std::vector<LawPrediction> laws;  ///< variant by variant, each in the order of compared_friction_laws
  std::array<Comparison, variant_count> comparisons;
  /// S_2 and S_3 computed anew for each formulation; empty where the file holds no two peak lifts to calibrate to.
  std::vector<MomentCalibration> calibrations;
  std::size_t variants = 2;  ///< 3 where there are calibrations
  int count(StatementOutcome outcome) const;
  /// Of the predictions with that reading, "" for those that have none; `tolerance` replaces the file's.
  Score score(const std::string& reading, std::optional<double> tolerance = std::nullopt) const;
  /// Of the predicted published values, the root mean square of the deviations of a variant.
  double rms_of_predicted_values(std::size_t variant) const;
};

inline constexpr const char* readings[] = {"hinge offset held", "stroke held"};

/// Computes every statement; the result does not depend on for_each. `done` is called now and then, by one thread at a
/// time, with the share that is done.
Assessment assess(const PublishedFile& file, const ForEach& for_each, const std::function<void(double)>& done = {});

std::string text_claims(const PublishedFile& file, const Assessment& assessment);
std::string json_claims(const PublishedFile& file, const Assessment& assessment);
std::string csv_claims(const Assessment& assessment);

/// "+1.2 %", or nothing for an absent deviation.
std::string percent_text(double deviation);
/// The outcome, with the formulation that it depends on.
std::string outcome_text(const Claim& claim);

/// How the table of statements is divided.
struct ClaimGroup {
  const char *name, *heading;  ///< in lists; above rows of a figure, shorter
  bool (*holds)(const Claim&);
};
const std::vector<ClaimGroup>& claim_groups();

/// The value that friction laws are calibrated to: the first published frequency of a single design at a voltage.
const PublishedValue& calibration_value(const PublishedFile& file);

}  // namespace wingbeat
