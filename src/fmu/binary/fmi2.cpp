// FMI 2.0: model exchange and co-simulation.
#include <exception>
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

Component& of(fmi2Component c) { return static_cast<Fmi2*>(c)->component; }
fmi2Status status(int code) { return fmi2Status(code); }

fmi2Status unsupported(fmi2Component c, const char* what) { return status(of(c).unsupported(what)); }

}  // namespace

extern "C" {

const char* fmi2GetTypesPlatform(void) { return "default"; }
const char* fmi2GetVersion(void) { return "2.0"; }

fmi2Status fmi2SetDebugLogging(fmi2Component, fmi2Boolean, size_t, const fmi2String[]) { return fmi2OK; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* callbacks, fmi2Boolean, fmi2Boolean) {
  const std::string own_name = name ? name : "";
  const fmi2CallbackLogger logger = callbacks ? callbacks->logger : nullptr;
  const fmi2ComponentEnvironment environment = callbacks ? callbacks->componentEnvironment : nullptr;
  const auto log = [=](StatusCode code, const char* category, const std::string& message) {
    if (logger) logger(environment, own_name.c_str(), status(code), category, "%s", message.c_str());
  };
  try {
    const std::string folder = wingbeat::fmu::path_of_uri(resources ? resources : "");
    return new Fmi2{{folder, guid ? guid : "", type == fmi2CoSimulation, log}, 0.0, 0.0, false};
  } catch (const std::exception& problem) {
    log(wingbeat::fmu::error, "logStatusError", std::string("fmi2Instantiate: ") + problem.what());
    return nullptr;
  }
}

void fmi2FreeInstance(fmi2Component c) { delete static_cast<Fmi2*>(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean, fmi2Real) {
  Fmi2& fmu = *static_cast<Fmi2*>(c);
  fmu.start = start;
  fmu.tolerance = tolerance;
  fmu.has_tolerance = has_tolerance != 0;
  return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
  const Fmi2& fmu = *static_cast<Fmi2*>(c);
  return status(of(c).enter_initialisation(fmu.has_tolerance, fmu.tolerance, fmu.start));
}
fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return status(of(c).exit_initialisation()); }
fmi2Status fmi2Terminate(fmi2Component c) { return status(of(c).terminate()); }
fmi2Status fmi2Reset(fmi2Component c) { return status(of(c).reset()); }

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Real values[]) {
  return status(of(c).get_reals(r, n, values));
}
fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Integer values[]) {
  return status(of(c).get_wholes(r, n, values));
}
fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference[], size_t n, fmi2Boolean[]) {
  return status(of(c).get_none(n, "Boolean"));
}
fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2String values[]) {
  return status(of(c).get_texts(r, n, values));
}
fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Real values[]) {
  return status(of(c).set_reals(r, n, values));
}
fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference[], size_t n, const fmi2Integer[]) {
  return n == 0 ? fmi2OK : unsupported(c, "setting an Integer");
}
fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference[], size_t n, const fmi2Boolean[]) {
  return n == 0 ? fmi2OK : unsupported(c, "setting a Boolean");
}
fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference[], size_t n, const fmi2String[]) {
  return n == 0 ? fmi2OK : unsupported(c, "setting a String");
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) { return status(of(c).save(state)); }
fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) { return status(of(c).restore(state)); }
fmi2Status fmi2FreeFMUstate(fmi2Component, fmi2FMUstate* state) {
  Component::free_state(state);
  return fmi2OK;
}
fmi2Status fmi2SerializedFMUstateSize(fmi2Component, fmi2FMUstate state, size_t* size) {
  *size = Component::size_of(state);
  return fmi2OK;
}
fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
  return status(of(c).serialise(state, bytes, size));
}
fmi2Status fmi2DeSerializeFMUstate(fmi2Component, const fmi2Byte bytes[], size_t size, fmi2FMUstate* state) {
  Component::deserialise(bytes, size, state);
  return fmi2OK;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[], size_t unknowns,
                                        const fmi2ValueReference known[], size_t knowns, const fmi2Real seed[],
                                        fmi2Real sensitivity[]) {
  return status(of(c).directional(unknown, unknowns, known, knowns, seed, knowns, sensitivity, unknowns));
}

fmi2Status fmi2EnterEventMode(fmi2Component c) { return status(of(c).enter_event_mode()); }
fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo* info) {
  Component::Updated to;
  const int code = of(c).update_discrete(to);
  *info = {0, to.terminate, 0, to.states_changed, to.next_event_defined, to.next_event};
  return status(code);
}
fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) { return status(of(c).enter_continuous_mode()); }
fmi2Status fmi2CompletedIntegratorStep(fmi2Component, fmi2Boolean, fmi2Boolean* enter_event_mode,
                                       fmi2Boolean* terminate) {
  *enter_event_mode = 0;
  *terminate = 0;
  return fmi2OK;
}
fmi2Status fmi2SetTime(fmi2Component c, fmi2Real t) { return status(of(c).set_time(t)); }
fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real y[], size_t n) {
  return status(of(c).set_states(y, n));
}
fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real dy[], size_t n) { return status(of(c).get_rates(dy, n)); }
fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real z[], size_t n) {
  return status(of(c).get_indicators(z, n));
}
fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real y[], size_t n) { return status(of(c).get_states(y, n)); }
fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real sizes[], size_t n) {
  return status(of(c).get_nominals(sizes, n));
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference[], size_t n, const fmi2Integer[],
                                       const fmi2Real[]) {
  return n == 0 ? fmi2OK : unsupported(c, "interpolation of inputs");
}
fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference[], size_t n, const fmi2Integer[],
                                        fmi2Real[]) {
  return n == 0 ? fmi2OK : unsupported(c, "derivatives of outputs");
}
fmi2Status fmi2DoStep(fmi2Component c, fmi2Real from, fmi2Real length, fmi2Boolean) {
  return status(of(c).step(from, length));
}
fmi2Status fmi2CancelStep(fmi2Component c) { return unsupported(c, "a step that is under way"); }
fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind, fmi2Status*) {
  return unsupported(c, "a step that is under way");
}
fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real* value) {
  if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
  *value = of(c).time();
  return fmi2OK;
}
fmi2Status fmi2GetIntegerStatus(fmi2Component, const fmi2StatusKind, fmi2Integer*) { return fmi2Discard; }
fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean* value) {
  if (kind != fmi2Terminated) return fmi2Discard;
  *value = of(c).ended();
  return fmi2OK;
}
fmi2Status fmi2GetStringStatus(fmi2Component, const fmi2StatusKind, fmi2String*) { return fmi2Discard; }

}  // extern "C"
