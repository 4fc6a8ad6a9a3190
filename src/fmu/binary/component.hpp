// An instance as the functions of FMI 2 and FMI 3 see it: what may be called when, logging, saved states.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "fmu/instance.hpp"

namespace wingbeat::fmu {

/// Numbered alike in FMI 2 and FMI 3.
enum StatusCode { ok = 0, warning = 1, discard = 2, error = 3, fatal = 4 };

class Component {
 public:
  enum class Phase { instantiated, initialising, event, continuous, stepping, terminated, failed };
  using Logger = std::function<void(StatusCode status, const char* category, const std::string& message)>;

  /// From the folder `resources` of an unpacked FMU. Throws std::runtime_error, also where `token` is not the FMU's.
  Component(const std::string& resources, const std::string& token, bool co_simulation, Logger log);

  int enter_initialisation(bool has_tolerance, double tolerance, double start);
  int exit_initialisation();
  int terminate();
  int reset();

  int get_reals(const unsigned* references, std::size_t count, double* values);
  int set_reals(const unsigned* references, std::size_t count, const double* values);
  int get_wholes(const unsigned* references, std::size_t count, int* values);
  /// The texts live until the next call.
  int get_texts(const unsigned* references, std::size_t count, const char** values);
  /// For types that no variable has: right for none, wrong for any.
  int get_none(std::size_t count, const char* type);

  // ---- saved states, as the standard passes them on: made by save() or deserialise(), gone with free_state()
  int save(void** state);
  int restore(const void* state);
  static void free_state(void** state);
  static std::size_t size_of(const void* state);
  int serialise(const void* state, void* bytes, std::size_t size);
  static void deserialise(const void* bytes, std::size_t size, void** state);

  int directional(const unsigned* unknowns, std::size_t unknown_count, const unsigned* knowns, std::size_t known_count,
                  const double* seed, std::size_t seed_count, double* sensitivity, std::size_t sensitivity_count);

  // ---- model exchange
  struct Updated {
    bool states_changed = false, terminate = false, next_event_defined = false;
    double next_event = 0.0;
  };
  int enter_event_mode();
  int update_discrete(Updated& to);
  int enter_continuous_mode();
  int set_time(double t);
  int get_states(double* y, std::size_t count);
  int set_states(const double* y, std::size_t count);
  int get_rates(double* dy, std::size_t count);
  int get_indicators(double* z, std::size_t count);
  int get_nominals(double* sizes, std::size_t count);
  std::size_t state_count() const { return instance_->state_count(); }
  std::size_t indicator_count() const { return instance_->indicator_count(); }
  bool ended() const { return instance_->ended(); }

  // ---- co-simulation
  int step(double from, double length);
  double time() const { return instance_->time(); }
  const Design<double>& design() const { return instance_->design(); }

  void log(StatusCode status, const char* category, const std::string& message) const {
    if (log_) log_(status, category, message);
  }
  /// Error, logged.
  int unsupported(const char* what) const { return refuse(std::string(what) + " is not supported by this FMU"); }

 private:
  /// Does what may be done in these phases; what it throws is logged and an error.
  template <class Work>
  int in_phases(const char* function, std::initializer_list<Phase> allowed, const Work& work);
  int refuse(const std::string& message, StatusCode status = error) const;
  bool may_set(const Variable& variable) const;

  std::unique_ptr<Instance> instance_;
  std::map<std::size_t, Variable> variables_;
  bool co_simulation_;
  Logger log_;
  Phase phase_ = Phase::instantiated;
  double start_ = 0.0;
  std::string texts_;
};

}  // namespace wingbeat::fmu
