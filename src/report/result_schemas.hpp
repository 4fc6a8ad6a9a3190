// The schemas of what commands print with --json, each made where the result is described.
#pragma once

#include <nlohmann/json.hpp>

namespace wingbeat::described {

nlohmann::ordered_json run_schema();
nlohmann::ordered_json two_sides_schema();       ///< of run, where the sides differ
nlohmann::ordered_json two_sides_maps_schema();  ///< of linearise, likewise
nlohmann::ordered_json endurance_schema();
nlohmann::ordered_json tolerance_schema();
nlohmann::ordered_json flight_tolerance_schema();  ///< of tolerance --flight
nlohmann::ordered_json optimum_schema();
nlohmann::ordered_json motors_schema();        ///< an optimum for each motor of a catalogue, or for each choice
nlohmann::ordered_json drive_trains_schema();  ///< combinations of motors, gearboxes and batteries
nlohmann::ordered_json front_schema();
nlohmann::ordered_json readings_schema();
nlohmann::ordered_json fit_schema();
nlohmann::ordered_json identification_schema();
nlohmann::ordered_json control_schema();
nlohmann::ordered_json scaling_schema();
nlohmann::ordered_json synthesis_schema();
nlohmann::ordered_json validation_schema();
nlohmann::ordered_json kinematics_schema();  ///< of export-kinematics
nlohmann::ordered_json loads_schema();       ///< of compare-loads
nlohmann::ordered_json trim_schema();
nlohmann::ordered_json stability_schema();
nlohmann::ordered_json fly_schema();
nlohmann::ordered_json keys_schema();
nlohmann::ordered_json metrics_schema();

}  // namespace wingbeat::described
