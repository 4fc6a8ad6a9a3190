#include "wingbeat/files/waveform_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <vector>

namespace wingbeat {

const std::array<WaveformColumn, waveform_column_count>& waveform_columns() {
  using R = WaveformRow;
  static constexpr std::array<WaveformColumn, waveform_column_count> columns = {{
      {"time_s", "s", "time since crank angle zero", &R::time},
      {"crank_angle_rad", "rad", "crank angle", &R::crank_angle},
      {"crank_speed_rad_per_s", "rad/s", "crank speed", &R::crank_speed},
      {"current_a", "A", "armature current", &R::current},
      {"stroke_angle_rad", "rad", "stroke angle", &R::stroke_angle},
      {"flapping_velocity_rad_per_s", "rad/s", "flapping velocity", &R::flapping_velocity},
      {"angle_of_attack_deg", "degree", "angle of attack", &R::angle_of_attack_deg},
      {"lift_n", "N", "lift of all wings", &R::lift},
      {"aero_moment_nm", "N m", "aerodynamic moment of all wings about their hinges", &R::aero_moment},
      {"rod_force_n", "N", "rod force (of a four-bar the coupler force), positive as it raises the stroke angle",
       &R::rod_force},
      {"motor_torque_nm", "N m", "motor torque on the crank, behind the motor's own friction", &R::motor_torque},
      {"friction_torque_nm", "N m", "friction torque of the transmission on the crank", &R::friction_torque},
      {"voltage_v", "V", "voltage at the motor terminals", &R::voltage},
      {"power_electrical_w", "W", "electrical input power", &R::power_electrical},
      {"power_motor_w", "W", "motor output power", &R::power_motor},
      {"power_friction_w", "W", "friction loss", &R::power_friction},
      {"power_aerodynamic_w", "W", "aerodynamic power", &R::power_aerodynamic},
      {"spring_moment_nm", "N m", "moment of all hinge springs, towards stroke angle zero", &R::spring_moment},
      {"inertial_moment_nm", "N m", "wing inertia times stroke acceleration, of all wings", &R::inertial_moment},
      {"pitch_angle_rad", "rad", "pitch angle of wings on a hinge, 0 where the chord is upright", &R::pitch_angle},
  }};
  return columns;
}

std::span<const WaveformColumn> waveform_columns(std::span<const WaveformRow> rows) {
  const bool pitching = !rows.empty() && std::isfinite(rows.front().pitch_angle);
  return std::span<const WaveformColumn>(waveform_columns()).first(waveform_column_count - (pitching ? 0 : 1));
}

std::string waveforms_csv(std::span<const WaveformRow> rows) {
  const auto columns = waveform_columns(rows);
  std::string text;
  auto out = std::back_inserter(text);
  for (const WaveformColumn& c : columns) fmt::format_to(out, "{}{}", &c == columns.data() ? "" : ",", c.name);
  text += '\n';
  for (const WaveformRow& row : rows) {
    for (const WaveformColumn& c : columns) {
      if (&c != columns.data()) text += ',';
      // Without a negative zero, which 0 N m/rad times a negative angle gives.
      if (const double x = row.*c.value; std::isfinite(x)) fmt::format_to(out, "{}", x == 0.0 ? 0.0 : x);
    }
    text += '\n';
  }
  return text;
}

void write_waveforms_netcdf(const std::filesystem::path& path, std::span<const WaveformRow> rows,
                            const Provenance& provenance) {
  NetcdfFile file(path);
  const auto columns = waveform_columns(rows);
  const NetcdfFile::Dimension time = file.define_dimension(columns.front().name, rows.size());
  std::vector<NetcdfFile::Variable> variables;
  for (const WaveformColumn& c : columns) {
    variables.push_back(file.define_variable(c.name, {time}, c.unit, c.long_name));
  }
  write_provenance(file, provenance);
  std::vector<double> values(rows.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    for (std::size_t r = 0; r < rows.size(); ++r) values[r] = rows[r].*columns[c].value;
    file.write(variables[c], values);
  }
  file.close();
}

}  // namespace wingbeat
