// One vehicle of an FMU: its variables, and its one drive or two in time. Knows nothing of the functions of the
// standard, which binary/ has.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fmu/body_in_time.hpp"
#include "fmu/drive_in_time.hpp"

namespace wingbeat::fmu {

/// Evaluations of the rates that a step may take: half a minute, about.
#ifndef WINGBEAT_FMU_WORK
#define WINGBEAT_FMU_WORK 40'000'000
#endif
inline constexpr std::int64_t step_work = WINGBEAT_FMU_WORK;

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
  /// Sets a parameter, setting or input. False where it cannot be set. An input that was set keeps its value whatever
  /// parameters are set.
  bool set_real(std::size_t reference, double value);

  // ---- continuous time
  /// Of both drives where there are two, the left one first, then of the body where there is one.
  std::size_t state_count() const;
  std::vector<double> states() const;
  void set_states(const double* y);
  void set_time(double t);
  double time() const { return drives_[0]->time(); }
  std::vector<double> rates() const;
  std::vector<double> nominals() const;
  std::size_t indicator_count() const;
  /// Positive until what they indicate happens.
  std::vector<double> indicators() const;
  /// Derivative of an unknown (output or derivative) along a direction of knowns (states, inputs).
  struct Direction {
    std::size_t reference;
    double change;
  };
  std::vector<double> directional(const std::vector<std::size_t>& unknowns, const std::vector<Direction>& knowns);

  // ---- events
  /// Does what is due.
  void handle_events();
  /// Time of the next event that is known beforehand; infinite where there is none.
  double next_event() const;
  bool ended() const;

  // ---- co-simulation
  /// Through its events to the time `until`, each drive, or body and drives together, by no more than `work`
  /// evaluations of the rates. It stays where it was but for `reached` and `jammed`.
  StepResult step_to(double until, std::int64_t work = step_work);

  /// All that changes, as bytes.
  std::string save() const;
  /// Throws std::runtime_error for bytes that save() of this vehicle did not write, and stays as it is.
  void restore(const std::string& bytes);

  /// With its parameters as they are now, and as it was exported.
  const Design<double>& design() const { return design_; }
  const Design<double>& exported_design() const { return given_; }

 private:
  void apply_parameters();
  /// What the body's motion is to the drives, before they are asked for anything.
  void meet_air() const;
  StepResult fly_to(double until, std::int64_t work);
  std::vector<double> differences(const std::vector<std::size_t>& unknowns, const std::vector<Direction>& knowns);
  std::optional<double> real_of_body(VariableKind kind, std::size_t index) const;
  std::vector<std::unique_ptr<DriveInTime>> drives_of(const Design<double>& design) const;
  /// Of the drive that a side is; nullptr where there is none.
  const DriveInTime* drive(std::size_t side) const;
  template <Scalar S>
  S output(OutputId which, std::size_t side, const std::vector<Dynamics<S>>& dynamics) const;

  Design<double> given_, design_;
  bool two_;
  Settings settings_;
  std::vector<std::unique_ptr<DriveInTime>> drives_;
  std::unique_ptr<BodyInTime> body_;  ///< none of a vehicle without
  bool changed_ = false;              ///< parameters wait to be applied
};

}  // namespace wingbeat::fmu
