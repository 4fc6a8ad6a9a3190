// Every checkable statement of a paper, judged: published, ours in both formulations, deviation, verdict.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "wingbeat/io/published.hpp"
#include "wingbeat/study/reproduction.hpp"

namespace wingbeat {

enum class Verdict {
  reproduced,              ///< within the tolerance in both formulations
  not_reproduced,          ///< in neither
  depends_on_formulation,  ///< in one of them
  as_found                 ///< there is no published number
};
const char* name_of(Verdict verdict);
const char* name_of(Formulation formulation);

/// In the order rod-force, virtual-work.
inline constexpr std::array<Formulation, 2> both_formulations = {Formulation::rod_force, Formulation::virtual_work};

struct Claim {
  std::string statement, where;
  Basis basis;
  std::string unit;                 ///< SI; "1": a ratio or no number at all
  std::optional<double> published;  ///< SI
  double tolerance = absent;        ///< accepted relative deviation
  std::array<double, 2> ours{absent, absent};
  std::array<double, 2> deviation{absent, absent};  ///< ours / published - 1
  std::array<bool, 2> within{};
  std::string published_text;            ///< for reading
  std::array<std::string, 2> ours_text;  ///< for reading, with what is to be said about it
  Verdict verdict = Verdict::as_found;
};

/// A friction law, calibrated without springs, and what it then says about the published values with springs.
struct LawPrediction {
  CalibratedLaw law;
  Comparison comparison;           ///< of all published values, with that law
  std::vector<std::size_t> tests;  ///< those of them that the calibration has not seen: with springs
  double rms = absent;             ///< of their relative deviations
  LossCurve loss;                  ///< at the published frequency, as springs are added
};

struct Judgement {
  std::vector<Claim> claims;        ///< values, then trends, in the order of the file
  std::vector<LawPrediction> laws;  ///< rod-force first, each in the order of compared_friction_laws
  std::array<Comparison, 2> comparisons;
  int count(Verdict verdict) const;
};

/// Computes every statement in both formulations; the result does not depend on for_each. `done` is called now and
/// then, by one thread at a time, with the share that is done.
Judgement judge(const PublishedFile& file, const ForEach& for_each, const std::function<void(double)>& done = {});

std::string text_claims(const PublishedFile& file, const Judgement& judgement);
std::string json_claims(const PublishedFile& file, const Judgement& judgement);
std::string csv_claims(const Judgement& judgement);

/// The value that friction laws are calibrated to: the first published frequency of a single design at a voltage.
const PublishedValue& calibration_value(const PublishedFile& file);

}  // namespace wingbeat
