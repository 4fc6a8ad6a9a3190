// One vehicle of an FMU: its variables, its continuous time with events located from outside, and its steps through
// them. Knows nothing of the functions of the standard, which binary/ has.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "fmu/measured_model.hpp"
#include "fmu/variables.hpp"

namespace wingbeat::fmu {

using AnyModel = std::variant<MeasuredModel<detail::CrankModel>, MeasuredModel<detail::DirectModel>,
                              MeasuredModel<detail::PitchDirectModel>>;

/// In the order of InputId.
struct Inputs {
  double voltage = 0.0, voltage_offset = 0.0, duty = 1.0, load_torque = 0.0;

  template <class Self, class Use>
  static constexpr auto members(Self& of, const Use& use) {
    return use(of.voltage, of.voltage_offset, of.duty, of.load_torque);
  }
};

/// In the order of SettingId.
struct Settings {
  double tolerance = 1e-8, angle = 0.0, speed = 0.0, current = 0.0, pitch_angle = 0.0, pitch_velocity = 0.0;

  template <class Self, class Use>
  static constexpr auto members(Self& of, const Use& use) {
    return use(of.tolerance, of.angle, of.speed, of.current, of.pitch_angle, of.pitch_velocity);
  }
};

class Instance {
 public:
  explicit Instance(const Design<double>& design);
  Instance(const Instance&) = delete;

  /// Back to what the design says, before initialisation.
  void reset();
  /// The state at the start, from parameters and settings. Throws ParameterError for values out of range.
  void initialise(double time);

  /// Of reals of any kind, and of whole numbers; empty: there is no such variable.
  std::optional<double> real(std::size_t reference) const;
  std::optional<int> whole(std::size_t reference) const;
  std::string text(std::size_t reference) const;
  /// Sets a parameter, setting or input. False where it cannot be set.
  bool set_real(std::size_t reference, double value);

  // ---- continuous time
  std::size_t state_count() const { return places_.count + exposed_sum_count; }
  std::vector<double> states() const;
  void set_states(const double* y);
  void set_time(double t);
  double time() const;
  std::vector<double> rates() const;
  std::vector<double> nominals() const;
  std::size_t indicator_count() const { return watched_.size(); }
  /// Positive until what they indicate happens.
  std::vector<double> indicators() const;
  /// Derivative of an unknown (output or derivative) along a direction of knowns (states, inputs).
  struct Direction {
    std::size_t reference;
    double change;
  };
  std::vector<double> directional(const std::vector<std::size_t>& unknowns, const std::vector<Direction>& knowns) const;

  // ---- events
  /// Does what is due. True where states have changed.
  bool handle_events();
  /// Time of the next event that is known beforehand; infinite where there is none.
  double next_event() const;
  bool ended() const;

  // ---- co-simulation
  /// Through its events to the time `until`. False where it has jammed on the way, or where the integrator could not go
  /// on: it stands where it was then.
  bool step_to(double until);

  /// All that changes, as bytes.
  std::string save() const;
  void restore(const std::string& bytes);

  const Design<double>& design() const { return design_; }

 private:
  /// Of the vehicle as parameters and inputs are, at the model's state.
  template <Scalar S>
  Everything<S> now(const std::vector<Direction>& knowns) const;
  void build();
  void start_model();
  void apply_inputs();
  void apply_parameters();
  double supply_voltage_scale() const;
  const Vehicle<double>& vehicle() const;

  Design<double> given_, design_;
  Inputs inputs_, given_inputs_;
  Settings settings_;
  Places places_;
  Supply<double> supply_;
  AnyModel model_;
  std::vector<std::size_t> watched_;  ///< indicators of the model that are events
  bool changed_ = false;              ///< parameters wait to be applied
  double scaled_to_ = 0.0;            ///< [V]
};

}  // namespace wingbeat::fmu
