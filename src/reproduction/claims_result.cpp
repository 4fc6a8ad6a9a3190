// What the --json of reproduce has: scores, calibrations, the title's answer, every statement, friction laws.
#include "report/described.hpp"
#include "reproduction/claim_schemas.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/reproduction/claims.hpp"

namespace wingbeat {
namespace described {

/// Null where there is none.
template <>
struct Form<Interval> {
  static Json schema() { return schema::or_null(schema::pair_of(schema::any_number)); }
  static Json json(const Interval& i) { return std::isfinite(i.low) ? Json{i.low, i.high} : Json(nullptr); }
};

namespace {

constexpr std::array<const char*, variant_count> variant_keys = {"rod-force", "virtual-work",
                                                                 "virtual-work-own-calibration"};

struct ClaimsFound {
  const PublishedFile& file;
  const Assessment& assessment;
};
/// One thing of an assessment, for one of its variants.
struct VariantFound {
  const Assessment& assessment;
  std::size_t variant;
  const TitleAnswer& answer() const { return assessment.answers[variant]; }
};
struct ClaimFound {
  const Claim& claim;
  std::size_t variants;
};
struct Side {
  const Claim& claim;
  std::size_t variant;
};
struct ScoreFound {
  Score score;
  std::size_t variants;
};
/// The statements of a reading, "" for those without.
struct Scored {
  const Assessment& assessment;
  std::string reading;
  ScoreFound by(Scoring scoring) const { return {assessment.score(reading, scoring), assessment.variants}; }
};

const Description<ScoreFound>& counts_description() {
  using R = ScoreFound;
  static const Description<R> description = [] {
    Description<R> met;
    for (std::size_t f = 0; f < variant_count; ++f) {
      met.sometimes(variant_keys[f], "", "",
                    [f](const R& r) { return f < r.variants ? std::optional(r.score.met[f]) : std::nullopt; });
    }
    return Description<R>()
        .always("reproduced", "", "met in both formulations", [](const R& r) { return r.score.reproduced; })
        .always("depends_on_the_formulation", "", "met in one of them", [](const R& r) { return r.score.depends; })
        .always("not_reproduced", "", "met in neither", [](const R& r) { return r.score.not_reproduced; })
        .part("met", "by formulation", met, std::identity{});
  }();
  return description;
}

Description<Scored> score_description() {
  using R = Scored;
  return Description<R>()
      .always("statements", "", "", [](const R& r) { return r.by(Scoring::printed).score.statements; })
      .all_of(counts_description(), [](const R& r) { return r.by(Scoring::printed); })
      .part("with_changes_as_ratios", "the ratio behind a change is compared: 1.333 for 33.3 %", counts_description(),
            [](const R& r) { return r.by(Scoring::ratios); })
      .part("within_printed_digits", "the digits of the printed number are the tolerance", counts_description(),
            [](const R& r) { return r.by(Scoring::digits); });
}

const Description<Scored>& section_5_description() {
  static const Description<Scored> description =
      score_description().always("crank_radius_rms_deviation", "1", "by rod-force",
                                 [](const Scored& r) { return r.by(Scoring::printed).score.rms_crank_radius; });
  return description;
}

const Description<MomentCalibration>& calibration_description() {
  using R = MomentCalibration;
  static const Description<R> description =
      Description<R>()
          .always("formulation", "", "", &R::formulation)
          .always("s2_m4", "m4", "second chord moment", &R::s2)
          .always("s3_m5", "m5", "third chord moment", &R::s3)
          .always("lift_peak_n", "N", "peak lifts that they give",
                  [](const R& r) { return std::array<double, 2>{r.lift_peak[0], r.lift_peak[1]}; })
          .always(
              "published_n", "N", "peak lifts that they are calibrated to",
              [](const R& r) { return std::array<double, 2>{r.wanted[0], r.wanted[1]}; },
              schema::pair_of(schema::any_number))
          .always("met", "", "", &R::met);
  return description;
}

const Description<VariantFound>& answer_description() {
  using R = VariantFound;
  const auto of_answer = [](auto member) { return [member](const R& r) { return r.answer().*member; }; };
  using T = TitleAnswer;
  static const Description<R> description =
      Description<R>()
          .always("formulation", "", "", [](const R& r) { return variant_name(r.variant); })
          .always("frequency_hz", "Hz", "held", of_answer(&T::frequency))
          .always("power_electrical_w", "W", "electrical input with the friction of the vehicle, without springs",
                  of_answer(&T::with))
          .always("power_electrical_w_95", "W", "95 % interval", of_answer(&T::with_interval))
          .always("without_friction_w", "W", "electrical input without friction", of_answer(&T::without))
          .always("without_friction_w_95", "W", "95 % interval", of_answer(&T::without_interval))
          .always("change", "1", "without over with friction, less 1", of_answer(&T::change))
          .always("change_95", "1", "95 % interval", of_answer(&T::change_interval))
          .always("residual", "1", "formulation residual over input", of_answer(&T::residual_with))
          .always("residual_without_friction", "1", "the same without friction", of_answer(&T::residual_without))
          .always("inside_the_domain", "", "both cycles", [](const R& r) { return !r.answer().outside; });
  return description;
}

bool has_outcome(const Claim& c) {
  return c.outcome != StatementOutcome::not_checkable && c.outcome != StatementOutcome::no_published_value;
}

const Description<Side>& side_description() {
  using R = Side;
  const auto of_claim = [](auto member) { return [member](const R& r) { return (r.claim.*member)[r.variant]; }; };
  static const Description<R> description =
      Description<R>()
          .always("value", "", "computed; the statement's unit", of_claim(&Claim::ours))
          .always("text", "", "for reading", of_claim(&Claim::ours_text))
          .always("deviation", "1", "computed / published - 1", of_claim(&Claim::deviation))
          .always("ratio_deviation", "1", "of a change: of the ratio behind it", of_claim(&Claim::ratio_deviation))
          .always("interval_95", "", "of the computed value", of_claim(&Claim::interval))
          .always("interval_from", "", "samples, or searches at the ends of each deviation",
                  [](const R& r) {
                    const bool has = std::isfinite(r.claim.interval[r.variant].low);
                    return has ? std::optional<std::string>(r.claim.searched ? "searches" : "samples") : std::nullopt;
                  })
          .always("residual", "1", "largest formulation residual over input", of_claim(&Claim::residual))
          .always("domain", "", "inside the model's domain, or not",
                  [](const R& r) { return domain_text(r.claim, r.variant); })
          .always("within", "", "the tolerance; null without an outcome", [](const R& r) {
            return has_outcome(r.claim) ? std::optional(bool(r.claim.within[r.variant])) : std::nullopt;
          });
  return description;
}

const Description<ClaimFound>& claim_description() {
  using R = ClaimFound;
  const auto text = [](std::string Claim::* member) {
    return [member](const R& r) {
      const std::string& said = r.claim.*member;
      return said.empty() ? std::nullopt : std::optional(said);
    };
  };
  const auto of_claim = [](auto member) { return [member](const R& r) { return r.claim.*member; }; };
  static const Description<R> description = [&] {
    Description<R> d;
    d.always("statement", "", "", of_claim(&Claim::statement))
        .always("where", "", "in the paper", of_claim(&Claim::where))
        .always("basis", "", "", of_claim(&Claim::basis))
        .always("counted", "", "in the score", [](const R& r) { return r.claim.counted(); })
        .always("reading", "", "what is held where the crank radius varies", text(&Claim::reading))
        .always("unit", "", "", of_claim(&Claim::unit))
        .always("published", "", "of a range its centre", of_claim(&Claim::published))
        .always("published_text", "", "with the digits of the paper", of_claim(&Claim::published_text))
        .always("tolerance", "1", "of the deviation", of_claim(&Claim::tolerance))
        .always("printed_digits", "", "how far they let the published number lie from the true one",
                of_claim(&Claim::digits))
        .always("searched_in", "", "range of a number that is searched for", text(&Claim::window));
    for (std::size_t f = 0; f < variant_count; ++f) {
      d.sometimes_part(variant_keys[f], "computed with this formulation", side_description(),
                       [f](const R& r) { return f < r.variants ? std::optional<Side>({r.claim, f}) : std::nullopt; });
    }
    return d.always("outcome", "", "", [](const R& r) { return name_of(r.claim.outcome); })
        .sometimes("reason", "", "why it has no outcome", text(&Claim::reason))
        .sometimes("note", "", "", text(&Claim::note))
        .sometimes("erratum", "", "in the paper", text(&Claim::erratum));
  }();
  return description;
}

const Description<LawPrediction>& law_description() {
  using R = LawPrediction;
  const auto of_law = [](auto member) { return [member](const R& r) { return r.law.*member; }; };
  using L = CalibratedLaw;
  static const Description<R> description =
      Description<R>()
          .always("law", "", "", of_law(&L::law))
          .always("drag_factor", "1", "on the third chord moment", &R::drag_factor, schema::any_number)
          .always("drag_factor_95", "1", "95 % interval", &R::drag_interval)
          .always("input_change_by_springs_95", "1", "95 % interval", &R::input_change_interval)
          .always("formulation", "", "", [](const R& r) { return variant_name(r.variant); })
          .always("coefficient", "", "of the law, SI", of_law(&L::coefficient), schema::any_number)
          .always("calibrated", "", "the vehicle without springs flaps at the published frequency",
                  of_law(&L::calibrated))
          .always("frequency_hz", "Hz", "of that vehicle", of_law(&L::frequency))
          .always("values", "", "published values with springs that it is tested against",
                  [](const R& r) { return r.tests.size(); })
          .always("rms_deviation", "1", "from them", &R::rms)
          .always("rms_deviation_as_ratios", "1", "the same with changes as ratios", &R::rms_of_ratios);
  return description;
}

Json section_5(const Assessment& a) {
  Json all = Json::object();
  for (const char* reading : readings) {
    if (a.score(reading).statements == 0) continue;
    all[detail::underscored(reading)] = section_5_description().json({a, reading});
  }
  return all;
}

const Description<ClaimsFound>& claims_description() {
  using R = ClaimsFound;
  const auto answers = [](const R& r) {
    std::vector<VariantFound> all;
    for (std::size_t f = 0; f < r.assessment.variants; ++f) all.push_back({r.assessment, f});
    return all;
  };
  const auto claims = [](const R& r) {
    std::vector<ClaimFound> all;
    for (const Claim& c : r.assessment.claims) all.push_back({c, r.assessment.variants});
    return all;
  };
  static const Description<R> description =
      Description<R>()
          .always("title", "", "", [](const R& r) { return r.file.title; })
          .always("source", "", "", [](const R& r) { return r.file.source; })
          .part("predictions", "scores of the predictions of sections 3 and 4 and of the conclusion",
                score_description(), [](const R& r) { return Scored{r.assessment, ""}; })
          .sometimes(
              "section_5", "", "scores of its predictions, by reading",
              [](const R& r) {
                const Json found = section_5(r.assessment);
                return found.empty() ? std::nullopt : std::optional(found);
              },
              schema::by_name(section_5_description().schema()))
          .parts("calibration", "chord moments calibrated for each formulation", calibration_description(),
                 [](const R& r) -> const auto& { return r.assessment.calibrations; })
          .parts("answer", "the title's question in numbers, by formulation", answer_description(), answers)
          .always("samples", "", "of the uncertain parameters behind each interval; 0: no intervals",
                  [](const R& r) { return r.assessment.samples; })
          .parts("claims", "every statement", claim_description(), claims)
          .parts("friction_laws", "what each law, calibrated without springs, says about the values with springs",
                 law_description(), [](const R& r) -> const auto& { return r.assessment.laws; });
  return description;
}

}  // namespace

Json claims_schema() { return claims_description().schema(); }

}  // namespace described

std::string json_claims(const PublishedFile& file, const Assessment& assessment) {
  return described::claims_description()
             .json({file, assessment})
             .dump(2, ' ', false, detail::Json::error_handler_t::replace) +
         "\n";
}

}  // namespace wingbeat
