#include "answers.hpp"

#include "report/described.hpp"
#include "report/result_schemas.hpp"
#include "report/run_result.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/files/waveform_file.hpp"
#include "wingbeat/parts/mechanism_pose.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/vehicle/drive.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat::web {
namespace {

using described::Description;

std::optional<std::string> text_if_any(std::string_view text) {
  return text.empty() ? std::nullopt : std::optional<std::string>(text);
}

const Description<Parameter<double>>& key_description() {
  using R = Parameter<double>;
  static const Description<R> description =
      Description<R>()
          .always("key", "", "", &R::path)
          .always("unit", "", "null of texts", [](const R& r) { return text_if_any(r.unit); })
          .always("range", "", "in words", [](const R& r) { return std::string(r.range.text); })
          .always("lower", "", "SI", [](const R& r) { return r.range.lower; })
          .always("upper", "", "SI", [](const R& r) { return r.range.upper; })
          .always("above_lower", "", "the lower limit is left out", [](const R& r) { return r.range.above_lower; })
          .always("below_upper", "", "the upper limit is left out", [](const R& r) { return r.range.below_upper; })
          .always("whole", "", "whole numbers only", [](const R& r) { return r.range.whole; })
          .always("default", "", "", [](const R& r) { return default_text(r); })
          .always("meaning", "", "", &R::meaning)
          .always("only_with", "", "the choice that the key belongs to",
                  [](const R& r) { return text_if_any(r.only_with); })
          .always("alternatives", "", "keys that may be stated in its place",
                  [](const R& r) { return alternatives_of(r); })
          .always("example", "", "", [](const R& r) { return text_if_any(r.example); })
          .always(
              "quantity", "", "an example of a number with the unit",
              [](const R& r) { return r.set ? std::optional<std::string>(quantity_example(r.unit)) : std::nullopt; })
          .always("number", "", "else a text or a choice", [](const R& r) { return r.set != nullptr; });
  return description;
}

/// Metrics and columns of waveforms.
template <class R>
Description<R> quantity_description(const char* R::* key) {
  return Description<R>()
      .always("key", "", "", [key](const R& r) { return std::string(r.*key); })
      .always("unit", "", "", [](const R& r) { return std::string(r.unit); })
      .always("meaning", "", "", [](const R& r) { return std::string(r.long_name); });
}

struct Library {};
const Description<Library>& tables_description() {
  static const Description<Library> description =
      Description<Library>()
          .parts("keys", "of vehicle files", key_description(),
                 [](const Library&) { return parameter_table<double>(); })
          .parts("metrics", "", quantity_description(&MetricInfo::key), [](const Library&) { return metric_table(); })
          .parts("waveforms", "", quantity_description(&WaveformColumn::name),
                 [](const Library&) { return waveform_columns(); });
  return description;
}

const Description<EnergyAudit>& balance_description() {
  using R = EnergyAudit;
  static const Description<R> description = [] {
    Description<R> d;
    const auto power = [&](const char* key, const char* meaning, double R::* member) {
      d.always(key, "W", meaning, member, schema::any_number);
    };
    power("electrical", "input", &R::electrical);
    power("copper", "heat of the winding", &R::copper);
    power("viscous", "viscous loss of the motor", &R::viscous);
    power("motor_friction", "loss by the motor's own friction", &R::motor_friction);
    power("electronics", "loss of the electronics, of a piezo with its dielectric's", &R::electronics);
    power("gear", "loss of the gearbox", &R::gear);
    power("friction", "loss by friction of the mechanism", &R::friction);
    power("hinge", "loss in the hinges of the wings", &R::hinge);
    power("aerodynamic", "to the air", &R::aerodynamic);
    power("residual", "what the formulation fails to conserve", &R::residual);
    power("imbalance", "the input minus all of these", &R::imbalance);
    return d;
  }();
  return description;
}

const Description<StatusEvidence>& evidence_description() {
  using R = StatusEvidence;
  static const Description<R> description =
      Description<R>()
          .always("angle_rad", "rad", "crank angle of what shows the status", &R::angle)
          .always("torque_nm", "N m", "of the motor there", &R::torque)
          .always("friction_torque_nm", "N m", "that friction can hold there", &R::friction_torque)
          .always("torque_margin_nm", "N m", "the one less the other", &R::torque_margin)
          .always(
              "locks_rad", "rad", "intervals of the crank angle in which friction locks it",
              [](const R& r) {
                Json locks = Json::array();
                for (const LockInterval& lock : r.locks) locks.push_back({lock.from, lock.to});
                return locks;
              },
              schema::listed(schema::pair_of(schema::any_number)));
  return description;
}

const Description<RunResult>& solved_description() {
  using R = RunResult;
  static const Description<R> description =
      Description<R>()
          .part("report", "as wingbeat run --json", described::run_description(),
                [](const R& r) -> const R& { return r; })
          .part("balance", "mean powers of a cycle", balance_description(),
                [](const R& r) { return energy_audit(r.metrics); })
          .part("evidence", "", evidence_description(), &R::evidence)
          .always("reached", "", "false: it flaps, but the frequency or lift asked for is out of reach",
                  [](const R& r) { return !r.search || r.search->outcome == FrequencyOutcome::reached; })
          .always("supply_voltage", "V", "", [](const R& r) { return r.design.supply.voltage; });
  return description;
}

const Description<TransientResult>& start_up_description() {
  using R = TransientResult;
  static const Description<R> description =
      Description<R>()
          .always("status", "", "", [](const R& r) { return name_of(r.status); })
          .always("detail", "", "a sentence with the evidence", [](const R& r) { return describe(r.evidence); })
          .always("end_time", "s", "time simulated", &R::end_time, schema::any_number)
          .part("evidence", "", evidence_description(), &R::evidence);
  return description;
}

const Description<MechanismPose::Joint>& joint_description() {
  using R = MechanismPose::Joint;
  static const Description<R> description =
      Description<R>()
          .always("name", "", "its places are the columns NAME_x and NAME_y", &R::name)
          .always("fixed", "", "to the ground", &R::fixed);
  return description;
}

const Description<MechanismPose::Link>& link_description() {
  using R = MechanismPose::Link;
  static const Description<R> description = Description<R>()
                                                .always("role", "", "", &R::role)
                                                .always("from", "", "a joint", &R::from)
                                                .always("to", "", "a joint", &R::to);
  return description;
}

const Description<Vehicle<double>>& mechanism_description() {
  using R = Vehicle<double>;
  const auto pose = [](const R& r) { return pose_of(r.transmission, 0.0, 0.0, drawn_wing_length(r.transmission)); };
  static const Description<R> description =
      Description<R>()
          .always("type", "", "", [](const R& r) { return r.transmission.type; })
          .always("rotates", "", "a crank turns", [](const R& r) { return drive_of(r).rotates; })
          .always("springs", "", "", [](const R& r) { return r.spring.stiffness > 0.0; })
          .always("pitch_hinge", "", "wings pitch on hinges", [](const R& r) { return pitches(r); })
          .always(
              "wing_count", "", "", [](const R& r) { return r.wing_count; }, schema::any_count)
          .parts("joints", "", joint_description(), [pose](const R& r) { return pose(r).joints; })
          .parts("links", "in the order in which they are drawn", link_description(),
                 [pose](const R& r) { return pose(r).links; });
  return description;
}

const Description<Slopes>& slopes_description() {
  static const Description<Slopes> description =
      Description<Slopes>()
          .always("status", "", "", &Slopes::status)
          .always("detail", "", "a sentence with the evidence", &Slopes::detail)
          .always("gradients", "", "of all metrics by each key, SI per SI; null where there are none", &Slopes::by_key);
  return description;
}

const Description<OfferedMotor>& motor_description() {
  static const Description<OfferedMotor> description =
      Description<OfferedMotor>()
          .always("model", "", "", &OfferedMotor::model)
          .always("refused", "", "why it cannot be tried", &OfferedMotor::refused)
          .always("values", "", "of its keys, SI", &OfferedMotor::values, schema::by_name(schema::any_number));
  return description;
}

}  // namespace

Json tables_of_the_library() { return tables_description().json({}); }
Json solved_answer(const RunResult& result) { return solved_description().json(result); }
Json start_up_answer(const TransientResult& result) { return start_up_description().json(result); }
Json mechanism_answer(const Vehicle<double>& vehicle) { return mechanism_description().json(vehicle); }
Json slopes_answer(const Slopes& slopes) { return slopes_description().json(slopes); }
Json motors_answer(const std::vector<OfferedMotor>& motors) { return {{"motors", motor_description().list(motors)}}; }

Json answer_schemas() {
  return {{"Key", key_description().schema()},
          {"Quantity", quantity_description(&MetricInfo::key).schema()},
          {"Report", described::run_schema()},
          {"Balance", balance_description().schema()},
          {"Evidence", evidence_description().schema()},
          {"Tables", tables_description().schema()},
          {"Solved", solved_description().schema()},
          {"StartUp", start_up_description().schema()},
          {"Mechanism", mechanism_description().schema()},
          {"Gradients", slopes_description().schema()},
          {"Motor", motor_description().schema()},
          {"Problem", problem_schema()}};
}

}  // namespace wingbeat::web
