#include "fmu/binary/component.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "fmu/archive.hpp"
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

}  // namespace

Component::Component(const std::string& resources, const std::string& token, bool co_simulation, Logger log)
    : co_simulation_(co_simulation), log_(std::move(log)) {
  const std::string content = content_of(resources + "/" + vehicle_resource);
  if (token_of(content) != token) throw std::runtime_error("the token is not that of this FMU's model description");
  instance_ = std::make_unique<Instance>(design_of(content));
  for (Variable& v : variables_of(instance_->design())) variables_.emplace(v.reference(), std::move(v));
}

int Component::refuse(const std::string& message, StatusCode status) const {
  log(status, status == discard ? "logStatusDiscard" : "logStatusError", message);
  return status;
}

template <class Work>
int Component::in_phases(const char* function, std::initializer_list<Phase> allowed, const Work& work) {
  if (std::find(allowed.begin(), allowed.end(), phase_) == allowed.end()) {
    return refuse(std::string(function) + ": must not be called now");
  }
  try {
    return work();
  } catch (const std::exception& problem) {
    return refuse(std::string(function) + ": " + problem.what());
  }
}

int Component::enter_initialisation(bool has_tolerance, double tolerance, double start) {
  return in_phases("EnterInitializationMode", {Phase::instantiated}, [&] {
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
  try {
    instance_->reset();
    phase_ = Phase::instantiated;
    return ok;
  } catch (const std::exception& problem) {
    return refuse(std::string("Reset: ") + problem.what());
  }
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

int Component::get_wholes(const unsigned* references, std::size_t count, int* values) {
  for (std::size_t n = 0; n < count; ++n) {
    const auto value = instance_->whole(references[n]);
    if (!value) return refuse("there is no integer variable with the value reference " + std::to_string(references[n]));
    values[n] = *value;
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

int Component::get_none(std::size_t count, const char* type) {
  return count == 0 ? int(ok) : refuse(std::string("there are no variables of the type ") + type);
}

int Component::save(void** state) {
  std::string bytes = instance_->save();
  bytes += char(phase_);
  if (*state) *static_cast<std::string*>(*state) = std::move(bytes);
  else *state = new std::string(std::move(bytes));
  return ok;
}

int Component::restore(const void* state) {
  try {
    const std::string& from = *static_cast<const std::string*>(state);
    if (from.empty()) throw std::runtime_error("the saved state is empty");
    instance_->restore(from.substr(0, from.size() - 1));
    phase_ = Phase(from.back());
    return ok;
  } catch (const std::exception& problem) {
    return refuse(std::string("SetFMUState: ") + problem.what());
  }
}

void Component::free_state(void** state) {
  if (!state) return;
  delete static_cast<std::string*>(*state);
  *state = nullptr;
}

std::size_t Component::size_of(const void* state) { return static_cast<const std::string*>(state)->size(); }

int Component::serialise(const void* state, void* bytes, std::size_t size) {
  const std::string& from = *static_cast<const std::string*>(state);
  if (size < from.size()) return unsupported("a buffer smaller than the state");
  std::memcpy(bytes, from.data(), from.size());
  return ok;
}

void Component::deserialise(const void* bytes, std::size_t size, void** state) {
  free_state(state);
  *state = new std::string(static_cast<const char*>(bytes), size);
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
    std::vector<std::size_t> of;
    for (std::size_t n = 0; n < unknown_count; ++n) {
      const VariableKind kind = kind_of(unknowns[n]);
      if (!variables_.count(unknowns[n]) || (kind != VariableKind::derivative && kind != VariableKind::output)) {
        return refuse("derivatives are of state derivatives and continuous outputs alone");
      }
      of.push_back(unknowns[n]);
    }
    const std::vector<double> found = instance_->directional(of, along);
    std::copy(found.begin(), found.end(), sensitivity);
    return int(ok);
  });
}

int Component::enter_event_mode() {
  return in_phases("EnterEventMode", {Phase::continuous}, [&] {
    phase_ = Phase::event;
    return int(ok);
  });
}

int Component::update_discrete(Updated& to) {
  return in_phases("NewDiscreteStates", {Phase::event}, [&] {
    to = {};
    to.states_changed = instance_->handle_events();
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
    if (!(length >= 0.0) || !std::isfinite(from)) return refuse("DoStep: a step must not go back");
    const double here = instance_->time();
    if (std::abs(from - here) > 1e-9 * std::max({1e-3, std::abs(here), length})) {
      return refuse("DoStep: the communication point is not where the last step ended");
    }
    if (length == 0.0) return int(ok);
    if (instance_->step_to(from + length)) return int(ok);
    if (instance_->ended()) return refuse("DoStep: the mechanism has jammed; time does not go on", discard);
    return refuse("DoStep: the integrator could not go on", discard);
  });
}

}  // namespace wingbeat::fmu
