#include <optional>

#include "explored.hpp"
#include "files/motor_catalogue.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat::web {

Json motors_for(const Design<double>& design, const std::string& catalogue, double gear) {
  Json motors = Json::array();
  for (const MotorCandidate& motor :
       detail::parse_motor_catalogue(catalogue, "motors.csv", gear, std::nullopt, design)) {
    Json entry = {{"model", motor.model},
                  {"refused", motor.refused.empty() ? Json(nullptr) : Json(motor.refused)},
                  {"values", Json::object()}};
    if (motor.refused.empty()) {
      for (const Parameter<double>& key : parameter_table<double>()) {
        if (!key.get || !key.path.starts_with("motor.")) continue;
        if (const std::optional<double> number = key.get(motor.design))
          entry["values"][std::string(key.path)] = *number;
      }
    }
    motors.push_back(std::move(entry));
  }
  return {{"motors", std::move(motors)}};
}

}  // namespace wingbeat::web
