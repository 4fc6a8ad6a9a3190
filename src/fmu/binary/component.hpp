// An instance as the functions of FMI 2 and FMI 3 see it: what may be called when, logging, saved states.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fmu/instance.hpp"

namespace wingbeat::fmu {

/// Times that an instance takes, and how long a step of co-simulation may be [s].
inline constexpr double latest_time = 1e6, longest_step = 1e3;

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
  /// Whole numbers or, where `status` is asked for, enumerations.
  int get_wholes(const unsigned* references, std::size_t count, int* values, bool status);
  /// Of FMI 2, whose function gets either.
  int get_integers(const unsigned* references, std::size_t count, int* values);
  /// The texts live until the next call.
  int get_texts(const unsigned* references, std::size_t count, const char** values);
  /// Not ok, logged, for more values than an importer can mean, and for pointers that are null where there are some.
  int check_values(const char* function, std::size_t count, std::initializer_list<const void*> pointers) const;

  // ---- saved states: made by save() or deserialise(), gone with free_state(). Any other pointer is refused.
  int save(void** state);
  int restore(const void* state);
  int free_state(void** state);
  int size_of(const void* state, std::size_t* size);
  int serialise(const void* state, void* bytes, std::size_t size);
  int deserialise(const void* bytes, std::size_t size, void** state);

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
  /// Which knowns a variable depends on, by value references.
  std::vector<std::size_t> dependencies(std::size_t reference) const;

  /// Error, logged.
  int unsupported(const char* what) const { return refuse(std::string(what) + " is not supported by this FMU"); }
  int refuse(const std::string& message, StatusCode status = error) const;
  /// Error of a function that threw, logged; throws nothing itself.
  int failed(const char* function, const char* problem) const noexcept;

 private:
  /// Does what may be done in these phases; what it throws is logged and an error.
  template <class Work>
  int in_phases(const char* function, std::initializer_list<Phase> allowed, const Work& work);
  bool may_set(const Variable& variable) const;

  std::unique_ptr<Instance> instance_;
  std::map<std::size_t, Variable> variables_;
  bool co_simulation_;
  Logger log_;
  Phase phase_ = Phase::instantiated;
  double start_ = 0.0;
  std::string token_, texts_;
  std::vector<double> known_rates_;  ///< that the importer integrates with
};

/// work(instance), whatever it throws, which ends no host: an error, logged.
template <class Work>
int guarded(Component* instance, const char* function, const Work& work) noexcept {
  if (!instance) return error;
  try {
    return work(*instance);
  } catch (const std::exception& problem) {
    return instance->failed(function, problem.what());
  } catch (...) {
    return instance->failed(function, "failed");
  }
}
/// Calls a function of the standard with `count` values at pointers that must not be null then.
template <class Work, class... Pointers>
int guarded_values(Component* instance, const char* function, std::size_t count, const Work& work,
                   const Pointers*... pointers) noexcept {
  return guarded(instance, function, [&](Component& component) {
    const int wrong = component.check_values(function, count, {static_cast<const void*>(pointers)...});
    return wrong ? wrong : work(component);
  });
}

}  // namespace wingbeat::fmu
