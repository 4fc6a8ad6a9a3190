#include "wingbeat/files/kinematics_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <vector>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/core/text.hpp"

namespace wingbeat {
namespace {

struct KinematicsColumn {
  const char* name;
  double (*value)(const WingInstant&);
};
constexpr KinematicsColumn kinematics_columns[] = {
    {"time_s", [](const WingInstant& w) { return w.time; }},
    {"phase_rad", [](const WingInstant& w) { return two_pi * w.cycle; }},
    {"stroke_angle_rad", [](const WingInstant& w) { return w.stroke.value; }},
    {"flapping_velocity_rad_per_s", [](const WingInstant& w) { return w.stroke.velocity; }},
    {"stroke_acceleration_rad_per_s2", [](const WingInstant& w) { return w.stroke.acceleration; }},
    {"pitch_angle_rad", [](const WingInstant& w) { return w.pitch.value; }},
    {"pitch_velocity_rad_per_s", [](const WingInstant& w) { return w.pitch.velocity; }},
    {"twist_angle_rad", [](const WingInstant& w) { return w.twist; }},
    {"lift_n", [](const WingInstant& w) { return w.loads.lift; }},
    {"stroke_moment_nm", [](const WingInstant& w) { return w.loads.stroke_moment; }},
    {"pitch_moment_nm", [](const WingInstant& w) { return w.loads.pitch_moment; }},
};

/// A text on one line, for a comment.
std::string on_one_line(std::string text) {
  for (char& c : text) c = c == '\n' || c == '\r' ? ' ' : c;
  return detail::printable(text);
}

std::string degrees_of(const std::vector<double>& coefficients) {
  std::string text;
  for (const double x : coefficients) text += fmt::format("{}{:.12f}", text.empty() ? "" : " ", degrees_per_radian * x);
  return text.empty() ? "0.0" : text;
}

void add_series(std::string& text, const char* angle, const AngleSeries& series) {
  auto out = std::back_inserter(text);
  // The formats' readers take half of a0.
  fmt::format_to(out, "a0_{}={:.12f};\n", angle, 2.0 * degrees_per_radian * series.mean);
  fmt::format_to(out, "ai_{}={};\n", angle, degrees_of(series.cosine));
  fmt::format_to(out, "bi_{}={};\n", angle, degrees_of(series.sine));
}

}  // namespace

std::string kinematics_csv(std::span<const WingInstant> wings, bool loads) {
  std::vector<KinematicsColumn> written;
  constexpr std::size_t first_load = std::size(kinematics_columns) - 3;
  for (std::size_t k = 0; k < (loads ? std::size(kinematics_columns) : first_load); ++k) {
    const KinematicsColumn& c = kinematics_columns[k];
    if (!wings.empty() && std::isfinite(c.value(wings.front()))) written.push_back(c);
  }
  std::string text;
  auto out = std::back_inserter(text);
  for (const KinematicsColumn& c : written) fmt::format_to(out, "{}{}", &c == written.data() ? "" : ",", c.name);
  text += '\n';
  for (const WingInstant& w : wings) {
    for (const KinematicsColumn& c : written) {
      if (&c != written.data()) text += ',';
      if (const double x = c.value(w); std::isfinite(x)) fmt::format_to(out, "{}", x == 0.0 ? 0.0 : x);
    }
    text += '\n';
  }
  return text;
}

std::string load_table_csv(std::span<const LoadTable::Row> rows, const std::string& comment) {
  static constexpr const char* headers[LoadTable::columns] = {
      "stroke_angle_rad", "flapping_velocity_rad_per_s", "pitch_angle_rad", "pitch_velocity_rad_per_s",
      "lift_N",           "stroke_moment_N_m",           "pitch_moment_N_m"};
  std::string text = "# " + on_one_line(comment) + "\n";
  auto out = std::back_inserter(text);
  const auto add_line = [&](const auto& cell) {
    bool first = true;
    for (std::size_t k = 0; k < LoadTable::columns; ++k) {
      if (rows.empty() || std::isnan(rows.front()[k])) continue;
      text += first ? "" : ",";
      first = false;
      cell(k);
    }
    text += '\n';
  };
  add_line([&](std::size_t k) { text += headers[k]; });
  for (const LoadTable::Row& row : rows) {
    add_line([&](std::size_t k) { fmt::format_to(out, "{}", row[k] == 0.0 ? 0.0 : row[k]); });
  }
  return text;
}

std::string kinematics_wabbit(const KinematicsSource& source) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "; Wing kinematics of {}\n"
                 "; written by wingbeat {} export-kinematics\n"
                 ";\n"
                 "; One wing beat at {:.12g} Hz, t from 0 to 1. An angle is half of its a0 plus the sum over k of\n"
                 "; ai(k) cos(2 pi k t) + bi(k) sin(2 pi k t), in degrees.\n"
                 "; phi: stroke angle. alpha: pitch angle, zero where the chord is normal to the stroke plane,\n"
                 "; negative while phi grows. theta: deviation, none.\n"
                 "; Largest error of the series, in degrees: phi {:.3g}, alpha {:.3g}.\n",
                 on_one_line(source.vehicle), source.version, source.frequency,
                 degrees_per_radian * source.stroke.error_max, degrees_per_radian * source.pitch.error_max);
  fmt::format_to(out,
                 "[kinematics]\n"
                 "format=2015-10-09;\n"
                 "convention=flusi;\n"
                 "units=degree;\n"
                 "type=fourier;\n"
                 "nfft_phi={};\n"
                 "nfft_alpha={};\n"
                 "nfft_theta=1;\n",
                 source.stroke.cosine.size(), source.pitch.cosine.size());
  add_series(text, "phi", source.stroke);
  add_series(text, "alpha", source.pitch);
  AngleSeries none;
  none.cosine = none.sine = {0.0};
  add_series(text, "theta", none);
  return text;
}

}  // namespace wingbeat
