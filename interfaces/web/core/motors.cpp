#include <optional>

#include "answers.hpp"
#include "explored.hpp"
#include "files/motor_catalogue.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat::web {

Json motors_for(const Design<double>& design, const std::string& catalogue, double gear) {
  std::vector<OfferedMotor> motors;
  for (const MotorCandidate& motor :
       detail::parse_motor_catalogue(catalogue, "motors.csv", gear, std::nullopt, design)) {
    OfferedMotor offered{motor.model, std::nullopt, {}};
    if (!motor.refused.empty()) offered.refused = motor.refused;
    if (motor.refused.empty()) {
      for (const Parameter<double>& key : parameter_table<double>()) {
        if (!key.get || !key.path.starts_with("motor.")) continue;
        if (const std::optional<double> number = key.get(motor.design)) offered.values.emplace_back(key.path, *number);
      }
    }
    motors.push_back(std::move(offered));
  }
  return motors_answer(motors);
}

}  // namespace wingbeat::web
