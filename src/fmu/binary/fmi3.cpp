// FMI 3.0: model exchange and co-simulation.
#include <exception>
#include <string>

#include "fmu/binary/component.hpp"
#include "fmu/binary/fmi3_functions.h"
#include "fmu/binary/resource_path.hpp"
#include "fmu/dependencies.hpp"

using wingbeat::fmu::Component;
using wingbeat::fmu::StatusCode;

namespace {

Component& component_of(fmi3Instance c) { return *static_cast<Component*>(c); }
fmi3Status as3(int code) { return fmi3Status(code); }

fmi3Status not_supported(fmi3Instance c, const char* what) { return as3(component_of(c).unsupported(what)); }

fmi3Instance instantiate(fmi3String token, fmi3String resources, bool co_simulation,
                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger) {
  const auto log = [=](StatusCode code, const char* category, const std::string& message) {
    if (logger) logger(environment, as3(code), category, message.c_str());
  };
  try {
    return new Component(wingbeat::fmu::path_of_uri(resources ? resources : ""), token ? token : "", co_simulation,
                         log);
  } catch (const std::exception& problem) {
    log(wingbeat::fmu::error, "logStatusError", std::string("fmi3Instantiate: ") + problem.what());
    return nullptr;
  }
}

}  // namespace

extern "C" {

const char* fmi3GetVersion(void) { return "3.0"; }
fmi3Status fmi3SetDebugLogging(fmi3Instance, fmi3Boolean, size_t, const fmi3String[]) { return fmi3OK; }

fmi3Instance fmi3InstantiateModelExchange(fmi3String, fmi3String token, fmi3String resources, fmi3Boolean, fmi3Boolean,
                                          fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger) {
  return instantiate(token, resources, false, environment, logger);
}
fmi3Instance fmi3InstantiateCoSimulation(fmi3String, fmi3String token, fmi3String resources, fmi3Boolean, fmi3Boolean,
                                         fmi3Boolean event_mode, fmi3Boolean, const fmi3ValueReference[], size_t,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                         fmi3IntermediateUpdateCallback) {
  if (event_mode) {
    if (logger) logger(environment, fmi3Error, "logStatusError", "this FMU has no event mode in co-simulation");
    return nullptr;
  }
  return instantiate(token, resources, true, environment, logger);
}
fmi3Instance fmi3InstantiateScheduledExecution(fmi3String, fmi3String, fmi3String, fmi3Boolean, fmi3Boolean,
                                               fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                               fmi3ClockUpdateCallback, fmi3LockPreemptionCallback,
                                               fmi3UnlockPreemptionCallback) {
  if (logger) logger(environment, fmi3Error, "logStatusError", "this FMU has no scheduled execution");
  return nullptr;
}
void fmi3FreeInstance(fmi3Instance c) { delete static_cast<Component*>(c); }

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean has_tolerance, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean, fmi3Float64) {
  return as3(component_of(c).enter_initialisation(has_tolerance, tolerance, start));
}
fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { return as3(component_of(c).exit_initialisation()); }
fmi3Status fmi3EnterEventMode(fmi3Instance c) { return as3(component_of(c).enter_event_mode()); }
fmi3Status fmi3Terminate(fmi3Instance c) { return as3(component_of(c).terminate()); }
fmi3Status fmi3Reset(fmi3Instance c) { return as3(component_of(c).reset()); }
fmi3Status fmi3EnterConfigurationMode(fmi3Instance c) { return not_supported(c, "configuration mode"); }
fmi3Status fmi3ExitConfigurationMode(fmi3Instance c) { return not_supported(c, "configuration mode"); }
fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c) { return as3(component_of(c).enter_continuous_mode()); }
fmi3Status fmi3EnterStepMode(fmi3Instance c) { return not_supported(c, "event mode in co-simulation"); }
fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance) { return fmi3OK; }

fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Float64 values[], size_t count) {
  return count == n ? as3(component_of(c).get_reals(r, n, values))
                    : not_supported(c, "a number of values beside that of references");
}
fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Float64 values[],
                          size_t count) {
  return count == n ? as3(component_of(c).set_reals(r, n, values))
                    : not_supported(c, "a number of values beside that of references");
}
fmi3Status fmi3GetInt32(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Int32 values[], size_t count) {
  return count == n ? as3(component_of(c).get_wholes(r, n, values))
                    : not_supported(c, "a number of values beside that of references");
}
fmi3Status fmi3GetString(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3String values[], size_t count) {
  return count == n ? as3(component_of(c).get_texts(r, n, values))
                    : not_supported(c, "a number of values beside that of references");
}

// Types that no variable has, or none that can be set.
#define NONE_TO_GET(type)                                                                                \
  fmi3Status fmi3Get##type(fmi3Instance c, const fmi3ValueReference[], size_t n, fmi3##type[], size_t) { \
    return as3(component_of(c).get_none(n, #type));                                                      \
  }
#define NONE_TO_SET(type)                                                                                      \
  fmi3Status fmi3Set##type(fmi3Instance c, const fmi3ValueReference[], size_t n, const fmi3##type[], size_t) { \
    return as3(component_of(c).get_none(n, #type));                                                            \
  }
NONE_TO_GET(Float32)
NONE_TO_GET(Int8)
NONE_TO_GET(UInt8)
NONE_TO_GET(Int16)
NONE_TO_GET(UInt16)
NONE_TO_GET(UInt32)
NONE_TO_GET(Int64)
NONE_TO_GET(UInt64)
NONE_TO_GET(Boolean)
NONE_TO_SET(Float32)
NONE_TO_SET(Int8)
NONE_TO_SET(UInt8)
NONE_TO_SET(Int16)
NONE_TO_SET(UInt16)
NONE_TO_SET(Int32)
NONE_TO_SET(UInt32)
NONE_TO_SET(Int64)
NONE_TO_SET(UInt64)
NONE_TO_SET(Boolean)
NONE_TO_SET(String)
#undef NONE_TO_GET
#undef NONE_TO_SET

fmi3Status fmi3GetBinary(fmi3Instance c, const fmi3ValueReference[], size_t n, size_t[], fmi3Binary[], size_t) {
  return as3(component_of(c).get_none(n, "Binary"));
}
fmi3Status fmi3SetBinary(fmi3Instance c, const fmi3ValueReference[], size_t n, const size_t[], const fmi3Binary[],
                         size_t) {
  return as3(component_of(c).get_none(n, "Binary"));
}
fmi3Status fmi3GetClock(fmi3Instance c, const fmi3ValueReference[], size_t n, fmi3Clock[]) {
  return as3(component_of(c).get_none(n, "Clock"));
}
fmi3Status fmi3SetClock(fmi3Instance c, const fmi3ValueReference[], size_t n, const fmi3Clock[]) {
  return as3(component_of(c).get_none(n, "Clock"));
}
fmi3Status fmi3GetIntervalDecimal(fmi3Instance c, const fmi3ValueReference[], size_t n, fmi3Float64[],
                                  fmi3IntervalQualifier[]) {
  return as3(component_of(c).get_none(n, "Clock"));
}
fmi3Status fmi3GetIntervalFraction(fmi3Instance c, const fmi3ValueReference[], size_t n, fmi3UInt64[], fmi3UInt64[],
                                   fmi3IntervalQualifier[]) {
  return as3(component_of(c).get_none(n, "Clock"));
}
fmi3Status fmi3GetShiftDecimal(fmi3Instance c, const fmi3ValueReference[], size_t n, fmi3Float64[]) {
  return as3(component_of(c).get_none(n, "Clock"));
}
fmi3Status fmi3GetShiftFraction(fmi3Instance c, const fmi3ValueReference[], size_t n, fmi3UInt64[], fmi3UInt64[]) {
  return as3(component_of(c).get_none(n, "Clock"));
}
fmi3Status fmi3SetIntervalDecimal(fmi3Instance c, const fmi3ValueReference[], size_t n, const fmi3Float64[]) {
  return as3(component_of(c).get_none(n, "Clock"));
}
fmi3Status fmi3SetIntervalFraction(fmi3Instance c, const fmi3ValueReference[], size_t n, const fmi3UInt64[],
                                   const fmi3UInt64[]) {
  return as3(component_of(c).get_none(n, "Clock"));
}
fmi3Status fmi3SetShiftDecimal(fmi3Instance c, const fmi3ValueReference[], size_t n, const fmi3Float64[]) {
  return as3(component_of(c).get_none(n, "Clock"));
}
fmi3Status fmi3SetShiftFraction(fmi3Instance c, const fmi3ValueReference[], size_t n, const fmi3UInt64[],
                                const fmi3UInt64[]) {
  return as3(component_of(c).get_none(n, "Clock"));
}

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance c, fmi3ValueReference reference, size_t* count) {
  *count = wingbeat::fmu::dependencies_of(component_of(c).design(), reference).size();
  return fmi3OK;
}
fmi3Status fmi3GetVariableDependencies(fmi3Instance c, fmi3ValueReference dependent, size_t dependent_elements[],
                                       fmi3ValueReference independents[], size_t independent_elements[],
                                       fmi3DependencyKind kinds[], size_t count) {
  const auto on = wingbeat::fmu::dependencies_of(component_of(c).design(), dependent);
  if (count != on.size()) return not_supported(c, "another number of dependencies than there are");
  for (size_t n = 0; n < count; ++n) {
    dependent_elements[n] = independent_elements[n] = 0;
    independents[n] = fmi3ValueReference(on[n]);
    kinds[n] = fmi3Dependent;
  }
  return fmi3OK;
}

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState* state) { return as3(component_of(c).save(state)); }
fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) { return as3(component_of(c).restore(state)); }
fmi3Status fmi3FreeFMUState(fmi3Instance, fmi3FMUState* state) {
  Component::free_state(state);
  return fmi3OK;
}
fmi3Status fmi3SerializedFMUStateSize(fmi3Instance, fmi3FMUState state, size_t* size) {
  *size = Component::size_of(state);
  return fmi3OK;
}
fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
  return as3(component_of(c).serialise(state, bytes, size));
}
fmi3Status fmi3DeserializeFMUState(fmi3Instance, const fmi3Byte bytes[], size_t size, fmi3FMUState* state) {
  Component::deserialise(bytes, size, state);
  return fmi3OK;
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference unknown[], size_t unknowns,
                                        const fmi3ValueReference known[], size_t knowns, const fmi3Float64 seed[],
                                        size_t seeds, fmi3Float64 sensitivity[], size_t sensitivities) {
  return as3(component_of(c).directional(unknown, unknowns, known, knowns, seed, seeds, sensitivity, sensitivities));
}
fmi3Status fmi3GetAdjointDerivative(fmi3Instance c, const fmi3ValueReference[], size_t, const fmi3ValueReference[],
                                    size_t, const fmi3Float64[], size_t, fmi3Float64[], size_t) {
  return not_supported(c, "the adjoint derivative");
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean* again, fmi3Boolean* terminate, fmi3Boolean* nominals,
                                    fmi3Boolean* values, fmi3Boolean* defined, fmi3Float64* next) {
  Component::Updated to;
  const int code = component_of(c).update_discrete(to);
  *again = *nominals = false;
  *terminate = to.terminate;
  *values = to.states_changed;
  *defined = to.next_event_defined;
  *next = to.next_event;
  return as3(code);
}
fmi3Status fmi3CompletedIntegratorStep(fmi3Instance, fmi3Boolean, fmi3Boolean* enter_event_mode,
                                       fmi3Boolean* terminate) {
  *enter_event_mode = *terminate = false;
  return fmi3OK;
}
fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 t) { return as3(component_of(c).set_time(t)); }
fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 y[], size_t n) {
  return as3(component_of(c).set_states(y, n));
}
fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 dy[], size_t n) {
  return as3(component_of(c).get_rates(dy, n));
}
fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 z[], size_t n) {
  return as3(component_of(c).get_indicators(z, n));
}
fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 y[], size_t n) {
  return as3(component_of(c).get_states(y, n));
}
fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 sizes[], size_t n) {
  return as3(component_of(c).get_nominals(sizes, n));
}
fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t* n) {
  *n = component_of(c).indicator_count();
  return fmi3OK;
}
fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t* n) {
  *n = component_of(c).state_count();
  return fmi3OK;
}
fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, const fmi3ValueReference[], size_t n, const fmi3Int32[],
                                    fmi3Float64[], size_t) {
  return n == 0 ? fmi3OK : not_supported(c, "derivatives of outputs");
}
fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 from, fmi3Float64 length, fmi3Boolean, fmi3Boolean* event_needed,
                      fmi3Boolean* terminate, fmi3Boolean* early_return, fmi3Float64* last_time) {
  const int code = component_of(c).step(from, length);
  *event_needed = *early_return = false;
  *terminate = component_of(c).ended();
  *last_time = component_of(c).time();
  return as3(code);
}
fmi3Status fmi3ActivateModelPartition(fmi3Instance c, fmi3ValueReference, fmi3Float64) {
  return not_supported(c, "scheduled execution");
}

}  // extern "C"
