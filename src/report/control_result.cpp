// What the --json of linearise has: linear models, static maps, derivatives by the body's motion.
#include "report/control_result.hpp"

#include <fmt/format.h>

#include "report/control_tree.hpp"
#include "report/described.hpp"
#include "report/result_schemas.hpp"
#include "wingbeat/report/control_report.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/allocation.hpp"
#include "wingbeat/study/body_derivatives.hpp"

namespace wingbeat {
namespace described {

template <>
struct Form<Eigen::MatrixXd> {
  static Json schema() { return schema::listed(schema::listed(schema::number_if_any)); }
  static Json json(const Eigen::MatrixXd& m) {
    Json rows = Json::array();
    for (Eigen::Index r = 0; r < m.rows(); ++r) {
      Json row = Json::array();
      for (Eigen::Index c = 0; c < m.cols(); ++c) row.push_back(detail::number_or_null(m(r, c)));
      rows.push_back(std::move(row));
    }
    return rows;
  }
};

namespace {

const Description<CycleSignal>& signal_description() {
  using R = CycleSignal;
  static const Description<R> description = Description<R>()
                                                .always("name", "", "", &R::name)
                                                .always("unit", "", "", &R::unit)
                                                .always("value", "", "at the operating point", &R::value);
  return description;
}

const Description<CycleMode>& mode_description() {
  using R = CycleMode;
  static const Description<R> description =
      Description<R>()
          .always(
              "multiplier_real", "1", "Floquet multiplier, real part", [](const R& r) { return r.multiplier.real(); },
              schema::any_number)
          .always(
              "multiplier_imaginary", "1", "imaginary part", [](const R& r) { return r.multiplier.imag(); },
              schema::any_number)
          .always("time_constant_s", "s", "", &R::time_constant)
          .always("natural_frequency_rad_per_s", "rad/s", "", &R::natural_frequency)
          .always("damping_ratio", "1", "", &R::damping_ratio)
          .always("settled", "", "it has decayed within a cycle", &R::settled);
  return description;
}

template <class Model>
void add_matrices(Description<Model>& d) {
  d.always("A", "", "states by states", &Model::a)
      .always("B", "", "states by inputs", &Model::b)
      .always("C", "", "outputs by states", &Model::c)
      .always("D", "", "outputs by inputs", &Model::d);
}

Description<ContinuousModel> continuous_description() {
  Description<ContinuousModel> d;
  d.parts("states", "of the model in time", signal_description(), &ContinuousModel::states);
  add_matrices(d);
  return d;
}

Json step_responses(const LinearModel& model) {
  Json responses = Json::object();
  for (std::size_t input = 0; input < model.map.inputs.size(); ++input) {
    Json outputs = Json::object();
    const Eigen::MatrixXd& response = model.step_responses[input];
    for (std::size_t k = 0; k < model.map.outputs.size(); ++k) {
      Json column = Json::array();
      for (const double y : response.col(Eigen::Index(k))) column.push_back(detail::number_or_null(y));
      outputs[model.map.outputs[k].name] = std::move(column);
    }
    responses[model.map.inputs[input].name] = std::move(outputs);
  }
  return responses;
}

Description<CycleMap> map_matrices_description() {
  Description<CycleMap> d;
  add_matrices(d);
  return d;
}

const Description<LinearModel>& linear_model_description() {
  using R = LinearModel;
  const auto of_map = [](auto member) { return [member](const R& r) { return r.map.*member; }; };
  static const Description<R> description =
      Description<R>()
          .always("period_s", "s", "of the cycle", of_map(&CycleMap::period), schema::any_number)
          .parts("states", "at the start of a cycle", signal_description(), of_map(&CycleMap::states))
          .parts("inputs", "", signal_description(), of_map(&CycleMap::inputs))
          .parts("outputs", "means of a cycle", signal_description(), of_map(&CycleMap::outputs))
          .all_of(map_matrices_description(), &R::map)
          .always("steady_gain", "", "outputs by inputs, settled", &R::steady_gain)
          .parts("modes", "", mode_description(), &R::modes)
          .part("continuous", "the model in time", continuous_description(), &R::continuous)
          .always("step_responses", "", "to a unit step: input, output, one value for each cycle", &step_responses,
                  schema::by_name(schema::by_name(schema::listed(schema::number_if_any))));
  return description;
}

const Description<AllocationPoint>& slope_description() {
  using R = AllocationPoint;
  static const Description<R> description = [] {
    Description<R> d;
    d.always("at", "", "the input there", &R::input);
    for (const AllocationColumn& c : allocation_columns) {
      d.always(c.name, "", fmt::format("derivative of the {} [{} per unit of the input]", c.meaning, c.unit), c.member);
    }
    return d;
  }();
  return description;
}

}  // namespace

const Description<AllocationMap>& allocation_description() {
  using R = AllocationMap;
  const auto column = [](double AllocationPoint::* member) {
    return [member](const R& r) {
      std::vector<double> values;
      for (const AllocationPoint& p : r.points) values.push_back(p.*member);
      return values;
    };
  };
  static const Description<R> description = [&] {
    Description<R> d;
    d.always("input", "", "", &R::input)
        .always("unit", "", "of the input", [](const R& r) { return unit_of(r.input); })
        .always("values", "", "of the input", column(&AllocationPoint::input));
    for (const AllocationColumn& c : allocation_columns) d.always(c.name, c.unit, c.meaning, column(c.member));
    for (const AllocationSlope& s : allocation_slopes) d.part(s.name, s.meaning, slope_description(), s.member);
    return d;
  }();
  return description;
}

namespace {

const Description<BodyDerivatives>& body_description() {
  using R = BodyDerivatives;
  static const Description<R> description = [] {
    Description<R> d;
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < 6; ++column) {
        const char *load = body_loads[std::size_t(row)], *motion = body_motions[std::size_t(column)];
        d.always(fmt::format("{}_{}", load, motion), "", "",
                 [row, column](const R& r) { return double(r(row, column)); });
      }
    }
    return d;
  }();
  return description;
}

struct ControlFound {
  const ControlModels& models;
  const std::string& version;
  const RunResult& run() const { return models.linear.operating_point; }
  bool found() const { return models.linear.model.has_value(); }
};

const Description<ControlFound>& control_description() {
  using R = ControlFound;
  const auto metric = [](Metric m) { return [m](const R& r) { return r.run().metrics[m]; }; };
  static const Description<R> description =
      Description<R>()
          .always("written_by", "", "",
                  [](const R& r) { return fmt::format("Written by wingbeat {} linearise", r.version); })
          .always("vehicle", "", "", [](const R& r) { return r.run().design.name; })
          .always("condition", "", "",
                  [](const R& r) { return std::string(name_of(r.models.options.operating_point.condition)); })
          .always(
              "status", "", "", [](const R& r) { return Json(name_of(r.run().status)); }, schema::statuses())
          .always("status_detail", "", "a sentence with the evidence", [](const R& r) { return describe(r.run()); })
          .always("domain", "", "inside, or the limits that are exceeded",
                  [](const R& r) { return std::string(name_of(r.run().domain)); })
          .always("voltage_v", "V", "of the operating point", metric(Metric::voltage))
          .always("frequency_hz", "Hz", "of the operating point", metric(Metric::frequency))
          .always("lift_mean_n", "N", "of the operating point", metric(Metric::lift_mean))
          .part("model", "from cycle to cycle; null where there is no cycle", linear_model_description(),
                [](const R& r) { return r.models.linear.model ? &*r.models.linear.model : nullptr; })
          .sometimes(
              "static_maps", "", "for control allocation",
              [](const R& r) {
                return r.found() ? std::optional(allocation_description().list(r.models.maps)) : std::nullopt;
              },
              schema::listed(allocation_description().schema()))
          .sometimes(
              "hinge_offset_m", "m", "of the stroke axes from the middle of the body",
              [](const R& r) { return r.found() ? std::optional(r.models.options.hinge_offset) : std::nullopt; },
              schema::any_number)
          .sometimes_part(
              "body_derivatives", "cycle-averaged loads by the body's motion, SI; axes forward, right, down",
              body_description(), [](const R& r) { return r.found() && r.models.body ? &*r.models.body : nullptr; });
  return description;
}

}  // namespace

Json control_schema() { return control_description().schema(); }

}  // namespace described

detail::Json detail::control_tree(const ControlModels& models, const std::string& version) {
  return described::control_description().json({models, version});
}

std::string json_control(const ControlModels& models, const std::string& version) {
  return detail::dumped(detail::control_tree(models, version));
}

}  // namespace wingbeat
