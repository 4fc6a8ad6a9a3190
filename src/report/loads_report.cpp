#include "wingbeat/report/loads_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/described.hpp"
#include "report/report_tools.hpp"
#include "report/result_schemas.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {
namespace {

constexpr int loads_page_width = 90;

std::string quantity_words(LoadQuantity quantity) {
  std::string name = name_of(quantity);
  for (char& c : name) c = c == '_' ? ' ' : c;
  return name;
}

std::string share_text(double share) { return std::isfinite(share) ? fmt::format("{:.3g} %", 100.0 * share) : "-"; }

std::string lag_text(double angle) {
  return std::isfinite(angle) ? fmt::format("{:.2f} deg", degrees_per_radian * angle) : "-";
}

std::string ratio_text(double x) { return std::isfinite(x) ? fmt::format("{:.4f}", x) : "-"; }

std::string angle_series_text(const char* name, const AngleSeries& series) {
  return fmt::format("  {:<10}{} harmonics, largest error {:.3g} deg, root mean square {:.3g} deg\n", name,
                     series.cosine.size(), degrees_per_radian * series.error_max,
                     degrees_per_radian * series.error_rms);
}

}  // namespace

std::string text_kinematics(const WrittenKinematics& w) {
  std::string text = fmt::format("One wing beat at {}, as {}\n\n", readable(w.frequency, "Hz"), name_of(w.format));
  text += fmt::format("  {:<16}{:>10.3f} to {:>8.3f} deg\n", "Stroke angle", degrees_per_radian * w.stroke_min,
                      degrees_per_radian * w.stroke_max);
  text += fmt::format("  {:<16}{:>10.3f} to {:>8.3f} deg{}\n", "Pitch angle", degrees_per_radian * w.pitch_min,
                      degrees_per_radian * w.pitch_max, w.twists ? ", of the root" : "");
  if (w.format == KinematicsFormat::load_table) {
    text += fmt::format("\n{} rows of loads; the grid is a fifth wider than the motion\n", w.rows);
  } else if (w.format == KinematicsFormat::csv) {
    text += fmt::format("\n{} instants equally spaced in time, both ends included\n", w.rows);
  } else if (w.stroke && w.pitch) {
    text += "\nFourier series over the beat\n" + angle_series_text("stroke", *w.stroke) +
            angle_series_text("pitch", *w.pitch);
  }
  return text;
}

std::string describe(LoadQuantity quantity, const LoadDisagreement& d) {
  const std::string name = quantity_words(quantity);
  constexpr double rounding = 1e-9;
  if (d.rms_difference < rounding) return fmt::format("Model and simulation have the same {}, to rounding.", name);
  constexpr double agreement = 1e-3;
  if (d.rms_difference < agreement) {
    return fmt::format("Model and simulation have the same {} to {} of its root mean square.", name,
                       share_text(d.rms_difference));
  }
  std::string text;
  // A mean that is small beside the variation has no ratio worth a sentence.
  constexpr double small_mean = 0.05;
  if (std::isfinite(d.ratio) && std::abs(d.mean_simulated) > small_mean * d.rms_simulated) {
    text = fmt::format("The model's mean {} is {:.3g} times the simulated one. ", name, d.ratio);
  } else {
    text = fmt::format("The mean {} is small compared with its variation: do not use the ratio of the means. ", name);
  }
  if (!std::isfinite(d.correlation)) return text + "One of the two is constant over the cycle.";
  if (d.correlation < -0.5) {
    return text + fmt::format(
                      "It varies against the simulated one (correlation {:.2f}): check the signs, which docs/cfd.md "
                      "states.",
                      d.correlation);
  }
  text += fmt::format("{} of the simulated variation over the cycle is in phase with the model's. ",
                      share_text(d.variance_in_phase));
  const char* remedy =
      d.share_phase > d.share_mean + d.share_size
          ? "no factor on the coefficients removes this part; check rotation, added mass, wake and the motion"
      : d.share_mean > d.share_size ? "a factor on the coefficients that brings the means together removes that"
                                    : "a factor on the coefficients that scales the variation removes that";
  const double largest = std::max({d.share_mean, d.share_size, d.share_phase});
  const char* where = largest == d.share_phase  ? "in phase and shape"
                      : largest == d.share_mean ? "in the mean"
                                                : "in the size of the variation";
  return text + fmt::format("Of the mean-square difference {} is {}: {}.", share_text(largest), where, remedy);
}

std::string text_loads(const LoadReport& report) {
  const LoadComparison& c = report.comparison;
  std::string text = wrapped(
      fmt::format("{} rows over {:.3g} cycles at {}; {}", c.rows, c.cycles, readable(c.frequency, "Hz"),
                  c.own_motion ? "motion of the vehicle's settled cycle" : "motion of the file, as Fourier series:"),
      loads_page_width, 0);
  if (!text.ends_with('\n')) text += '\n';
  if (c.stroke) text += angle_series_text("stroke", *c.stroke);
  if (c.pitch) text += angle_series_text("pitch", *c.pitch);
  text += fmt::format("\n{:<36}", "");
  for (const ComparedLoad& load : c.loads) text += fmt::format("{:>17}", quantity_words(load.quantity));
  text += '\n';
  const auto row = [&](const char* name, const auto& value) {
    text += fmt::format("{:<36}", name);
    for (const ComparedLoad& load : c.loads) text += fmt::format("{:>17}", value(load));
    text += '\n';
  };
  using L = ComparedLoad;
  row("Mean, model", [](const L& l) { return readable(l.disagreement.mean_model, unit_of(l.quantity)); });
  row("Mean, simulated", [](const L& l) { return readable(l.disagreement.mean_simulated, unit_of(l.quantity)); });
  row("Model over simulated, means", [](const L& l) { return ratio_text(l.disagreement.ratio); });
  row("RMS difference over simulated RMS", [](const L& l) { return share_text(l.disagreement.rms_difference); });
  row("Correlation of the variation", [](const L& l) { return ratio_text(l.disagreement.correlation); });
  row("Variance in phase", [](const L& l) { return share_text(l.disagreement.variance_in_phase); });
  row("Lag of the model, 1st harmonic", [](const L& l) { return lag_text(l.disagreement.first_harmonic_lag); });
  row("Lag of the strongest harmonic", [](const L& l) {
    return l.disagreement.strongest_harmonic == 0
               ? std::string("-")
               : fmt::format("{}: {}", l.disagreement.strongest_harmonic, lag_text(l.disagreement.strongest_lag));
  });
  text += "Of the mean-square difference:\n";
  row("  mean", [](const L& l) { return share_text(l.disagreement.share_mean); });
  row("  size of the variation", [](const L& l) { return share_text(l.disagreement.share_size); });
  row("  phase and shape", [](const L& l) { return share_text(l.disagreement.share_phase); });
  for (const ComparedLoad& load : c.loads) {
    text += "\n" + wrapped(describe(load.quantity, load.disagreement), loads_page_width, 0);
    if (!text.ends_with('\n')) text += '\n';
  }
  if (!c.left_out.empty()) text += '\n';
  for (const std::string& reason : c.left_out) text += wrapped("Not compared: " + reason, loads_page_width, 2) + "\n";
  if (!report.not_read.empty()) {
    text += "\n" + wrapped(fmt::format("Columns not read: {}", fmt::join(report.not_read, ", ")), loads_page_width, 2) +
            "\n";
  }
  return text;
}

namespace described {
namespace {

const Description<AngleSeries>& angle_series_description() {
  using R = AngleSeries;
  static const Description<R> description =
      Description<R>()
          .always("harmonics", "", "", [](const R& r) { return int(r.cosine.size()); })
          .always("mean_rad", "rad", "", &R::mean)
          .always("cosine_rad", "rad", "coefficients of the cosines", &R::cosine)
          .always("sine_rad", "rad", "coefficients of the sines", &R::sine)
          .always("error_max_rad", "rad", "largest difference from the motion", &R::error_max)
          .always("error_rms_rad", "rad", "root mean square of the difference", &R::error_rms);
  return description;
}

const Description<WrittenKinematics>& kinematics_description() {
  using R = WrittenKinematics;
  static const Description<R> description =
      Description<R>()
          .always("format", "", "", &R::format)
          .always("frequency_hz", "Hz", "", &R::frequency)
          .always("stroke_min_rad", "rad", "", &R::stroke_min)
          .always("stroke_max_rad", "rad", "", &R::stroke_max)
          .always("pitch_min_rad", "rad", "of the root", &R::pitch_min)
          .always("pitch_max_rad", "rad", "of the root", &R::pitch_max)
          .always("twists", "", "the wings twist, and the file has their twist", &R::twists)
          .always("rows", "", "of a CSV file; else 0", &R::rows)
          .part("stroke_series", "of a file with Fourier series", angle_series_description(),
                [](const R& r) -> const std::optional<AngleSeries>& { return r.stroke; })
          .part("pitch_series", "of a file with Fourier series", angle_series_description(),
                [](const R& r) -> const std::optional<AngleSeries>& { return r.pitch; });
  return description;
}

const Description<ComparedLoad>& load_description() {
  using R = ComparedLoad;
  const auto member = [](double LoadDisagreement::* which) {
    return [which](const R& r) { return r.disagreement.*which; };
  };
  using D = LoadDisagreement;
  static const Description<R> description =
      Description<R>()
          .always("quantity", "", "of all wings", &R::quantity)
          .always("unit", "", "of the means", [](const R& r) { return std::string(unit_of(r.quantity)); })
          .always("mean_model", "", "", member(&D::mean_model))
          .always("mean_simulated", "", "", member(&D::mean_simulated))
          .always("mean_ratio", "1", "model over simulated", member(&D::ratio))
          .always("rms_simulated", "", "root mean square", member(&D::rms_simulated))
          .always("rms_difference", "1", "of model minus simulated, over rms_simulated", member(&D::rms_difference))
          .always("correlation", "1", "of the variation about the means", member(&D::correlation))
          .always("variance_in_phase", "1", "share of the simulated variance in phase with the model's",
                  member(&D::variance_in_phase))
          .always("first_harmonic_lag_rad", "rad", "of the model behind the simulated one",
                  member(&D::first_harmonic_lag))
          .always("strongest_harmonic", "", "of the simulated quantity, 1 to 4; 0 of a constant",
                  [](const R& r) { return r.disagreement.strongest_harmonic; })
          .always("strongest_harmonic_lag_rad", "rad", "of the model", member(&D::strongest_lag))
          .always("share_mean", "1", "of the mean-square difference: of the means", member(&D::share_mean))
          .always("share_size", "1", "of the size of the variation", member(&D::share_size))
          .always("share_phase", "1", "of its phase and shape", member(&D::share_phase))
          .always("meaning", "", "in sentences", [](const R& r) { return describe(r.quantity, r.disagreement); });
  return description;
}

const Description<LoadReport>& loads_description() {
  using R = LoadReport;
  static const Description<R> description =
      Description<R>()
          .always("loads_file", "", "", &R::loads_file)
          .always("frequency_hz", "Hz", "of the motion", [](const R& r) { return r.comparison.frequency; })
          .always("own_motion", "", "the motion is that of the vehicle's settled cycle, else that of the file",
                  [](const R& r) { return r.comparison.own_motion; })
          .always("rows", "", "", [](const R& r) { return r.comparison.rows; })
          .always("cycles", "1", "that the rows span", [](const R& r) { return r.comparison.cycles; })
          .always("largest_gap", "1", "between neighbours in phase, in cycles",
                  [](const R& r) { return r.comparison.largest_gap; })
          .part("stroke_series", "the stroke angle of the file", angle_series_description(),
                [](const R& r) -> const std::optional<AngleSeries>& { return r.comparison.stroke; })
          .part("pitch_series", "the pitch angle of the file", angle_series_description(),
                [](const R& r) -> const std::optional<AngleSeries>& { return r.comparison.pitch; })
          .parts("loads", "the quantities compared", load_description(),
                 [](const R& r) -> const std::vector<ComparedLoad>& { return r.comparison.loads; })
          .always("left_out", "", "quantities of the file that are not compared, and why",
                  [](const R& r) { return r.comparison.left_out; })
          .always("columns_not_read", "", "", &R::not_read);
  return description;
}

}  // namespace

Json kinematics_schema() { return kinematics_description().schema(); }
Json loads_schema() { return loads_description().schema(); }

}  // namespace described

std::string json_kinematics(const WrittenKinematics& written) {
  return detail::dumped(described::kinematics_description().json(written));
}

std::string json_loads(const LoadReport& report) { return detail::dumped(described::loads_description().json(report)); }

}  // namespace wingbeat
