#include "fmu/binary/component.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "fmu/archive.hpp"
#include "fmu/dependencies.hpp"
#include "fmu/package.hpp"

namespace wingbeat::fmu {
namespace {

using Phase = Component::Phase;

std::string content_of(const std::string& file) {
  std::FILE* const in = std::fopen(file.c_str(), "rb");
  if (!in) throw std::runtime_error("cannot open " + file);
  std::string content;
  char part[4096];
  for (std::size_t n; (n = std::fread(part, 1, sizeof part, in)) > 0;) content.append(part, n);
  std::fclose(in);
  return content;
}

std::string with_number(const char* pattern, double x) {
  char text[200];
  std::snprintf(text, sizeof text, pattern, x);
  return text;
}

/// FNV's check sum of 64 bits.
std::uint64_t sum_of(std::string_view bytes) {
  std::uint64_t sum = 14695981039346656037ull;
  for (const unsigned char c : bytes) sum = (sum ^ c) * 1099511628211ull;
  return sum;
}

/// A saved state is this, its size, its check sum and what Component::save() writes.
constexpr std::string_view state_head = "wingbeat FMU state 2\n";
constexpr std::size_t state_overhead = state_head.size() + 2 * sizeof(std::uint64_t);

std::string sealed(const std::string& content) {
  ArchiveWriter out;
  out.bytes = state_head;
  out(std::uint64_t(state_overhead + content.size())), out(sum_of(content));
  return out.bytes + content;
}

/// What was sealed; empty for anything else. Reads no more bytes than there must be.
std::optional<std::string_view> unsealed(std::string_view bytes) {
  if (bytes.size() < state_overhead || bytes.substr(0, state_head.size()) != state_head) return std::nullopt;
  ArchiveReader in(bytes.substr(state_head.size(), 2 * sizeof(std::uint64_t)));
  const auto size = in.value<std::uint64_t>(), sum = in.value<std::uint64_t>();
  const std::string_view content = bytes.substr(state_overhead);
  if (size != bytes.size() || sum != sum_of(content)) return std::nullopt;
  return content;
}

/// The states of all instances that have not been freed: another pointer is an error of the importer, not a crash.
class SavedStates {
 public:
  void* keep(std::string bytes) {
    auto state = std::make_unique<std::string>(std::move(bytes));
    const std::lock_guard<std::mutex> lock(mutex_);
    void* const key = state.get();
    states_.emplace(key, std::move(state));
    return key;
  }
  /// A copy: another thread may free it.
  std::optional<std::string> find(const void* key) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = states_.find(key);
    return found == states_.end() ? std::nullopt : std::optional(*found->second);
  }
  bool replace(const void* key, std::string& bytes) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = states_.find(key);
    if (found == states_.end()) return false;
    found->second->swap(bytes);
    return true;
  }
  bool drop(const void* key) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return states_.erase(key) > 0;
  }

 private:
  std::mutex mutex_;
  std::map<const void*, std::unique_ptr<std::string>> states_;
};

SavedStates& saved_states() {
  static SavedStates all;
  return all;
}

constexpr const char* no_state = "this is no saved state, or it has been freed";

}  // namespace

Component::Component(const std::string& resources, const std::string& token, bool co_simulation, Logger log)
    : co_simulation_(co_simulation), log_(std::move(log)), token_(token) {
  const std::string content = content_of(resources + "/" + vehicle_resource);
  if (token_of(content) != token) throw std::runtime_error("the token is not that of this FMU's model description");
  instance_ = std::make_unique<Instance>(design_of(content));
  for (Variable& v : variables_of(instance_->design())) variables_.emplace(v.reference(), std::move(v));
}

int Component::refuse(const std::string& message, StatusCode status) const {
  if (log_) log_(status, status == discard ? "logStatusDiscard" : "logStatusError", message);
  return status;
}

int Component::failed(const char* function, const char* problem) const noexcept {
  try {
    return refuse(std::string(function) + ": " + problem);
  } catch (...) {
    return error;
  }
}

template <class Work>
int Component::in_phases(const char* function, std::initializer_list<Phase> allowed, const Work& work) {
  if (std::find(allowed.begin(), allowed.end(), phase_) == allowed.end()) {
    return refuse(std::string(function) + ": must not be called now");
  }
  return work();
}

int Component::enter_initialisation(bool has_tolerance, double tolerance, double start) {
  return in_phases("EnterInitializationMode", {Phase::instantiated}, [&] {
    if (!(std::abs(start) <= latest_time)) {
      return refuse(with_number("the start time must be a number of at most 1e6 s, and is %g s", start));
    }
    if (has_tolerance && tolerance > 0.0) {
      const std::size_t reference = reference_of(VariableKind::setting, std::size_t(SettingId::tolerance));
      instance_->set_real(reference, std::clamp(0.01 * tolerance, 1e-12, 1e-2));
    }
    start_ = start;
    instance_->initialise(start_);
    phase_ = Phase::initialising;
    return int(ok);
  });
}

int Component::exit_initialisation() {
  return in_phases("ExitInitializationMode", {Phase::initialising}, [&] {
    instance_->initialise(start_);
    if (co_simulation_) instance_->handle_events();
    else known_rates_ = instance_->rates();
    phase_ = co_simulation_ ? Phase::stepping : Phase::event;
    return int(ok);
  });
}

int Component::terminate() {
  return in_phases("Terminate", {Phase::event, Phase::continuous, Phase::stepping}, [&] {
    phase_ = Phase::terminated;
    return int(ok);
  });
}

int Component::reset() {
  instance_->reset();
  phase_ = Phase::instantiated;
  return ok;
}

int Component::get_reals(const unsigned* references, std::size_t count, double* values) {
  for (std::size_t n = 0; n < count; ++n) {
    const auto value = variables_.count(references[n]) ? instance_->real(references[n]) : std::nullopt;
    if (!value) return refuse("there is no real variable with the value reference " + std::to_string(references[n]));
    values[n] = *value;
  }
  return ok;
}

bool Component::may_set(const Variable& v) const {
  if (phase_ == Phase::instantiated || phase_ == Phase::initialising) {
    return v.causality == "parameter" || v.causality == "input";
  }
  if (v.causality == "input") {
    return phase_ == Phase::event || phase_ == Phase::stepping ||
           (phase_ == Phase::continuous && v.variability == "continuous");
  }
  return v.variability == "tunable" && (phase_ == Phase::event || phase_ == Phase::stepping);
}

int Component::set_reals(const unsigned* references, std::size_t count, const double* values) {
  for (std::size_t n = 0; n < count; ++n) {
    const auto variable = variables_.find(references[n]);
    if (variable == variables_.end()) {
      return refuse("there is no real variable with the value reference " + std::to_string(references[n]));
    }
    const std::string& name = variable->second.name;
    if (!may_set(variable->second)) return refuse(name + " must not be set now");
    if (!std::isfinite(values[n]) || !instance_->set_real(references[n], values[n])) {
      return refuse(name + " must not be " + std::to_string(values[n]));
    }
  }
  if (phase_ != Phase::initialising) return ok;
  return in_phases("SetReal", {Phase::initialising}, [&] {
    instance_->initialise(start_);
    return int(ok);
  });
}

int Component::get_wholes(const unsigned* references, std::size_t count, int* values, bool status) {
  for (std::size_t n = 0; n < count; ++n) {
    const auto variable = variables_.find(references[n]);
    if (variable == variables_.end() || variable->second.kind != VariableKind::count ||
        variable->second.is_status() != status) {
      return refuse(std::string("there is no ") + (status ? "enumeration" : "integer variable") +
                    " with the value reference " + std::to_string(references[n]));
    }
    values[n] = instance_->whole(references[n]).value_or(0);
  }
  return ok;
}

int Component::get_integers(const unsigned* references, std::size_t count, int* values) {
  for (std::size_t n = 0; n < count; ++n) {
    const auto variable = variables_.find(references[n]);
    const bool status = variable != variables_.end() && variable->second.is_status();
    if (const int code = get_wholes(references + n, 1, values + n, status); code != ok) return code;
  }
  return ok;
}

int Component::get_texts(const unsigned* references, std::size_t count, const char** values) {
  texts_.clear();
  std::vector<std::size_t> places;
  for (std::size_t n = 0; n < count; ++n) {
    if (!variables_.count(references[n]) || kind_of(references[n]) != VariableKind::text) {
      return refuse("there is no string variable with the value reference " + std::to_string(references[n]));
    }
    places.push_back(texts_.size());
    texts_ += instance_->text(references[n]) + '\0';
  }
  for (std::size_t n = 0; n < count; ++n) values[n] = texts_.data() + places[n];
  return ok;
}

int Component::check_values(const char* function, std::size_t count,
                            std::initializer_list<const void*> pointers) const {
  constexpr std::size_t max_count = 1'000'000;
  if (count > max_count) return refuse(std::string(function) + ": " + std::to_string(count) + " values are too many");
  const bool missing = std::find(pointers.begin(), pointers.end(), nullptr) != pointers.end();
  return count > 0 && missing ? refuse(std::string(function) + ": a pointer is null") : int(ok);
}

std::vector<std::size_t> Component::dependencies(std::size_t reference) const {
  return variables_.count(reference) ? dependencies_of(instance_->exported_design(), reference)
                                     : std::vector<std::size_t>();
}

int Component::save(void** state) {
  ArchiveWriter out;
  out(token_), out(co_simulation_), out(phase_), out(start_), out(known_rates_);
  std::string bytes = sealed(out.bytes + instance_->save());
  if (*state == nullptr) *state = saved_states().keep(std::move(bytes));
  else if (!saved_states().replace(*state, bytes)) return refuse(std::string("GetFMUState: ") + no_state);
  return ok;
}

int Component::restore(const void* state) {
  const std::optional<std::string> bytes = saved_states().find(state);
  const auto content = bytes ? unsealed(*bytes) : std::nullopt;
  if (!content) return refuse(std::string("SetFMUState: ") + no_state);
  ArchiveReader in(*content);
  const auto token = in.value<std::string>();
  const bool co_simulation = in.value<bool>();
  if (token != token_ || co_simulation != co_simulation_) {
    return refuse("SetFMUState: the state is that of another FMU or of another kind of instance");
  }
  const auto phase = in.value<Phase>();
  const auto start = in.value<double>();
  auto rates = in.value<std::vector<double>>();
  instance_->restore(std::string(in.rest()));
  phase_ = phase;
  start_ = start;
  known_rates_ = std::move(rates);
  return ok;
}

int Component::free_state(void** state) {
  if (!state || !*state) return ok;
  const bool there = saved_states().drop(*state);
  *state = nullptr;
  return there ? int(ok) : refuse(std::string("FreeFMUState: ") + no_state);
}

int Component::size_of(const void* state, std::size_t* size) {
  const std::optional<std::string> bytes = saved_states().find(state);
  if (!bytes) return refuse(std::string("SerializedFMUStateSize: ") + no_state);
  *size = bytes->size();
  return ok;
}

int Component::serialise(const void* state, void* bytes, std::size_t size) {
  const std::optional<std::string> from = saved_states().find(state);
  if (!from) return refuse(std::string("SerializeFMUState: ") + no_state);
  if (size < from->size()) {
    return refuse("SerializeFMUState: " + std::to_string(size) + " bytes are fewer than the " +
                  std::to_string(from->size()) + " of the state");
  }
  std::memcpy(bytes, from->data(), from->size());
  return ok;
}

int Component::deserialise(const void* bytes, std::size_t size, void** state) {
  // A string_view cannot be longer: such a size is no size of anything.
  const bool possible = size <= std::string_view().max_size() / 2;
  const std::string_view given(static_cast<const char*>(bytes), possible ? size : 0);
  if (!unsealed(given)) {
    return refuse("DeserializeFMUState: these " + std::to_string(size) + " bytes are no state that was serialised");
  }
  std::string copy(given);
  if (*state == nullptr) *state = saved_states().keep(std::move(copy));
  else if (!saved_states().replace(*state, copy)) return refuse(std::string("DeserializeFMUState: ") + no_state);
  return ok;
}

int Component::directional(const unsigned* unknowns, std::size_t unknown_count, const unsigned* knowns,
                           std::size_t known_count, const double* seed, std::size_t seed_count, double* sensitivity,
                           std::size_t sensitivity_count) {
  const auto phases = {Phase::initialising, Phase::event, Phase::continuous, Phase::stepping};
  return in_phases("GetDirectionalDerivative", phases, [&] {
    if (seed_count != known_count || sensitivity_count != unknown_count) return refuse("as many seeds as knowns");
    std::vector<Instance::Direction> along;
    for (std::size_t n = 0; n < known_count; ++n) {
      const VariableKind kind = kind_of(knowns[n]);
      if (!variables_.count(knowns[n]) || (kind != VariableKind::state && kind != VariableKind::input)) {
        return refuse("derivatives are by states and inputs alone");
      }
      along.push_back({knowns[n], seed[n]});
    }
    std::vector<std::size_t> outputs;
    for (std::size_t n = 0; n < unknown_count; ++n) {
      const VariableKind kind = kind_of(unknowns[n]);
      if (!variables_.count(unknowns[n]) || (kind != VariableKind::derivative && kind != VariableKind::output)) {
        return refuse("derivatives are of state derivatives and continuous outputs alone");
      }
      outputs.push_back(unknowns[n]);
    }
    const std::vector<double> found = instance_->directional(outputs, along);
    std::copy(found.begin(), found.end(), sensitivity);
    return int(ok);
  });
}

int Component::enter_event_mode() {
  return in_phases("EnterEventMode", {Phase::continuous}, [&] {
    known_rates_ = instance_->rates();
    phase_ = Phase::event;
    return int(ok);
  });
}

int Component::update_discrete(Updated& to) {
  return in_phases("NewDiscreteStates", {Phase::event}, [&] {
    to = {};
    const std::vector<double> before = instance_->states();
    instance_->handle_events();
    // Importers may restart their integrators only where states change: a rate that jumps ends a smooth piece as well,
    // be it by what happens here or by an input that was set.
    const std::vector<double> rates = instance_->rates();
    to.states_changed = instance_->states() != before || rates != known_rates_;
    known_rates_ = rates;
    to.terminate = instance_->ended();
    const double next = instance_->next_event();
    to.next_event_defined = std::isfinite(next);
    to.next_event = to.next_event_defined ? next : 0.0;
    return int(ok);
  });
}

int Component::enter_continuous_mode() {
  return in_phases("EnterContinuousTimeMode", {Phase::event}, [&] {
    phase_ = Phase::continuous;
    return int(ok);
  });
}

int Component::set_time(double t) {
  return in_phases("SetTime", {Phase::event, Phase::continuous}, [&] {
    if (!(std::abs(t) <= latest_time)) {
      return refuse(with_number("SetTime: the time must be a number of at most 1e6 s, and is %g s", t));
    }
    instance_->set_time(t);
    return int(ok);
  });
}

int Component::get_states(double* y, std::size_t count) {
  const std::vector<double> states = instance_->states();
  if (count != states.size()) return refuse("wrong number of continuous states");
  std::copy(states.begin(), states.end(), y);
  return ok;
}

int Component::set_states(const double* y, std::size_t count) {
  return in_phases("SetContinuousStates", {Phase::event, Phase::continuous}, [&] {
    if (count != state_count()) return refuse("wrong number of continuous states");
    if (!std::all_of(y, y + count, [](double x) { return std::isfinite(x); })) {
      return refuse("the continuous states are not finite", discard);
    }
    instance_->set_states(y);
    return int(ok);
  });
}

int Component::get_rates(double* dy, std::size_t count) {
  const std::vector<double> rates = instance_->rates();
  if (count != rates.size()) return refuse("wrong number of derivatives");
  std::copy(rates.begin(), rates.end(), dy);
  if (std::all_of(rates.begin(), rates.end(), [](double x) { return std::isfinite(x); })) return ok;
  return refuse("the derivatives are not finite", discard);
}

int Component::get_indicators(double* z, std::size_t count) {
  const std::vector<double> values = instance_->indicators();
  if (count != values.size()) return refuse("wrong number of event indicators");
  std::copy(values.begin(), values.end(), z);
  return ok;
}

int Component::get_nominals(double* sizes, std::size_t count) {
  const std::vector<double> nominals = instance_->nominals();
  if (count != nominals.size()) return refuse("wrong number of nominals");
  std::copy(nominals.begin(), nominals.end(), sizes);
  return ok;
}

int Component::step(double from, double length) {
  return in_phases("DoStep", {Phase::stepping}, [&] {
    if (!std::isfinite(from)) return refuse("DoStep: the communication point must be a finite number");
    if (!std::isfinite(length)) return refuse("DoStep: the step must be a finite number of seconds");
    if (length < 0.0) return refuse("DoStep: a step must not go back");
    const double here = instance_->time();
    if (std::abs(from - here) > 1e-9 * std::max({1e-3, std::abs(here), length})) {
      return refuse("DoStep: the communication point is not where the last step ended");
    }
    if (length > longest_step) {
      return refuse(with_number("DoStep: a step must be of at most 1000 s, and is of %g s", length), discard);
    }
    if (!(from + length <= latest_time)) {
      return refuse(with_number("DoStep: time ends at 1e6 s, and the step at %g s", from + length), discard);
    }
    if (length == 0.0) return int(ok);
    switch (instance_->step_to(from + length)) {
      case StepResult::reached: return int(ok);
      case StepResult::jammed: return refuse("DoStep: the mechanism has jammed; time does not go on", discard);
      case StepResult::too_much:
        return refuse(with_number("DoStep: a step of %g s takes too much computing: take shorter steps", length),
                      discard);
      case StepResult::failed: break;
    }
    return refuse("DoStep: the integrator could not go on", discard);
  });
}

}  // namespace wingbeat::fmu
