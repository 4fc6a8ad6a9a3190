#include "wingbeat/run/sweep_summary.hpp"

#include "report/described.hpp"
#include "run/sweep_schema.hpp"

namespace wingbeat {
namespace described {
namespace {

struct SweepFound {
  const Study& study;
  const SweepResult& result;
  const std::string &output, &plot;
};
struct BestDesign {
  const Sweep& sweep;
  SweepBest::Design found;
};

const Description<SweepAxis>& axis_description() {
  using R = SweepAxis;
  static const Description<R> description =
      Description<R>().always("name", "", "", &R::name).always("count", "", "values along it", &R::count);
  return description;
}

Json swept_values(const BestDesign& best) {
  Json values = Json::object();
  const auto place = places(best.sweep, best.found.index);
  for (std::size_t a = 0; a < best.sweep.axes.size(); ++a) {
    const SweepAxis& axis = best.sweep.axes[a];
    for (std::size_t q = 0; q < axis.quantities.size(); ++q) {
      const SweptQuantity& quantity = axis.quantities[q];
      const bool choice = quantity.kind == SweptQuantity::Kind::choice;
      values[quantity.key] = choice ? Json(quantity.labels[place[a]]) : Json(axis.value(q, place[a]));
    }
  }
  return values;
}

Description<BestDesign> best_description(Metric metric) {
  using R = BestDesign;
  return Description<R>()
      .always("index", "", "of the design in the data set", [](const R& r) { return r.found.index; })
      .always(
          metric_info(metric).key, metric_info(metric).unit, metric_info(metric).long_name,
          [](const R& r) { return r.found.value; }, schema::any_number)
      .sometimes(
          "parameters", "", "values of the axes, SI, by key",
          [](const R& r) {
            const Json values = swept_values(r);
            return values.empty() ? std::nullopt : std::optional(values);
          },
          schema::by_name(schema::either({schema::any_number, schema::any_text})));
}

std::optional<std::string> named(const std::string& file) { return file.empty() ? std::nullopt : std::optional(file); }

const Description<SweepFound>& sweep_description() {
  using R = SweepFound;
  const auto best = [](SweepBest SweepDigest::* member) {
    return [member](const R& r) {
      const auto& found = (r.result.digest.*member).design();
      return found ? std::optional<BestDesign>({r.study.sweep, *found}) : std::nullopt;
    };
  };
  static const Description<R> description = [&] {
    Description<R> by_status;
    add_by_status(by_status, "designs", [](const R& r, std::size_t s) { return r.result.digest.designs[s]; });
    return Description<R>()
        .always("title", "", "", [](const R& r) { return named(r.study.title); })
        .always("data_set", "", "the file", [](const R& r) { return r.output; })
        .always("plot", "", "the figure's file", [](const R& r) { return named(r.plot); })
        .always("designs", "", "in all", [](const R& r) { return r.study.sweep.size(); })
        .parts("axes", "", axis_description(), [](const R& r) -> const auto& { return r.study.sweep.axes; })
        .always("computed", "", "designs, this time", [](const R& r) { return r.result.progress.computed; })
        .always("resumed", "", "designs that an earlier run had computed", [](const R& r) { return r.result.resumed; })
        .always(
            "computing_time_s", "s", "", [](const R& r) { return r.result.progress.seconds; }, schema::any_number)
        .always("recomputed", "", "designs that the batched solver left to the scalar one",
                [](const R& r) { return r.result.digest.recomputed; })
        .part("status", "numbers of designs", by_status, std::identity{})
        .part("max_lift_mean", "the design of most mean lift; null where none flaps, and where lift is held",
              best_description(Metric::lift_mean), best(&SweepDigest::lift))
        .part("min_power_electrical", "the design of least electrical power, where lift is held; else null",
              best_description(Metric::power_electrical), best(&SweepDigest::power))
        .part("max_efficiency_system", "the design of most system efficiency; null where none flaps",
              best_description(Metric::efficiency_system), best(&SweepDigest::efficiency));
  }();
  return description;
}

}  // namespace

Json sweep_schema() { return sweep_description().schema(); }

}  // namespace described

std::string json_sweep(const Study& study, const SweepResult& result, const std::string& output,
                       const std::string& plot) {
  return described::sweep_description()
             .json({study, result, output, plot})
             .dump(2, ' ', false, detail::Json::error_handler_t::replace) +
         "\n";
}

}  // namespace wingbeat
