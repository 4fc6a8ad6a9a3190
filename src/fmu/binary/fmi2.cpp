// FMI 2.0: model exchange and co-simulation.
#include <cmath>
#include <exception>
#include <stdexcept>
#include <string>

#include "fmu/binary/component.hpp"
#include "fmu/binary/fmi2_functions.h"
#include "fmu/binary/resource_path.hpp"

using wingbeat::fmu::Component;
using wingbeat::fmu::StatusCode;

namespace {

struct Fmi2 {
  Component component;
  double start = 0.0, tolerance = 0.0;
  bool has_tolerance = false;
};

fmi2Status as2(int code) { return fmi2Status(code); }
Component* component2(fmi2Component c) { return c ? &static_cast<Fmi2*>(c)->component : nullptr; }

template <class Work>
fmi2Status with2(fmi2Component c, const char* function, const Work& work) noexcept {
  return as2(wingbeat::fmu::guarded(component2(c), function, work));
}
template <class Work, class... Pointers>
fmi2Status values2(fmi2Component c, const char* function, size_t count, const Work& work,
                   const Pointers*... pointers) noexcept {
  return as2(wingbeat::fmu::guarded_values(component2(c), function, count, work, pointers...));
}
/// What no variable has or nothing supports: right for none of it.
fmi2Status none2(fmi2Component c, const char* function, size_t count, const char* what) noexcept {
  return with2(c, function, [&](Component& component) { return count == 0 ? 0 : component.unsupported(what); });
}

}  // namespace

extern "C" {

const char* fmi2GetTypesPlatform(void) { return "default"; }
const char* fmi2GetVersion(void) { return "2.0"; }

fmi2Status fmi2SetDebugLogging(fmi2Component, fmi2Boolean, size_t, const fmi2String[]) { return fmi2OK; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* callbacks, fmi2Boolean, fmi2Boolean) {
  try {
    const std::string own_name = name ? name : "";
    const fmi2CallbackLogger logger = callbacks ? callbacks->logger : nullptr;
    void* const environment = callbacks ? callbacks->componentEnvironment : nullptr;
    const auto log = [=](StatusCode code, const char* category, const std::string& message) {
      if (logger) logger(environment, own_name.c_str(), as2(code), category, "%s", message.c_str());
    };
    try {
      if (type != fmi2CoSimulation && type != fmi2ModelExchange) throw std::runtime_error("there is no such kind");
      const std::string folder = wingbeat::fmu::path_of_uri(resources ? resources : "");
      return new Fmi2{{folder, guid ? guid : "", type == fmi2CoSimulation, log}, 0.0, 0.0, false};
    } catch (const std::exception& problem) {
      log(wingbeat::fmu::error, "logStatusError", std::string("fmi2Instantiate: ") + problem.what());
    }
  } catch (...) {
    // Not even the message could be made.
  }
  return nullptr;
}

void fmi2FreeInstance(fmi2Component c) { delete static_cast<Fmi2*>(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean, fmi2Real) {
  return with2(c, "fmi2SetupExperiment", [&](Component& component) {
    Fmi2& fmu = *static_cast<Fmi2*>(c);
    if (!(std::abs(start) <= wingbeat::fmu::latest_time)) {
      return component.refuse("fmi2SetupExperiment: the start time must be a number of at most 1e6 s");
    }
    fmu.start = start;
    fmu.tolerance = tolerance;
    fmu.has_tolerance = has_tolerance != 0;
    return 0;
  });
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
  return with2(c, "fmi2EnterInitializationMode", [&](Component& component) {
    Fmi2& fmu = *static_cast<Fmi2*>(c);
    return component.enter_initialisation(fmu.has_tolerance, fmu.tolerance, fmu.start);
  });
}
fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
  return with2(c, "fmi2ExitInitializationMode", [](Component& component) { return component.exit_initialisation(); });
}
fmi2Status fmi2Terminate(fmi2Component c) {
  return with2(c, "fmi2Terminate", [](Component& component) { return component.terminate(); });
}
fmi2Status fmi2Reset(fmi2Component c) {
  return with2(c, "fmi2Reset", [](Component& component) { return component.reset(); });
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Real values[]) {
  return values2(
      c, "fmi2GetReal", n, [&](Component& component) { return component.get_reals(r, n, values); }, r, values);
}
fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Integer values[]) {
  return values2(
      c, "fmi2GetInteger", n, [&](Component& component) { return component.get_integers(r, n, values); }, r, values);
}
fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference[], size_t n, fmi2Boolean[]) {
  return none2(c, "fmi2GetBoolean", n, "a Boolean variable");
}
fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2String values[]) {
  return values2(
      c, "fmi2GetString", n, [&](Component& component) { return component.get_texts(r, n, values); }, r, values);
}
fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Real values[]) {
  return values2(
      c, "fmi2SetReal", n, [&](Component& component) { return component.set_reals(r, n, values); }, r, values);
}
fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference[], size_t n, const fmi2Integer[]) {
  return none2(c, "fmi2SetInteger", n, "setting an Integer");
}
fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference[], size_t n, const fmi2Boolean[]) {
  return none2(c, "fmi2SetBoolean", n, "setting a Boolean");
}
fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference[], size_t n, const fmi2String[]) {
  return none2(c, "fmi2SetString", n, "setting a String");
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) {
  return values2(c, "fmi2GetFMUstate", 1, [&](Component& component) { return component.save(state); }, state);
}
fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  return with2(c, "fmi2SetFMUstate", [&](Component& component) { return component.restore(state); });
}
fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* state) {
  return with2(c, "fmi2FreeFMUstate", [&](Component& component) { return component.free_state(state); });
}
fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t* size) {
  return values2(
      c, "fmi2SerializedFMUstateSize", 1, [&](Component& component) { return component.size_of(state, size); }, size);
}
fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
  return values2(
      c, "fmi2SerializeFMUstate", 1, [&](Component& component) { return component.serialise(state, bytes, size); },
      bytes);
}
fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate* state) {
  return values2(
      c, "fmi2DeSerializeFMUstate", 1, [&](Component& component) { return component.deserialise(bytes, size, state); },
      bytes, state);
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[], size_t unknowns,
                                        const fmi2ValueReference known[], size_t knowns, const fmi2Real seed[],
                                        fmi2Real sensitivity[]) {
  constexpr const char* function = "fmi2GetDirectionalDerivative";
  return with2(c, function, [&](Component& component) {
    if (const int wrong = component.check_values(function, unknowns, {unknown, sensitivity})) return wrong;
    if (const int wrong = component.check_values(function, knowns, {known, seed})) return wrong;
    return component.directional(unknown, unknowns, known, knowns, seed, knowns, sensitivity, unknowns);
  });
}

fmi2Status fmi2EnterEventMode(fmi2Component c) {
  return with2(c, "fmi2EnterEventMode", [](Component& component) { return component.enter_event_mode(); });
}
fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo* info) {
  return values2(
      c, "fmi2NewDiscreteStates", 1,
      [&](Component& component) {
        Component::Updated to;
        const int code = component.update_discrete(to);
        *info = {0, to.terminate, 0, to.states_changed, to.next_event_defined, to.next_event};
        return code;
      },
      info);
}
fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) {
  return with2(c, "fmi2EnterContinuousTimeMode",
               [](Component& component) { return component.enter_continuous_mode(); });
}
fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean, fmi2Boolean* enter_event_mode,
                                       fmi2Boolean* terminate) {
  return values2(
      c, "fmi2CompletedIntegratorStep", 1,
      [&](Component&) {
        *enter_event_mode = *terminate = 0;
        return 0;
      },
      enter_event_mode, terminate);
}
fmi2Status fmi2SetTime(fmi2Component c, fmi2Real t) {
  return with2(c, "fmi2SetTime", [&](Component& component) { return component.set_time(t); });
}
fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real y[], size_t n) {
  return values2(c, "fmi2SetContinuousStates", n, [&](Component& component) { return component.set_states(y, n); }, y);
}
fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real dy[], size_t n) {
  return values2(c, "fmi2GetDerivatives", n, [&](Component& component) { return component.get_rates(dy, n); }, dy);
}
fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real z[], size_t n) {
  return values2(
      c, "fmi2GetEventIndicators", n, [&](Component& component) { return component.get_indicators(z, n); }, z);
}
fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real y[], size_t n) {
  return values2(c, "fmi2GetContinuousStates", n, [&](Component& component) { return component.get_states(y, n); }, y);
}
fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real sizes[], size_t n) {
  return values2(
      c, "fmi2GetNominalsOfContinuousStates", n, [&](Component& component) { return component.get_nominals(sizes, n); },
      sizes);
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference[], size_t n, const fmi2Integer[],
                                       const fmi2Real[]) {
  return none2(c, "fmi2SetRealInputDerivatives", n, "interpolation of inputs");
}
fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference[], size_t n, const fmi2Integer[],
                                        fmi2Real[]) {
  return none2(c, "fmi2GetRealOutputDerivatives", n, "derivatives of outputs");
}
fmi2Status fmi2DoStep(fmi2Component c, fmi2Real from, fmi2Real length, fmi2Boolean) {
  return with2(c, "fmi2DoStep", [&](Component& component) { return component.step(from, length); });
}
fmi2Status fmi2CancelStep(fmi2Component c) { return none2(c, "fmi2CancelStep", 1, "a step that is under way"); }
fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind, fmi2Status*) {
  return none2(c, "fmi2GetStatus", 1, "a step that is under way");
}
fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real* value) {
  if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
  return values2(
      c, "fmi2GetRealStatus", 1,
      [&](Component& component) {
        *value = component.time();
        return 0;
      },
      value);
}
fmi2Status fmi2GetIntegerStatus(fmi2Component, const fmi2StatusKind, fmi2Integer*) { return fmi2Discard; }
fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean* value) {
  if (kind != fmi2Terminated) return fmi2Discard;
  return values2(
      c, "fmi2GetBooleanStatus", 1,
      [&](Component& component) {
        *value = component.ended();
        return 0;
      },
      value);
}
fmi2Status fmi2GetStringStatus(fmi2Component, const fmi2StatusKind, fmi2String*) { return fmi2Discard; }

}  // extern "C"
