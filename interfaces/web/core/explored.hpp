// What a page asks of the library, in JSON and columns: vehicle files and values of keys go in as text. The page itself
// (interfaces/web/src) computes nothing but positions on the screen.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "wingbeat/files/design_edit.hpp"
#include "wingbeat/wingbeat.hpp"

namespace wingbeat::web {

using Json = nlohmann::ordered_json;
using Columns = std::vector<std::pair<std::string, std::vector<double>>>;

/// The tables of keys, metrics and waveforms, and the choices of a run: {"keys", "metrics", "waveforms"}.
Json tables_of_the_library();

/// A vehicle file, its table files given by name, as a text that is complete in itself: {"toml", "name"}. Throws
/// InputError.
Json read_vehicle(const std::string& text, const std::string& name, const nlohmann::json& tables);

/// The design of a vehicle file that read_vehicle has passed, with other values of keys; it lives until the next call.
/// Throws InputError.
const Design<double>& explored(const std::string& text, const std::vector<std::string>& assignments);

/// Every key that the design has with its value: numbers [SI], texts, true or false.
Json values_of(const Design<double>& design);

/// condition, method, tolerance, frequency [Hz], lift [N], allow_extrapolation, rows: those of `wingbeat run`, which
/// with --json computes the endurance on a battery; here `endurance` asks for it.
RunOptions options_of(const nlohmann::json& options);

/// {"report": the object of `wingbeat run --json`, "balance": mean powers [W], "evidence": angles [rad] and torques
/// [N m] of the status}; columns: the cycle, as in a waveform file.
Json solved(const Design<double>& design, const RunOptions& options, Columns& columns);

/// The first moments from rest: {"status", "detail", "end_time"}; columns: time_s, crank_angle_rad,
/// crank_speed_rad_per_s, current_a.
Json started(const Design<double>& design, const RunOptions& options, Columns& columns);

/// {"status", "detail", "gradients": {key: [by metric, SI]}}, null where there is none.
Json differentiated(const Design<double>& design, const std::vector<std::string>& keys, const RunOptions& options);

/// Kind, joints and links of the mechanism; columns over the angles given [rad], of the crank or, of a direct drive, of
/// the stroke: stroke_angle_rad and the places of joints [m], NAME_x and NAME_y.
Json mechanism_of(const Design<double>& design, const std::vector<double>& angles, Columns& columns);

/// The designs whose keys have the values given, row by row: {"statuses": names by number}; columns: status, domain (0
/// inside) and every metric.
Json solved_together(const Design<double>& design, const std::vector<std::string>& keys,
                     const std::vector<double>& values, const RunOptions& options, Columns& columns);

/// The motors of a catalogue (CSV) in the design behind a gearbox of ratio `gear`: {"motors": [{"model", "refused",
/// "values"}]}. Throws InputError.
Json motors_for(const Design<double>& design, const std::string& catalogue, double gear);

}  // namespace wingbeat::web
