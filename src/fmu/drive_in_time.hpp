// A drive of an FMU in time: a motor with its transmission and wings, or several that move alike, its inputs, its
// continuous time with events located from outside, and its steps through them.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "flight/air_on_body.hpp"
#include "fmu/archive.hpp"
#include "fmu/measured_model.hpp"
#include "fmu/variables.hpp"

namespace wingbeat::fmu {

/// In the order of InputId.
struct Inputs {
  double voltage = 0.0, voltage_offset = 0.0, duty = 1.0, load_torque = 0.0, frequency = 0.0;

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.voltage, self.voltage_offset, self.duty, self.load_torque, self.frequency);
  }
};

/// In the order of SettingId.
struct Settings {
  double tolerance = 1e-8, angle = 0.0, speed = 0.0, current = 0.0, pitch_angle = 0.0, pitch_velocity = 0.0,
         hinge_offset = 0.0;

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.tolerance, self.angle, self.speed, self.current, self.pitch_angle, self.pitch_velocity,
               self.hinge_offset);
  }
};

/// Member `number` in the order of the list; nullptr behind the last.
template <class List>
auto* member_of(List& list, std::size_t number) {
  return List::members(list, [number](auto&... member) {
    const std::array all = {&member...};
    return number < sizeof...(member) ? all[number] : nullptr;
  });
}

/// jammed: time does not go on; failed: the integrator could not go on; too_much: the work that a step may take does
/// not suffice.
enum class StepResult { reached, jammed, failed, too_much };

class DriveInTime {
 public:
  DriveInTime(const Design<double>& design, bool one_of_two, const Settings& settings);
  DriveInTime(const DriveInTime&) = delete;

  /// The model anew, at the start; inputs that were set stay. Throws ParameterError for a vehicle out of range or whose
  /// states are others.
  void build(const Design<double>& design, const Settings& settings);
  /// The model with other parameters where it is. Throws as build() does, and stays as it was then.
  void change(const Design<double>& design, const Settings& settings);
  void initialise(const Design<double>& design, const Settings& settings, double time);
  /// Inputs as the vehicle states them; none counts as set.
  void forget_inputs() { inputs_set_ = 0; }
  /// Its wings feel from now on how a body moves, by these strips.
  void feel(std::shared_ptr<const OnsetFlow> flow, const WakeStrips<double>& strips);

  std::optional<double> input(std::size_t index) const;
  /// False where it cannot be that.
  bool set_input(std::size_t index, double value);

  const StateLayout& layout() const { return layout_; }
  const Vehicle<double>& vehicle() const;
  double time() const;
  void set_time(double t);
  std::vector<double> states() const;
  void set_states(const double* y);
  /// Rates of all states at what acts.
  std::vector<double> rates() const;
  std::vector<double> nominals() const;

  /// A change of a state or an input, by its index.
  struct Direction {
    VariableKind kind;
    std::size_t index;
    double change;
  };
  /// What acts, of the vehicle as parameters and inputs are, at the model's state; on dual numbers along `knowns`.
  template <Scalar S>
  Dynamics<S> now(const std::vector<Direction>& knowns) const;
  template <Scalar S>
  S output(OutputId which, const Dynamics<S>& dynamics) const;
  /// 0 where there was no whole cycle since the last standstill.
  double mean(MeanId which) const;
  Status status() const;
  std::int64_t cycles() const;

  std::size_t indicator_count() const { return watched_.size(); }
  /// Positive until what they indicate happens.
  std::vector<double> indicators() const;
  /// Does what is due.
  void handle_events();
  /// Time of the next event that is known beforehand; infinite where there is none.
  double next_event() const;
  bool ended() const;

  /// Through its events to the time `until`, by no more than `work` evaluations of the rates. It stays where it was
  /// but for `reached` and `jammed`.
  StepResult step_to(double until, double tolerance, std::int64_t work);
  /// What a step of drive and body together takes.
  MeasuredModel& begin_step();
  /// Of a drive that feels a flow, as it is now.
  detail::DriveInstant instant_now() const;

  /// What moves, to go back to.
  struct Moving {
    std::vector<double> numbers;
    CycleMeans means;
  };
  Moving motion() const;
  void set_motion(const Moving& to);
  /// What moves, with the inputs.
  struct Held {
    Moving moving;
    Inputs inputs;
    unsigned inputs_set;
  };
  Held hold() const { return {motion(), inputs_, inputs_set_}; }
  void release(const Held& to);

  void save(ArchiveWriter& out) const;
  /// What save() wrote, of the vehicle and settings of then.
  void restore(ArchiveReader& in, const Design<double>& design, const Settings& settings);

 private:
  void start(const Settings& settings);
  void apply_inputs();
  double voltage_scale() const;
  void feel_flow();
  /// The sizes of a drive on a body at rest, wherever it flies.
  void scale_to(double voltage);

  bool one_of_two_;
  Inputs inputs_, stated_inputs_;
  unsigned inputs_set_ = 0;                ///< bits, by index
  std::shared_ptr<const OnsetFlow> flow_;  ///< none of a vehicle without a body
  WakeStrips<double> strips_;
  StateLayout layout_;
  MeasuredModel model_;
  std::vector<Watched> watched_;
  double scaled_to_ = 0.0;  ///< [V]
};

}  // namespace wingbeat::fmu
