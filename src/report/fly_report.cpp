#include "wingbeat/report/fly_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/described.hpp"
#include "report/report_tools.hpp"
#include "report/result_schemas.hpp"
#include "wingbeat/core/math.hpp"

namespace wingbeat {
namespace {

/// A loop gain, of which none is 0.
double gain_or_absent(const std::optional<double>& gain) { return gain.value_or(absent); }

std::string fly_row(const char* name, const std::string& value) { return fmt::format("  {:<34}{}\n", name, value); }

std::string regulator_text(const ControllerDesign& d) {
  std::string text = "\nRegulator: gains of each control by the deviations, SI\n" + fmt::format("  {:<26}", "");
  for (const char* name : regulated_state_names) {
    text += fmt::format("{:>10}", std::string(name).substr(0, std::string(name).find('_')));
  }
  text += "\n";
  for (std::size_t c = 0; c < d.controls.size(); ++c) {
    text += fmt::format("  {:<26}", name_of(d.controls[c]));
    for (Eigen::Index k = 0; k < d.gains.cols(); ++k) {
      const double gain = d.gains(Eigen::Index(c), k);
      const double largest = d.gains.row(Eigen::Index(c)).cwiseAbs().maxCoeff();
      text += fmt::format("{:>10.3g}", std::abs(gain) < 1e-6 * largest ? 0.0 : gain);
    }
    text += "\n";
  }
  return text + fmt::format("  largest magnitude of a closed-loop eigenvalue {:.4f}, Riccati residual {:.1e}\n",
                            d.spectral_radius, d.riccati_residual);
}

std::string cascade_text(const ControllerDesign& d) {
  std::string text = fmt::format(
      "\nCascade: bandwidths of position {:.3g}, velocity {:.3g}, attitude {:.3g}, rates {:.3g} rad/s\n"
      "  {:<8}{:<28}{:>14}{:>14}{:>14}\n",
      d.position, d.velocity, d.attitude, d.rates, "", "control", "proportional", "integral", "derivative");
  for (std::size_t a = 0; a < flight_axis_count; ++a) {
    if (!d.by_axis[a]) continue;
    const LoopGains& loop = d.loops[a];
    text +=
        fmt::format("  {:<8}{:<28}{:>14.4g}{:>14.4g}{:>14.4g}\n", name_of(FlightAxis(a)), name_of(*d.by_axis[a]),
                    gain_or_absent(loop.proportional), gain_or_absent(loop.integral), gain_or_absent(loop.derivative));
  }
  return text;
}

}  // namespace

std::string text_fly(const FlyReport& report) {
  const FlightRecord& f = report.flight;
  std::string text = fmt::format("{}\n  {}: {}\n", report.title, name_of(f.outcome), f.detail);
  if (f.rows.empty()) return text;
  for (const std::string& sentence : f.design.uncontrolled) text += "  " + sentence + "\n";
  const TrackingError& e = f.error;
  text += fly_row("controller", fmt::format("{} at {:.4g} Hz, delay {:.3g} ms", name_of(f.design.type), f.control_rate,
                                            1e3 * f.design.delay));
  // No more digits than hold at a smaller tolerance: the phase of the wings carries rounding on to about 1 % of them.
  text += fly_row("position error, horizontal",
                  fmt::format("{:.2g} m rms, {:.2g} m at most", e.horizontal_rms, e.horizontal_max));
  text += fly_row("position error, vertical",
                  fmt::format("{:.2g} m rms, {:.2g} m at most", e.vertical_rms, e.vertical_max));
  text += fly_row("heading error", fmt::format("{:.2g} deg rms", degrees_per_radian * e.heading_rms));
  text += fly_row("largest tilt", fmt::format("{:.2g} deg", degrees_per_radian * e.tilt_max));
  text += fly_row("mean electrical power", fmt::format("{:.4g} W", f.mean_power));
  if (std::isfinite(f.rows.back().charge)) {
    text += fly_row("charge of the battery",
                    fmt::format("{:.4g} % to {:.4g} %", 100.0 * f.rows.front().charge, 100.0 * f.rows.back().charge));
  }
  const FlightEnergy& E = f.energy;
  text += "\nEnergy of the whole flight, J\n";
  text += fly_row("electrical, at the terminals", fmt::format("{:>12.6g}", E.electrical));
  text += fly_row("by the air on the body", fmt::format("{:>12.6g}", E.body_air));
  text += fly_row("lost in motors and gearboxes", fmt::format("{:>12.6g}", E.motor));
  text += fly_row("lost in mechanism and hinges", fmt::format("{:>12.6g}", E.friction));
  text += fly_row("by the drives to the air", fmt::format("{:>12.6g}", E.wing_air));
  if (E.stops != 0.0) text += fly_row("lost on stops of the pitching", fmt::format("{:>12.6g}", E.stops));
  if (E.formulation != 0.0)
    text += fly_row("not conserved by the formulation", fmt::format("{:>12.6g}", E.formulation));
  text += fly_row("stored more in body and drives", fmt::format("{:>12.6g}", E.stored));
  text += fly_row("residual", fmt::format("{:>12.2g}", E.residual));
  if (f.design.type == ControllerType::lqr) text += regulator_text(f.design);
  if (f.design.type == ControllerType::pid) text += cascade_text(f.design);
  return text;
}

namespace described {
namespace {

const Description<FlightEnergy>& flight_energy_description() {
  using R = FlightEnergy;
  static const Description<R> description =
      Description<R>()
          .always("electrical_j", "J", "at the terminals of all drives", &R::electrical)
          .always("motor_j", "J", "lost in motors and gearboxes", &R::motor)
          .always("friction_j", "J", "lost in mechanism and hinges", &R::friction)
          .always("wing_air_j", "J", "by the drives to the air", &R::wing_air)
          .always("stops_j", "J", "lost in impacts on stops of the pitching", &R::stops)
          .always("formulation_j", "J", "what the formulation of a crank fails to conserve", &R::formulation)
          .always("body_air_j", "J", "by the air on the body", &R::body_air)
          .always("stored_j", "J", "change of what drives and body store", &R::stored)
          .always("controls_j", "J", "part of that which controls moved in steps have brought", &R::controls)
          .always("residual_j", "J", "what is left of the balance", &R::residual)
          .always("body_stored_j", "J", "change of the body's kinetic and potential energy", &R::body_stored)
          .always("body_residual_j", "J", "work of the air on the body less that; null of wings with mass",
                  &R::body_residual)
          .always("battery_j", "J", "from the battery, its own losses included; null without one", &R::battery);
  return description;
}

struct AxisLoop {
  FlightAxis axis;
  FlightControl control;
  LoopGains gains;
};

const Description<AxisLoop>& loop_description() {
  using R = AxisLoop;
  static const Description<R> description =
      Description<R>()
          .always("axis", "", "", &R::axis)
          .always("control", "", "", &R::control)
          .always("proportional", "", "control by rate, of climb by vertical speed, SI",
                  [](const R& r) { return gain_or_absent(r.gains.proportional); })
          .always("integral", "", "SI", [](const R& r) { return gain_or_absent(r.gains.integral); })
          .always("derivative", "", "SI", [](const R& r) { return gain_or_absent(r.gains.derivative); });
  return description;
}

const Description<ControllerDesign>& controller_description() {
  using R = ControllerDesign;
  static const Description<R> description =
      Description<R>()
          .always("type", "", "", &R::type)
          .always("controls", "", "that it uses",
                  [](const R& r) {
                    std::vector<std::string> names;
                    for (const FlightControl c : r.controls) names.push_back(name_of(c));
                    return names;
                  })
          .always("uncontrolled", "", "a sentence for each axis without a control", &R::uncontrolled)
          .always("delay_s", "s", "that the design takes into account", &R::delay)
          .always("states", "", "by which lqr steers: names with units",
                  [](const R&) {
                    return std::vector<std::string>(regulated_state_names.begin(), regulated_state_names.end());
                  })
          .always(
              "gains", "", "of lqr: controls by states",
              [](const R& r) {
                Json rows = Json::array();
                for (Eigen::Index i = 0; i < r.gains.rows(); ++i) {
                  Json numbers = Json::array();
                  for (Eigen::Index k = 0; k < r.gains.cols(); ++k) {
                    numbers.push_back(wingbeat::detail::number_or_null(r.gains(i, k)));
                  }
                  rows.push_back(std::move(numbers));
                }
                return rows;
              },
              schema::listed(schema::listed(schema::number_if_any)))
          .always("riccati_residual", "1", "of lqr, over the largest term", &R::riccati_residual)
          .always("spectral_radius", "1", "of the sampled closed loop of lqr", &R::spectral_radius)
          .always("bandwidth_position_rad_per_s", "rad/s", "of pid", &R::position)
          .always("bandwidth_velocity_rad_per_s", "rad/s", "of pid", &R::velocity)
          .always("bandwidth_attitude_rad_per_s", "rad/s", "of pid", &R::attitude)
          .always("bandwidth_rates_rad_per_s", "rad/s", "of pid", &R::rates)
          .parts("loops", "innermost loops of pid", loop_description(), [](const R& r) {
            std::vector<AxisLoop> loops;
            for (std::size_t a = 0; a < flight_axis_count; ++a) {
              if (r.by_axis[a]) loops.push_back({FlightAxis(a), *r.by_axis[a], r.loops[a]});
            }
            return loops;
          });
  return description;
}

const Description<FlyReport>& fly_description() {
  using R = FlyReport;
  const auto error = [](double TrackingError::* which) {
    return [which](const R& r) { return r.flight.error.*which; };
  };
  using E = TrackingError;
  static const Description<R> description =
      Description<R>()
          .always("title", "", "", &R::title)
          .always("outcome", "", "", [](const R& r) { return r.flight.outcome; })
          .always("outcome_detail", "", "a sentence", [](const R& r) { return r.flight.detail; })
          .always("end_s", "s", "of the flight", [](const R& r) { return r.flight.end; })
          .always("rows", "", "", [](const R& r) { return r.flight.rows.size(); })
          .always("horizontal_error_rms_m", "m", "of the position", error(&E::horizontal_rms))
          .always("horizontal_error_max_m", "m", "", error(&E::horizontal_max))
          .always("vertical_error_rms_m", "m", "", error(&E::vertical_rms))
          .always("vertical_error_max_m", "m", "", error(&E::vertical_max))
          .always("heading_error_rms_rad", "rad", "", error(&E::heading_rms))
          .always("tilt_max_rad", "rad", "", error(&E::tilt_max))
          .always("power_electrical_w", "W", "mean over the flight", [](const R& r) { return r.flight.mean_power; })
          .always("charge_end", "1", "of the battery; null without one",
                  [](const R& r) { return r.flight.rows.empty() ? absent : r.flight.rows.back().charge; })
          .part("controller", "", controller_description(), [](const R& r) { return r.flight.design; })
          .part("energy", "of the whole flight", flight_energy_description(),
                [](const R& r) { return r.flight.energy; });
  return description;
}

}  // namespace

Json fly_schema() { return fly_description().schema(); }

}  // namespace described

std::string json_fly(const FlyReport& report) { return detail::dumped(described::fly_description().json(report)); }

}  // namespace wingbeat
