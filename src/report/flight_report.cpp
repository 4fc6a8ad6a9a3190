#include "wingbeat/report/flight_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/described.hpp"
#include "report/report_tools.hpp"
#include "report/result_schemas.hpp"

namespace wingbeat {
namespace {

double endurance_of(const TrimReport& report, const TrimResult& t) {
  return t.status == TrimStatus::trimmed ? report.battery_energy / t.power : absent;
}
double range_of(const TrimReport& report, const TrimResult& t) { return t.condition.speed * endurance_of(report, t); }

/// Without what is rounding.
double cleared(double x) { return std::abs(x) < 1e-9 ? 0.0 : x; }

std::string time_text(double seconds) { return std::isfinite(seconds) ? fmt::format("{:.4g}", seconds) : "-"; }

/// "grows twofold in 0.16 s" or "halves in 0.07 s".
std::string growth_text(std::complex<double> s) {
  const double time = FlightMode::doubling_time(s);
  return s.real() > 0.0 ? fmt::format("doubles in {:.3g} s", time) : fmt::format("halves in {:.3g} s", -time);
}

std::string number_text(std::complex<double> s) {
  return s.imag() == 0.0 ? fmt::format("{:10.4f}", s.real())
                         : fmt::format("{:10.4f} ± {:.4f} i", s.real(), std::abs(s.imag()));
}

/// Standard deviation of the real part of the least stable mode over the relative one of all parameters, to first
/// order, where these scatter independently [1/s].
double scatter_of(const StabilityReport& report) {
  double sum = 0.0;
  for (const ModeSensitivity& s : report.sensitivities) sum += square(s.slope);
  return report.sensitivities.empty() ? absent : std::sqrt(sum);
}

/// The trim of the whole flight beside that of the averaged one.
std::string periodic_text(const StabilityReport& report) {
  const PeriodicFlight& p = *report.result.periodic;
  const FlightControls& averaged = report.result.trim.controls;
  std::string text = fmt::format(
      "\nThe whole flight, in which the body shakes with the wingbeat, drifts at the controls above by {:.3g} m/s "
      "ahead and\n{:.3g} m/s downwards; it is in trim at",
      cleared(p.drift[0]), cleared(p.drift[1]));
  for (std::size_t k = 0; k < flight_control_count; ++k) {
    if (averaged.at[k] == p.controls.at[k]) continue;
    const bool angle = std::string_view(flight_control_units[k]) == "rad";
    const double factor = angle ? degrees_per_radian : 1.0;
    text +=
        fmt::format(" {} {:.5g} {} (averaged {:.5g}),", name_of(FlightControl(k)), cleared(factor * p.controls.at[k]),
                    angle ? "deg" : flight_control_units[k], cleared(factor * averaged.at[k]));
  }
  return text + fmt::format(" pitch {:.4g} deg\n", cleared(degrees_per_radian * p.mean[7]));
}

}  // namespace

double usable_energy(const Battery<double>& battery) {
  constexpr int parts = 200;
  double mean = 0.0;
  for (int n = 0; n < parts; ++n) mean += open_circuit_voltage(battery, battery.charge * (n + 0.5) / parts) / parts;
  return battery.capacity * battery.charge * mean;
}

std::string text_trim(const FlightVehicle& vehicle, const TrimReport& report) {
  std::string text;
  const bool several = report.flights.size() > 1;
  if (!several) {
    const TrimResult& t = report.flights.front();
    text += fmt::format("{}\n  {}: {}\n", report.vehicle, name_of(t.status), t.detail);
    if (!t.flies()) return text;
    text += fmt::format("  {:<34}{:>12.5g} m/s, climb {:.4g} m/s, turn {:.4g} rad/s\n", "speed", t.condition.speed,
                        t.condition.climb, t.condition.turn_rate);
    text += fmt::format("  {:<34}{:>12.5g} deg\n", "pitch attitude, nose up", cleared(degrees_per_radian * t.pitch));
    if (t.roll != 0.0)
      text += fmt::format("  {:<34}{:>12.5g} deg\n", "roll, right wing down", degrees_per_radian * t.roll);
    for (std::size_t k = 0; k < flight_control_count; ++k) {
      if (!vehicle.ranges[k].given()) continue;
      const bool angle = std::string_view(flight_control_units[k]) == "rad";
      const double factor = angle ? degrees_per_radian : 1.0;
      text += fmt::format("  {:<34}{:>12.5g} {:<4} of {:.4g} to {:.4g}\n", name_of(FlightControl(k)),
                          cleared(factor * t.controls.at[k]), angle ? "deg" : flight_control_units[k],
                          factor * vehicle.ranges[k].low, factor * vehicle.ranges[k].high);
    }
    text += fmt::format("  {:<34}{:>12.5g} Hz\n  {:<34}{:>12.5g} W\n", "flapping frequency", t.frequency,
                        "electrical power at the terminals", t.power);
    if (std::isfinite(report.battery_energy)) {
      text += fmt::format("  {:<34}{:>12.5g} s\n", "endurance by the battery's energy", endurance_of(report, t));
    }
    return text;
  }
  const std::optional<FlightControl> of_pitch = pitch_control(vehicle);
  text += fmt::format("{}\n{:>9} {:>8} {:>9} {:>10} {:>9} {:>9} {:>10} {:>9}  {}\n", report.vehicle, "speed", "climb",
                      "pitch", "voltage", "control", "power", "endurance", "range", "status");
  text += fmt::format("{:>9} {:>8} {:>9} {:>10} {:>9} {:>9} {:>10} {:>9}\n", "m/s", "m/s", "deg", "V",
                      of_pitch == FlightControl::bias ? "V" : "deg", "W", "s", "m");
  for (const TrimResult& t : report.flights) {
    const double control =
        of_pitch ? t.controls[*of_pitch] * (*of_pitch == FlightControl::bias ? 1.0 : degrees_per_radian) : absent;
    const auto shown = [&](double x, int digits) {
      return t.flies() ? fmt::format("{:.{}g}", cleared(x), digits) : std::string("-");
    };
    text += fmt::format("{:>9.4g} {:>8.4g} {:>9} {:>10} {:>9} {:>9} {:>10} {:>9}  {}\n", t.condition.speed,
                        t.condition.climb, shown(degrees_per_radian * t.pitch, 4),
                        shown(t.controls[FlightControl::voltage], 5), shown(control, 4), shown(t.power, 4),
                        time_text(endurance_of(report, t)), time_text(range_of(report, t)), name_of(t.status));
  }
  for (const TrimResult& t : report.flights) {
    if (t.status != TrimStatus::trimmed) text += fmt::format("{:g} m/s: {}\n", t.condition.speed, t.detail);
  }
  return text;
}

std::string text_stability(const StabilityReport& report) {
  const StabilityResult& r = report.result;
  std::string text = fmt::format("{}\n  {}: {}\n", report.vehicle, name_of(r.trim.status), r.trim.detail);
  if (!r.model) return text;
  text += "\nModes, the least stable first; real part and angular frequency in 1/s\n";
  text += fmt::format("  {:<13} {:<27} {:<27} {:>16}  {}\n", "", "averaged over the wingbeat", "Floquet, whole flight",
                      "difference", "averaged");
  for (const FlightMode& mode : r.modes) {
    const auto shown = [](const auto& s) { return s ? number_text(*s) : std::string("         -"); };
    const double apart = mode.apart();
    std::string what;
    if (mode.averaged) {
      what = growth_text(*mode.averaged);
      if (mode.averaged->imag() != 0.0) what += fmt::format(", period {:.3g} s", FlightMode::period(*mode.averaged));
      what += "; " + mode.shape;
    }
    text += fmt::format("  {:<13} {:<27} {:<27} {:>16}  {}\n", mode.longitudinal ? "longitudinal" : "lateral",
                        shown(mode.averaged), shown(mode.floquet),
                        std::isfinite(apart)            ? fmt::format("{:.1f} %", 100.0 * apart)
                        : mode.averaged && mode.floquet ? "of another kind"
                                                        : "-",
                        what);
  }
  text += r.periodic ? periodic_text(report) : fmt::format("\nNo Floquet theory: {}\n", r.periodic_detail);
  text += "\nDerivatives: rate of each row by each column, SI\n            ";
  for (const char* name : flight_state_names)
    text += fmt::format("{:>11}", std::string(name).substr(0, std::string(name).find('_')));
  text += "\n";
  for (std::size_t row = 0; row < 6; ++row) {
    text += fmt::format("  {:<10}", std::string(flight_state_names[row]).substr(0, 1) + "'");
    for (std::size_t column = 0; column < flight_state_count; ++column) {
      const double x = r.model->A(Eigen::Index(row), Eigen::Index(column));
      text += fmt::format("{:>11.4g}", std::abs(x) < 1e-5 ? 0.0 : x);
    }
    text += "\n";
  }
  if (!report.sensitivities.empty()) {
    text += "\nThe least stable mode: change of its real part [1/s] for a parameter 1 % larger, trimmed anew\n";
    for (std::size_t n = 0; n < std::min<std::size_t>(15, report.sensitivities.size()); ++n) {
      const ModeSensitivity& s = report.sensitivities[n];
      text += fmt::format("  {:<40}{:>+12.4g}\n", s.parameter, 0.01 * s.slope);
    }
    text += fmt::format("  {:<40}{:>12.4g}\n", "all parameters scattered by 1 %", 0.01 * scatter_of(report));
  }
  return text;
}

namespace described {
namespace {

const Description<TrimResult>& trim_description() {
  using R = TrimResult;
  static const Description<R> description = [] {
    Description<R> d;
    d.always("speed_m_per_s", "m/s", "horizontal, against the air", [](const R& r) { return r.condition.speed; })
        .always("climb_m_per_s", "m/s", "upwards", [](const R& r) { return r.condition.climb; })
        .always("turn_rate_rad_per_s", "rad/s", "of the heading, to the right",
                [](const R& r) { return r.condition.turn_rate; })
        .always("status", "", "", &R::status)
        .always("status_detail", "", "a sentence", &R::detail)
        .always("pitch_rad", "rad", "attitude, nose up; null, as all below, where it does not fly so",
                [](const R& r) { return r.flies() ? r.pitch : absent; })
        .always("roll_rad", "rad", "right wing down", [](const R& r) { return r.flies() ? r.roll : absent; })
        .always("frequency_hz", "Hz", "of the first drive", &R::frequency)
        .always("power_electrical_w", "W", "mean, at the terminals of all drives", &R::power);
    for (std::size_t k = 0; k < flight_control_count; ++k) {
      const std::string_view unit = flight_control_units[k];
      d.always(std::string("control_") + name_of(FlightControl(k)) + flight_control_suffix(FlightControl(k)), unit, "",
               [k](const R& r) { return r.flies() ? r.controls.at[k] : absent; });
    }
    return d;
  }();
  return description;
}

struct FlownTrim {
  const TrimReport& report;
  const TrimResult& flight;
};

const Description<FlownTrim>& flown_description() {
  static const Description<FlownTrim> description =
      Description<FlownTrim>()
          .all_of(trim_description(), [](const FlownTrim& f) { return f.flight; })
          .always("endurance_s", "s", "energy of the battery over the power",
                  [](const FlownTrim& f) { return endurance_of(f.report, f.flight); })
          .always("range_m", "m", "speed times that", [](const FlownTrim& f) { return range_of(f.report, f.flight); });
  return description;
}

const Description<TrimReport>& report_description() {
  using R = TrimReport;
  static const Description<R> description =
      Description<R>()
          .always("vehicle", "", "its name", &R::vehicle)
          .parts("flights", "one for each speed", flown_description(), [](const R& r) {
            std::vector<FlownTrim> all;
            for (const TrimResult& t : r.flights) all.push_back({r, t});
            return all;
          });
  return description;
}

const Description<FlightMode>& flight_mode_description() {
  using R = FlightMode;
  static const Description<R> description =
      Description<R>()
          .always("longitudinal", "", "else lateral", &R::longitudinal)
          .always("shape", "", "states that take part most", &R::shape)
          .always("averaged_real_per_s", "1/s", "averaged over the wingbeat",
                  [](const R& r) { return r.averaged ? r.averaged->real() : absent; })
          .always("averaged_imaginary_per_s", "1/s", "",
                  [](const R& r) { return r.averaged ? r.averaged->imag() : absent; })
          .always("floquet_real_per_s", "1/s", "of the whole periodic flight",
                  [](const R& r) { return r.floquet ? r.floquet->real() : absent; })
          .always("floquet_imaginary_per_s", "1/s", "",
                  [](const R& r) { return r.floquet ? r.floquet->imag() : absent; })
          .always("doubling_time_s", "s", "of the averaged mode; negative where it halves",
                  [](const R& r) { return r.averaged ? FlightMode::doubling_time(*r.averaged) : absent; })
          .always("period_s", "s", "of the averaged mode, where it oscillates",
                  [](const R& r) { return r.averaged ? FlightMode::period(*r.averaged) : absent; })
          .always("apart", "1",
                  "distance of the two over the averaged one; null where one oscillates and the other not",
                  [](const R& r) { return r.apart(); });
  return description;
}

Json matrix_rows(const Eigen::MatrixXd& m) {
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < m.rows(); ++row) {
    Json numbers = Json::array();
    for (Eigen::Index column = 0; column < m.cols(); ++column)
      numbers.push_back(detail::number_or_null(m(row, column)));
    rows.push_back(std::move(numbers));
  }
  return rows;
}

const Description<ModeSensitivity>& sensitivity_description() {
  using R = ModeSensitivity;
  static const Description<R> description =
      Description<R>()
          .always("parameter", "", "key of the vehicle file", &R::parameter)
          .always("value", "", "SI", &R::value)
          .always("slope_per_s", "1/s", "of the real part of the least stable mode by the parameter's relative change",
                  &R::slope);
  return description;
}

const Description<StabilityReport>& stability_description() {
  using R = StabilityReport;
  const Json matrix = schema::listed(schema::listed(schema::number_if_any));
  static const Description<R> description =
      Description<R>()
          .always("vehicle", "", "its name", &R::vehicle)
          .part("trim", "", trim_description(), [](const R& r) { return r.result.trim; })
          .always(
              "states", "", "of A: names with units",
              [](const R&) { return std::vector<std::string>(flight_state_names.begin(), flight_state_names.end()); })
          .always("controls", "", "of B",
                  [](const R& r) {
                    std::vector<std::string> names;
                    if (!r.result.model) return names;
                    for (const FlightControl c : r.result.model->controls) names.push_back(name_of(c));
                    return names;
                  })
          .always(
              "A", "", "averaged linear model, states by states",
              [](const R& r) { return r.result.model ? matrix_rows(r.result.model->A) : Json::array(); }, matrix)
          .always(
              "B", "", "states by controls",
              [](const R& r) { return r.result.model ? matrix_rows(r.result.model->B) : Json::array(); }, matrix)
          .always(
              "W", "", "states by the velocity of the air along the axes of the body in trim: wind_u, wind_v, wind_w",
              [](const R& r) { return r.result.model ? matrix_rows(r.result.model->W) : Json::array(); }, matrix)
          .parts("modes", "the least stable first; of a pair the one of positive imaginary part",
                 flight_mode_description(), [](const R& r) { return r.result.modes; })
          .always("periodic", "", "a flight that repeats with the wingbeat was found",
                  [](const R& r) { return r.result.periodic.has_value(); })
          .always("periodic_detail", "", "reason if there is no Floquet result, otherwise empty",
                  [](const R& r) { return r.result.periodic_detail; })
          .parts("sensitivities", "with --sensitivity, the largest first", sensitivity_description(), &R::sensitivities)
          .always("scatter_per_s", "1/s",
                  "standard deviation of that real part over the relative one of all parameters, to first order",
                  &scatter_of);
  return description;
}

}  // namespace

Json trim_schema() { return report_description().schema(); }
Json stability_schema() { return stability_description().schema(); }

}  // namespace described

std::string json_trim(const TrimReport& report) { return detail::dumped(described::report_description().json(report)); }
std::string json_stability(const StabilityReport& report) {
  return detail::dumped(described::stability_description().json(report));
}

}  // namespace wingbeat
