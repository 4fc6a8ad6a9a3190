#include "wingbeat/report/scaling_report.hpp"

#include <fmt/format.h>

#include "report/described.hpp"
#include "report/report_tools.hpp"
#include "report/result_schemas.hpp"

namespace wingbeat {
namespace {

struct Scaling {
  const ScaledDesign& scaled;
  double factor;
};

}  // namespace

std::string text_scaling(const ScaledDesign& scaled, double factor) {
  std::string text = fmt::format("{:<36}{:>14}{:>14}  {:<12}{}\n", "Number", "before", "after", "unit",
                                 fmt::format("factor {:g} to the", factor));
  for (const ScaledParameter& p : scaled.parameters) {
    const detail::ShownUnit shown = detail::shown_unit(p.unit);
    text += fmt::format("{:<36}{:>14.6g}{:>14.6g}  {:<12}{}\n", p.key, shown.factor * p.before, shown.factor * p.after,
                        shown.name, p.exponent);
  }
  if (scaled.chords) text += fmt::format("{:<78}{}\n", "wing.planform.chords, every radius and chord", 1);
  return text;
}

namespace described {
namespace {

const Description<ScaledParameter>& parameter_description() {
  using R = ScaledParameter;
  static const Description<R> description =
      Description<R>()
          .always("key", "", "of the vehicle file", &R::key)
          .always("unit", "", "", &R::unit)
          .always("before", "", "SI", &R::before)
          .always("after", "", "SI", &R::after)
          .always("exponent", "", "of the factor", [](const R& r) { return double(r.exponent); });
  return description;
}

const Description<Scaling>& scaling_description() {
  static const Description<Scaling> description =
      Description<Scaling>()
          .always("factor", "1", "of all lengths", [](const Scaling& s) { return s.factor; })
          .always("chords", "", "radii and chords of a tabulated outline grow with the factor, too",
                  [](const Scaling& s) { return s.scaled.chords; })
          .parts("parameters", "numbers that change", parameter_description(),
                 [](const Scaling& s) { return s.scaled.parameters; });
  return description;
}

}  // namespace

Json scaling_schema() { return scaling_description().schema(); }

}  // namespace described

std::string json_scaling(const ScaledDesign& scaled, double factor) {
  return detail::dumped(described::scaling_description().json({scaled, factor}));
}

}  // namespace wingbeat
