// Every checkable statement of a paper, assessed: published value, computed ones in both formulations, deviation,
// outcome.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <iterator>
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

/// What counts as met.
enum class Scoring {
  printed,  ///< within the tolerance of the number as the paper prints it
  ratios,   ///< the same, but of a change the ratio behind it: 1.333 for 33.3 %
  digits    ///< within the digits of the printed number: half a unit of the last one, a whole unit of "about"
};

/// Where a number lies with a probability of 95 %: the middle of the samples of the uncertain parameters or, of a
/// number that is searched for, by propagation of their standard deviations.
struct Interval {
  double low = absent, high = absent;
};

struct Claim {
  std::string statement, where;
  Basis basis;
  std::string unit;                 ///< SI; "1": a ratio or no number at all
  std::optional<double> published;  ///< SI; of a range its centre
  double tolerance = absent;        ///< accepted relative deviation; absent: a bound, or no number
  std::array<double, variant_count> ours{absent, absent, absent};
  std::array<double, variant_count> deviation{absent, absent, absent};  ///< ours / published - 1
  /// Of a change the deviation of the ratio, (1 + ours) / (1 + published) - 1; else absent.
  std::array<double, variant_count> ratio_deviation{absent, absent, absent};
  double digits = absent;  ///< how far the printed digits let the published number lie from the true one [its unit]
  std::array<Interval, variant_count> interval;  ///< of ours
  bool searched = false;  ///< the interval is that of a search solved anew for each parameter, not of samples
  std::array<bool, variant_count> within{};  ///< by Scoring::printed, with the file's tolerance
  /// Largest formulation residual over input of the cycles behind the number; absent where no cycle is.
  std::array<double, variant_count> residual{absent, absent, absent};
  std::array<bool, variant_count> outside{};  ///< of the domain; as answers keep the other limits, by that residual
  std::string window;                         ///< what the number was searched in: "8 to 28 Hz"; else empty
  std::string published_text;                 ///< for reading, with the digits of the paper
  std::array<std::string, variant_count> ours_text;                 ///< for reading, with what is to be said about it
  StatementOutcome outcome = StatementOutcome::no_published_value;  ///< of the first two variants
  std::string reading;  ///< "hinge offset held" or "stroke held", where the crank radius varies; else empty
  std::string reason, note, erratum;  ///< as in the published file
  bool restates = false;

  /// Whether the headline counts it: a prediction with an outcome, and not the same fact once more.
  bool counted() const;
  bool met(std::size_t variant, Scoring scoring, double tolerance) const;
};

/// A model that may explain the published values: a friction law, or none and more drag.
struct Rival {
  const char* name;
  FrictionLaw law;
  bool
      own_drag;  ///< without friction, S_3 is scaled until the vehicle without springs flaps at the published frequency
};
inline constexpr Rival rivals[] = {
    {"none", FrictionLaw::none, false},         {"none, more drag", FrictionLaw::none, true},
    {"viscous", FrictionLaw::viscous, false},   {"quadratic", FrictionLaw::quadratic, false},
    {"constant", FrictionLaw::constant, false}, {"load-proportional", FrictionLaw::load_proportional, false}};
inline constexpr std::size_t load_proportional_rival = std::size(rivals) - 1;

/// A rival, calibrated without springs, and what it then says about the published values with springs.
struct LawPrediction {
  std::size_t variant = 0;
  std::size_t rival = 0;
  CalibratedLaw law;
  double drag_factor = 1.0;        ///< of S_3
  Interval drag_interval;          ///< of drag_factor, where it is calibrated
  Interval input_change_interval;  ///< of the change of the electrical input by springs, of the same rival
  Comparison comparison;           ///< of all published values, with that law
  std::vector<std::size_t> tests;  ///< those with springs that no calibration has seen
  std::vector<std::size_t> seen;   ///< those with springs that were used when S_2 and S_3 were chosen: not scored
  double rms = absent;             ///< of the tests' relative deviations
  double rms_of_ratios = absent;   ///< the same with changes as ratios
  LossCurve loss;                  ///< at the published frequency, as springs are added; of the first two variants
};

/// How many counted statements there are, and how many each variant meets.
struct Score {
  int statements = 0, reproduced = 0, not_reproduced = 0, depends = 0;
  std::array<int, variant_count> met{};
  double rms_crank_radius = absent;  ///< of a reading: deviations of the crank radii, by rod-force [1]
};

/// The title question in numbers: electrical input without springs at a held frequency, with the friction of the
/// vehicle and without any.
struct TitleAnswer {
  double frequency = absent;                                ///< [Hz]
  double with = absent, without = absent, change = absent;  ///< [W], without / with - 1
  Interval with_interval, without_interval, change_interval;
  double residual_with = absent, residual_without = absent;  ///< over input
  bool outside = false;                                      ///< either of them is outside the domain
};

struct Assessment {
  std::vector<Claim> claims;        ///< values, then trends, in the order of the file
  std::vector<LawPrediction> laws;  ///< variant by variant, each in the order of rivals
  std::array<TitleAnswer, variant_count> answers;
  std::uint64_t samples = 0;  ///< of the uncertain parameters behind each interval; 0: no intervals
  std::array<Comparison, variant_count> comparisons;
  /// S_2 and S_3 computed anew for each formulation; empty where the file holds no two peak lifts to calibrate to.
  std::vector<MomentCalibration> calibrations;
  std::size_t variants = 2;  ///< 3 where there are calibrations
  int count(StatementOutcome outcome) const;
  /// Of the predictions with that reading, "" for those that have none; `tolerance` replaces the file's.
  Score score(const std::string& reading, Scoring scoring = Scoring::printed,
              std::optional<double> tolerance = std::nullopt) const;
  /// Of the predicted published values, the root mean square of the deviations of a variant.
  double rms_of_predicted_values(std::size_t variant, Scoring scoring = Scoring::printed) const;
};

inline constexpr const char* readings[] = {"hinge offset held", "stroke held"};

/// Computes every statement; the result does not depend on for_each. `done` is called now and then, by one thread at a
/// time, with the share that is done.
Assessment assess(const PublishedFile& file, const ForEach& for_each, const std::function<void(double)>& done = {});

std::string text_claims(const PublishedFile& file, const Assessment& assessment);
std::string json_claims(const PublishedFile& file, const Assessment& assessment);
std::string csv_claims(const Assessment& assessment);

/// "inside", "outside the domain, residual 6.2 %", or "no cycle" for a number that no cycle is behind.
std::string domain_text(const Claim& claim, std::size_t variant);
/// A number of a claim for reading: "236.4 mW", "33.24 %".
std::string number_text(double x, const Claim& claim);
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
