// What the --json of optimise has where gearboxes or batteries are lists.
#include "report/described.hpp"
#include "report/result_schemas.hpp"
#include "report/result_trees.hpp"
#include "report/trial_result.hpp"
#include "wingbeat/report/optimise_report.hpp"

namespace wingbeat {
namespace described {
namespace {

struct DriveTrainsFound {
  const OptimiseFile& file;
  const DriveTrainScreen& screen;
  std::span<const MotorTrial> trials;
};

const Description<LimitCount>& limit_description() {
  using R = LimitCount;
  static const Description<R> description =
      Description<R>()
          .always("limit", "", "constraint of the study, or the part whose limit it is", &R::limit)
          .always("excluded", "",
                  "combinations that flap inside the domain with no design within it; by torques: of those with a "
                  "design within every other limit",
                  &R::excluded)
          .always("alone", "", "of these, with a design within every other limit", &R::alone);
  return description;
}

const Description<DriveTrainScreen>& drive_train_screen_description() {
  using R = DriveTrainScreen;
  const auto outcome = [](CombinationOutcome which) {
    return [which](const R& r) { return r.outcomes[std::size_t(which)]; };
  };
  static const Description<R> description = [outcome] {
    Description<R> d;
    d.always("combinations", "", "", [](const R& r) { return r.combinations.size(); })
        .always("within", "", "combinations with a design within every limit", outcome(CombinationOutcome::within))
        .always("excluded", "", "combinations that flap inside the domain, each design beyond a limit",
                outcome(CombinationOutcome::excluded))
        .always("outside_domain", "", "combinations that flap outside the domain alone",
                outcome(CombinationOutcome::outside))
        .always("do_not_flap", "", "combinations that do not flap, or not with what is held",
                outcome(CombinationOutcome::does_not_flap))
        .parts("limits", "what the limits exclude", limit_description(), [](const R& r) { return r.limits; })
        .always("designs", "", "solved", &R::designs)
        .always("recomputed", "", "of these, by the scalar solver", &R::recomputed);
    add_by_status(d, "designs", [](const R& r, std::size_t s) { return r.status[s]; });
    return d;
  }();
  return description;
}

struct LeftOutPart {
  const char* kind;
  std::string model, refused;
};
std::vector<LeftOutPart> left_out(const OptimiseFile& file) {
  std::vector<LeftOutPart> parts;
  const auto add = [&](const char* kind, const auto& list) {
    for (const auto& part : list) {
      if (!part.refused.empty()) parts.push_back({kind, part.model, part.refused});
    }
  };
  add("motor", file.motors);
  add("gearbox", file.drive_train.gearboxes);
  add("battery", file.drive_train.batteries);
  return parts;
}
const Description<LeftOutPart>& left_out_description() {
  using R = LeftOutPart;
  static const Description<R> description =
      Description<R>()
          .always("part", "", "motor, gearbox or battery", [](const R& r) { return std::string(r.kind); })
          .always("model", "", "", &R::model)
          .always("refused", "", "why it cannot be used", &R::refused);
  return description;
}

const Description<DriveTrainsFound>& drive_trains_description() {
  using R = DriveTrainsFound;
  static const Description<R> description =
      Description<R>()
          .always("best", "", "the best combination; null where none does it",
                  [](const R& r) {
                    const MotorTrial* best = best_trial(r.file, r.trials);
                    return best ? std::optional<std::string>(name_of(r.file, *best)) : std::nullopt;
                  })
          .part("screening", "of all combinations", drive_train_screen_description(),
                [](const R& r) -> const DriveTrainScreen& { return r.screen; })
          .parts("left_out", "parts of the lists that cannot be used", left_out_description(),
                 [](const R& r) { return left_out(r.file); })
          .always(
              "drive_trains", "", "the combinations that were searched, the most promising of the screening first",
              [](const R& r) {
                Json list = Json::array();
                for (const MotorTrial& t : r.trials) list.push_back(drive_train_json(r.file, t));
                return list;
              },
              schema::listed(drive_train_schema()));
  return description;
}

}  // namespace

Json drive_trains_schema() { return drive_trains_description().schema(); }

}  // namespace described

detail::Json detail::drive_trains_tree(const OptimiseFile& file, const DriveTrainScreen& screen,
                                       std::span<const MotorTrial> trials) {
  return described::drive_trains_description().json({file, screen, trials});
}

std::string json_drive_trains(const OptimiseFile& file, const DriveTrainScreen& screen,
                              std::span<const MotorTrial> trials) {
  return detail::dumped(detail::drive_trains_tree(file, screen, trials));
}

}  // namespace wingbeat
