// How the library says no: bad parameters throw, outcomes of a computation are returned.
#pragma once

#include <stdexcept>
#include <string>

namespace wingbeat {

/// A parameter out of its physical range. `key` is the parameter's name in a vehicle file, e.g.
/// "motor.armature_resistance"; what() names key, value and the allowed range with its unit.
class ParameterError : public std::invalid_argument {
 public:
  ParameterError(std::string key, const std::string& message)
      : std::invalid_argument(key + ": " + message), key_(std::move(key)), reason_(message) {}
  const std::string& key() const { return key_; }
  const std::string& reason() const { return reason_; }

 private:
  std::string key_;
  std::string reason_;
};

/// What a design does once it is switched on.
enum class FlappingStatus {
  flapping,  ///< a steady rotating orbit exists and start-up from rest reaches it
  stalled,   ///< the motor never starts: its stall torque does not exceed the constant friction
  locked,    ///< the crank comes to rest at an angle (springs, or friction against them)
  jammed,    ///< the mechanism's equations lose their unique solution on the way (light rotor, strong friction)
  undecided  ///< none of these was shown within the solver's limits; reported as no status at all, with the evidence
};

inline const char* name_of(FlappingStatus status) {
  switch (status) {
    case FlappingStatus::flapping: return "flapping";
    case FlappingStatus::stalled: return "stalled";
    case FlappingStatus::locked: return "locked";
    case FlappingStatus::jammed: return "jammed";
    case FlappingStatus::undecided: return "undecided";
  }
  return "unknown";
}

/// "must be > 0 [ohm], got -9": the text shared by every range check.
std::string range_message(const char* expected, const char* unit, double value);

/// Throws ParameterError for `key` unless the condition holds.
void require(bool condition, const char* key, const char* expected, const char* unit, double value);

}  // namespace wingbeat
