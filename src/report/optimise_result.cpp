// What the --json of optimise has: one optimum, one for each motor or choice, or a front.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "report/described.hpp"
#include "report/result_schemas.hpp"
#include "report/result_trees.hpp"
#include "report/trial_result.hpp"
#include "report/vehicle_counts.hpp"
#include "wingbeat/report/optimise_report.hpp"
#include "wingbeat/report/pareto_report.hpp"

namespace wingbeat {
namespace described {
namespace {

/// An optimum with the study that it is of.
struct OptimumFound {
  OptimiseStudy study;
  const OptimiseResult& result;
  bool found() const { return result.outcome == OptimiseResult::Outcome::found; }
};
struct FrontFound {
  const OptimiseFile& file;
  const ParetoStudy& study;
  const ParetoResult& result;
  bool found() const { return result.outcome == ParetoResult::Outcome::found; }
};

template <class Outcome>
const char* outcome_name(Outcome outcome) {
  return outcome == Outcome::found ? "found" : outcome == Outcome::infeasible ? "infeasible" : "nothing_flaps";
}
Json outcomes() { return schema::one_of({"found", "infeasible", "nothing_flaps"}); }

const Description<ScreenCounts>& screened_description() {
  using R = ScreenCounts;
  static const Description<R> description = [] {
    Description<R> d;
    add_by_status(d, "designs screened", [](const R& r, std::size_t s) { return r.status[s]; });
    return d.always("feasible", "", "flapping, inside the domain and within every constraint", &R::feasible)
        .always("outside_domain", "", "flapping outside the domain, where that does not count", &R::outside);
  }();
  return description;
}

const Description<ActiveLimit>& active_description() {
  using R = ActiveLimit;
  static const Description<R> description =
      Description<R>()
          .always("limit", "", "constraint or bound that limits the optimum", &R::name)
          .always("sensitivity", "1", "relative loss for a relative tightening of the limit", &R::sensitivity);
  return description;
}

const Description<FlatDirection>& direction_description() {
  using R = FlatDirection;
  const Json numbers = schema::listed(schema::any_number);
  static const Description<R> description =
      Description<R>()
          .always("flat", "", "a bound ends it, or its width exceeds half the bounds", &R::flat)
          .always("width", "1", "largest share of a parameter's bounds that it covers", &R::width, schema::any_number)
          .always("curvature", "1", "of the objective along it, relative, per squared range of the bounds",
                  &R::curvature)
          .always("from", "", "parameters at one end", &R::from, numbers)
          .always("to", "", "parameters at the other end", &R::to, numbers);
  return description;
}

const Description<OptimiseResult>& starts_description() {
  using R = OptimiseResult;
  static const Description<R> description = Description<R>()
                                                .always("all", "", "starts of a local search", &R::starts)
                                                .always("same", "", "ended in this optimum", &R::same)
                                                .always("elsewhere", "", "ended in a worse one", &R::elsewhere)
                                                .always("failed", "", "without a result", &R::failed);
  return description;
}

/// A value of an optimum that was found, else nothing.
template <class Value>
auto of_the_optimum(Value value) {
  using V = std::remove_cvref_t<std::invoke_result_t<Value, const OptimumFound&>>;
  return [value](const OptimumFound& r) { return r.found() ? std::optional<V>(value(r)) : std::nullopt; };
}

Json values_by_key(const std::vector<std::string>& keys, const std::vector<double>& values) {
  Json all = Json::object();
  for (std::size_t k = 0; k < keys.size(); ++k) all[keys[k]] = values[k];
  return all;
}
std::vector<std::string> keys_of(const OptimiseStudy& study) {
  std::vector<std::string> keys;
  for (const OptimisedParameter& p : study.parameters) keys.push_back(p.parameter.key);
  return keys;
}
std::vector<std::string> keys_of(const ParetoStudy& study) {
  std::vector<std::string> keys;
  for (const OptimisedParameter& p : study.parameters) keys.push_back(p.parameter.key);
  for (const DiscreteParameter& p : study.choices) keys.push_back(p.parameter.key);
  return keys;
}

const Description<GearTorque>& gear_torque_description() {
  using R = GearTorque;
  static const Description<R> description =
      Description<R>().always("rms", "N m", "", &R::rms).always("peak", "N m", "largest magnitude", &R::peak);
  return description;
}

/// `drive_train`: of parts from lists, with the torque behind their gearbox.
Description<OptimumFound> made_optimum_description(bool drive_train) {
  using R = OptimumFound;
  const auto result = [](const R& r) { return r.found() ? &r.result : nullptr; };
  Description<R> description =
      Description<R>()
          .always(
              "outcome", "", "", [](const R& r) { return Json(outcome_name(r.result.outcome)); }, outcomes())
          .always("objective", "", "", [](const R& r) { return r.study.objective; })
          .always("maximise", "", "", [](const R& r) { return r.study.maximise; })
          .part("screened", "designs of the screening", screened_description(),
                [](const R& r) -> const ScreenCounts& { return r.result.screen; })
          .always("allow_extrapolation", "", "designs outside the model's domain count",
                  [](const R& r) { return r.study.allow_extrapolation; })
          .always("reason", "", "why nothing was found",
                  [](const R& r) {
                    return r.found() ? std::nullopt : std::optional(describe(nothing_found(r.study, r.result)));
                  })
          .always("domain", "", "inside, or the limits that are exceeded",
                  of_the_optimum([](const R& r) { return std::string(name_of(r.result.point.domain)); }))
          .always("limited_by_domain", "", "a limit of the model's domain is active at the optimum",
                  of_the_optimum([](const R& r) {
                    return std::any_of(r.result.active.begin(), r.result.active.end(),
                                       [](const ActiveLimit& a) { return a.domain; });
                  }))
          .always("value", "", "of the objective; the metric's unit",
                  of_the_optimum([](const R& r) { return r.result.point.metrics[r.study.objective]; }))
          .always(
              "parameters", "", "of the optimum, SI, by key",
              [](const R& r) {
                if (!r.found() || r.study.parameters.empty()) return Json(nullptr);
                return values_by_key(keys_of(r.study), r.result.parameters);
              },
              schema::or_null(schema::by_name(schema::any_number)))
          .part("metrics", "of the optimum", metrics_description(),
                [](const R& r) { return r.found() ? &r.result.point.metrics : nullptr; })
          .always(
              "active", "", "active constraints and bounds",
              [](const R& r) { return r.found() ? active_description().list(r.result.active) : Json(nullptr); },
              schema::or_null(schema::listed(active_description().schema())))
          .always(
              "directions", "", "how far the design can move until the objective is 0.1 % worse, flattest first",
              [](const R& r) { return r.found() ? direction_description().list(r.result.directions) : Json(nullptr); },
              schema::or_null(schema::listed(direction_description().schema())))
          .part("starts", "starts of local searches by where they ended", starts_description(), result)
          .always("evaluations", "", "cycles computed with gradients",
                  of_the_optimum([](const R& r) { return r.result.evaluations; }));
  if (!drive_train) return description;
  return description.sometimes_part("gear_torque", "behind the gearbox of one motor, where that has limits",
                                    gear_torque_description(), [](const R& r) {
                                      const GearTorque& torque = r.result.point.gear_torque;
                                      return r.found() && std::isfinite(torque.rms) ? &torque : nullptr;
                                    });
}

const Description<OptimumFound>& optimum_description() {
  static const Description<OptimumFound> description = made_optimum_description(false);
  return description;
}

// ---- a catalogue of motors, or choices

struct TrialFound {
  const OptimiseFile& file;
  const MotorTrial& trial;
};
struct TrialsFound {
  const OptimiseFile& file;
  std::span<const MotorTrial> trials;
};

void add_model(Description<TrialFound>& d) {
  d.always("model", "", "the motor's; null of a choice", [](const TrialFound& r) {
    return r.trial.motor ? std::optional<std::string>(r.trial.motor->model) : std::nullopt;
  });
}
const Description<TrialFound>& refused_trial_description() {
  static const Description<TrialFound> description = [] {
    Description<TrialFound> d;
    add_model(d);
    return d.always("refused", "", "why the motor cannot be used",
                    [](const TrialFound& r) { return r.trial.motor->refused; });
  }();
  return description;
}
Description<TrialFound> made_trial_description(bool drive_train) {
  using R = TrialFound;
  Description<R> d;
  add_model(d);
  if (drive_train) {
    const auto name_of_part = [](const auto* part) {
      return part ? std::optional<std::string>(part->model) : std::nullopt;
    };
    d.sometimes("gearbox", "", "of a list", [name_of_part](const R& r) {
       return name_of_part(r.trial.gearbox);
     }).sometimes("battery", "", "of a list", [name_of_part](const R& r) { return name_of_part(r.trial.battery); });
  }
  return d
      .sometimes(
          "choices", "", "values of the discrete parameters, by key",
          [](const R& r) {
            Json choices = Json::object();
            for (std::size_t k = 0; k < r.file.choices.size(); ++k) {
              choices[r.file.choices[k].parameter.key] = r.trial.choices[k];
            }
            return choices.empty() ? std::nullopt : std::optional(choices);
          },
          schema::by_name(Json(true)))
      .part("result", "the optimum with it", made_optimum_description(drive_train),
            [](const R& r) { return OptimumFound{trial_study(r.file, r.trial), r.trial.result}; });
}

const Description<TrialFound>& trial_description() {
  static const Description<TrialFound> description = made_trial_description(false);
  return description;
}
const Description<TrialFound>& drive_train_description() {
  static const Description<TrialFound> description = made_trial_description(true);
  return description;
}

const Description<TrialsFound>& trials_description() {
  using R = TrialsFound;
  const auto trials = [](const R& r) {
    Json list = Json::array();
    for (const MotorTrial& t : r.trials) {
      list.push_back((t.refused() ? refused_trial_description() : trial_description()).json({r.file, t}));
    }
    return list;
  };
  const auto where = [trials](bool motors) {
    return [trials, motors](const R& r) {
      return r.file.motors.empty() != motors ? std::optional(trials(r)) : std::nullopt;
    };
  };
  // Motors alone are refused.
  const Json choices = schema::listed(trial_description().schema()),
             motors =
                 schema::listed(schema::either({refused_trial_description().schema(), trial_description().schema()}));
  static const Description<R> description =
      Description<R>()
          .always("best", "", "the best motor or choice; null where none does it",
                  [](const R& r) {
                    const MotorTrial* best = best_trial(r.file, r.trials);
                    return best ? std::optional<std::string>(name_of(r.file, *best)) : std::nullopt;
                  })
          .sometimes("choices", "", "each combination of the discrete parameters", where(false), choices)
          .sometimes("motors", "", "each motor of the catalogue", where(true), motors);
  return description;
}

// ---- fronts

const Description<ParetoObjective>& objective_description() {
  using R = ParetoObjective;
  static const Description<R> description =
      Description<R>().always("metric", "", "", &R::metric).always("maximise", "", "", &R::maximise);
  return description;
}

struct CountedMotor {
  std::string model;
  VehicleCount count;
};
const Description<CountedMotor>& counted_motor_description() {
  using R = CountedMotor;
  static const Description<R> description =
      Description<R>()
          .always("model", "", "", &R::model)
          .always("solved", "", "designs with this motor", [](const R& r) { return r.count.solved; })
          .always("flap", "", "of these", [](const R& r) { return r.count.flap; })
          .always("feasible", "", "flapping, inside the domain and within every constraint",
                  [](const R& r) { return r.count.feasible; })
          .always("front", "", "on the front", [](const R& r) { return r.count.front; });
  return description;
}
const Description<MotorCandidate>& refused_motor_description() {
  using R = MotorCandidate;
  static const Description<R> description = Description<R>()
                                                .always("model", "", "", &R::model)
                                                .always("refused", "", "why the motor cannot be used", &R::refused);
  return description;
}

struct FrontDesign {
  const ParetoStudy& study;
  const ParetoDesign& design;
};
const Description<FrontDesign>& front_design_description() {
  using R = FrontDesign;
  static const Description<R> description =
      Description<R>()
          .sometimes("motor", "", "of a catalogue",
                     [](const R& r) {
                       const std::string& name = r.study.vehicles[r.design.vehicle].name;
                       return name.empty() ? std::nullopt : std::optional(name);
                     })
          .always(
              "parameters", "", "SI, by key",
              [](const R& r) { return values_by_key(keys_of(r.study), r.design.parameters); },
              schema::by_name(schema::any_number))
          .part("metrics", "", metrics_description(),
                [](const R& r) -> const Metrics<double>& { return r.design.metrics; })
          .always("domain", "", "inside, or the limits that are exceeded",
                  [](const R& r) { return std::string(name_of(r.design.domain)); });
  return description;
}

Json front_motors(const FrontFound& r) {
  Json list = Json::array();
  const std::vector<VehicleCount> counts = count_vehicles(r.study, r.result);
  for (std::size_t v = 0; v < counts.size(); ++v) {
    list.push_back(counted_motor_description().json({r.study.vehicles[v].name, counts[v]}));
  }
  for (const MotorCandidate& motor : r.file.motors) {
    if (!motor.refused.empty()) list.push_back(refused_motor_description().json(motor));
  }
  return list;
}

/// Of a front that was found.
template <class Value>
auto of_the_front(Value value) {
  using V = std::remove_cvref_t<std::invoke_result_t<Value, const FrontFound&>>;
  return [value](const FrontFound& r) { return r.found() ? std::optional<V>(value(r)) : std::nullopt; };
}

const Description<FrontFound>& front_description() {
  using R = FrontFound;
  static const Description<R> description =
      Description<R>()
          .always(
              "outcome", "", "", [](const R& r) { return Json(outcome_name(r.result.outcome)); }, outcomes())
          .parts("objectives", "", objective_description(), [](const R& r) { return r.study.objectives; })
          .always("method", "", "of the search", [](const R& r) { return r.study.evolution.method; })
          .always("population", "", "designs in a generation", [](const R& r) { return r.study.evolution.population; })
          .always("generations", "", "", [](const R& r) { return r.study.evolution.generations; })
          .part("screened", "designs of the screening", screened_description(),
                [](const R& r) -> const ScreenCounts& { return r.result.screen; })
          .always("allow_extrapolation", "", "designs outside the model's domain count",
                  [](const R& r) { return r.study.allow_extrapolation; })
          .sometimes(
              "motors", "", "each motor of the catalogue",
              [](const R& r) { return r.file.motors.empty() ? std::nullopt : std::optional(front_motors(r)); },
              schema::listed(
                  schema::either({counted_motor_description().schema(), refused_motor_description().schema()})))
          .sometimes("reason", "", "why nothing was found",
                     [](const R& r) {
                       return r.found() ? std::nullopt : std::optional(describe(nothing_found(r.study, r.result)));
                     })
          .sometimes("evaluations", "", "designs solved",
                     of_the_front([](const R& r) { return r.result.evaluated.size(); }))
          .sometimes("reference", "", "of the hypervolume, SI, by objective", of_the_front([](const R& r) {
                       Json reference = Json::object();
                       for (std::size_t m = 0; m < r.study.objectives.size(); ++m) {
                         reference[metric_info(r.study.objectives[m].metric).key] = r.result.reference[m];
                       }
                       return reference;
                     }),
                     schema::by_name(schema::any_number))
          .sometimes("hypervolume", "", "product of the objectives' units",
                     of_the_front([](const R& r) { return r.result.hypervolume; }), schema::any_number)
          .sometimes("hypervolume_history", "", "after the screening and after each generation",
                     of_the_front([](const R& r) { return r.result.history; }), schema::listed(schema::any_number))
          .sometimes("picks", "", "designs of the front by name: places in `front`, from 0",
                     of_the_front([](const R& r) { return named_picks(r.study, r.result); }))
          .sometimes("front", "", "by the first objective, best first", of_the_front([](const R& r) {
                       Json list = Json::array();
                       for (const ParetoDesign& d : r.result.front) {
                         list.push_back(front_design_description().json({r.study, d}));
                       }
                       return list;
                     }),
                     schema::listed(front_design_description().schema()));
  return description;
}

}  // namespace

Json optimum_schema() { return optimum_description().schema(); }
Json motors_schema() { return trials_description().schema(); }
Json drive_train_schema() { return drive_train_description().schema(); }
Json drive_train_json(const OptimiseFile& file, const MotorTrial& trial) {
  return drive_train_description().json({file, trial});
}
Json front_schema() { return front_description().schema(); }

}  // namespace described

detail::Json detail::optimum_tree(const OptimiseFile& file, const OptimiseResult& result) {
  return described::optimum_description().json({file.study, result});
}

std::string json_optimum(const OptimiseFile& file, const OptimiseResult& result) {
  return detail::dumped(detail::optimum_tree(file, result));
}

detail::Json detail::motors_tree(const OptimiseFile& file, std::span<const MotorTrial> trials) {
  return described::trials_description().json({file, trials});
}

std::string json_motors(const OptimiseFile& file, std::span<const MotorTrial> trials) {
  return detail::dumped(detail::motors_tree(file, trials));
}

detail::Json detail::front_tree(const OptimiseFile& file, const ParetoStudy& study, const ParetoResult& result) {
  return described::front_description().json({file, study, result});
}

std::string json_front(const OptimiseFile& file, const ParetoStudy& study, const ParetoResult& result) {
  return detail::dumped(detail::front_tree(file, study, result));
}

}  // namespace wingbeat
