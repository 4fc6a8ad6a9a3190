// FMI 3.0: model exchange and co-simulation.
#include <exception>
#include <string>

#include "fmu/binary/component.hpp"
#include "fmu/binary/fmi3_functions.h"
#include "fmu/binary/resource_path.hpp"

using wingbeat::fmu::Component;
using wingbeat::fmu::StatusCode;

namespace {

fmi3Status as3(int code) { return fmi3Status(code); }

template <class Work>
fmi3Status with3(fmi3Instance c, const char* function, const Work& work) noexcept {
  return as3(wingbeat::fmu::guarded(static_cast<Component*>(c), function, work));
}
template <class Work, class... Pointers>
fmi3Status values3(fmi3Instance c, const char* function, size_t count, const Work& work,
                   const Pointers*... pointers) noexcept {
  return as3(wingbeat::fmu::guarded_values(static_cast<Component*>(c), function, count, work, pointers...));
}
/// Of `references` variables with as many values, each a number.
template <class Work, class Value>
fmi3Status variables3(fmi3Instance c, const char* function, const fmi3ValueReference* r, size_t references,
                      Value* values, size_t count, const Work& work) noexcept {
  return values3(
      c, function, references,
      [&](Component& component) {
        if (count != references)
          return component.refuse(std::string(function) + ": as many values as references are needed");
        return work(component);
      },
      r, values);
}
fmi3Status unsupported3(fmi3Instance c, const char* what) noexcept {
  return with3(c, what, [&](Component& component) { return component.unsupported(what); });
}
/// What no variable has or nothing supports: right for none of it.
fmi3Status none3(fmi3Instance c, size_t count, const char* what) noexcept {
  return count == 0 && c ? fmi3OK : unsupported3(c, what);
}

fmi3Instance instantiate3(const char* function, fmi3String token, fmi3String resources, bool co_simulation,
                          fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger) noexcept {
  try {
    const auto log = [=](StatusCode code, const char* category, const std::string& message) {
      if (logger) logger(environment, as3(code), category, message.c_str());
    };
    try {
      return new Component(wingbeat::fmu::path_of_uri(resources ? resources : ""), token ? token : "", co_simulation,
                           log);
    } catch (const std::exception& problem) {
      log(wingbeat::fmu::error, "logStatusError", std::string(function) + ": " + problem.what());
    }
  } catch (...) {
    // Not even the message could be made.
  }
  return nullptr;
}

}  // namespace

extern "C" {

const char* fmi3GetVersion(void) { return "3.0"; }
fmi3Status fmi3SetDebugLogging(fmi3Instance, fmi3Boolean, size_t, const fmi3String[]) { return fmi3OK; }

fmi3Instance fmi3InstantiateModelExchange(fmi3String, fmi3String token, fmi3String resources, fmi3Boolean, fmi3Boolean,
                                          fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger) {
  return instantiate3("fmi3InstantiateModelExchange", token, resources, false, environment, logger);
}
fmi3Instance fmi3InstantiateCoSimulation(fmi3String, fmi3String token, fmi3String resources, fmi3Boolean, fmi3Boolean,
                                         fmi3Boolean event_mode, fmi3Boolean, const fmi3ValueReference[], size_t,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                         fmi3IntermediateUpdateCallback) {
  if (event_mode) {
    if (logger) logger(environment, fmi3Error, "logStatusError", "this FMU has no event mode in co-simulation");
    return nullptr;
  }
  return instantiate3("fmi3InstantiateCoSimulation", token, resources, true, environment, logger);
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
  return with3(c, "fmi3EnterInitializationMode",
               [&](Component& component) { return component.enter_initialisation(has_tolerance, tolerance, start); });
}
fmi3Status fmi3ExitInitializationMode(fmi3Instance c) {
  return with3(c, "fmi3ExitInitializationMode", [](Component& component) { return component.exit_initialisation(); });
}
fmi3Status fmi3EnterEventMode(fmi3Instance c) {
  return with3(c, "fmi3EnterEventMode", [](Component& component) { return component.enter_event_mode(); });
}
fmi3Status fmi3Terminate(fmi3Instance c) {
  return with3(c, "fmi3Terminate", [](Component& component) { return component.terminate(); });
}
fmi3Status fmi3Reset(fmi3Instance c) {
  return with3(c, "fmi3Reset", [](Component& component) { return component.reset(); });
}
fmi3Status fmi3EnterConfigurationMode(fmi3Instance c) { return unsupported3(c, "configuration mode"); }
fmi3Status fmi3ExitConfigurationMode(fmi3Instance c) { return unsupported3(c, "configuration mode"); }
fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c) {
  return with3(c, "fmi3EnterContinuousTimeMode",
               [](Component& component) { return component.enter_continuous_mode(); });
}
fmi3Status fmi3EnterStepMode(fmi3Instance c) { return unsupported3(c, "event mode in co-simulation"); }
fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c) { return c ? fmi3OK : fmi3Error; }

fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Float64 values[], size_t count) {
  return variables3(c, "fmi3GetFloat64", r, n, values, count,
                    [&](Component& component) { return component.get_reals(r, n, values); });
}
fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Float64 values[],
                          size_t count) {
  return variables3(c, "fmi3SetFloat64", r, n, values, count,
                    [&](Component& component) { return component.set_reals(r, n, values); });
}
fmi3Status fmi3GetInt32(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Int32 values[], size_t count) {
  return variables3(c, "fmi3GetInt32", r, n, values, count,
                    [&](Component& component) { return component.get_wholes(r, n, values, false); });
}
fmi3Status fmi3GetInt64(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Int64 values[], size_t count) {
  // Enumerations are got by this function.
  return variables3(c, "fmi3GetInt64", r, n, values, count, [&](Component& component) {
    for (size_t k = 0; k < n; ++k) {
      int value = 0;
      if (const int code = component.get_wholes(r + k, 1, &value, true)) return code;
      values[k] = value;
    }
    return 0;
  });
}
fmi3Status fmi3GetString(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3String values[], size_t count) {
  return variables3(c, "fmi3GetString", r, n, values, count,
                    [&](Component& component) { return component.get_texts(r, n, values); });
}

// Types that no variable has, or none that can be set.
#define NONE_TO_GET(type)                                                                                \
  fmi3Status fmi3Get##type(fmi3Instance c, const fmi3ValueReference[], size_t n, fmi3##type[], size_t) { \
    return none3(c, n, "a variable of the type " #type);                                                 \
  }
#define NONE_TO_SET(type)                                                                                      \
  fmi3Status fmi3Set##type(fmi3Instance c, const fmi3ValueReference[], size_t n, const fmi3##type[], size_t) { \
    return none3(c, n, "setting a variable of the type " #type);                                               \
  }
NONE_TO_GET(Float32)
NONE_TO_GET(Int8)
NONE_TO_GET(UInt8)
NONE_TO_GET(Int16)
NONE_TO_GET(UInt16)
NONE_TO_GET(UInt32)
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
  return none3(c, n, "a variable of the type Binary");
}
fmi3Status fmi3SetBinary(fmi3Instance c, const fmi3ValueReference[], size_t n, const size_t[], const fmi3Binary[],
                         size_t) {
  return none3(c, n, "a variable of the type Binary");
}
fmi3Status fmi3GetClock(fmi3Instance c, const fmi3ValueReference[], size_t n, fmi3Clock[]) {
  return none3(c, n, "a variable of the type Clock");
}
fmi3Status fmi3SetClock(fmi3Instance c, const fmi3ValueReference[], size_t n, const fmi3Clock[]) {
  return none3(c, n, "a variable of the type Clock");
}
fmi3Status fmi3GetIntervalDecimal(fmi3Instance c, const fmi3ValueReference[], size_t n, fmi3Float64[],
                                  fmi3IntervalQualifier[]) {
  return none3(c, n, "a variable of the type Clock");
}
fmi3Status fmi3GetIntervalFraction(fmi3Instance c, const fmi3ValueReference[], size_t n, fmi3UInt64[], fmi3UInt64[],
                                   fmi3IntervalQualifier[]) {
  return none3(c, n, "a variable of the type Clock");
}
fmi3Status fmi3GetShiftDecimal(fmi3Instance c, const fmi3ValueReference[], size_t n, fmi3Float64[]) {
  return none3(c, n, "a variable of the type Clock");
}
fmi3Status fmi3GetShiftFraction(fmi3Instance c, const fmi3ValueReference[], size_t n, fmi3UInt64[], fmi3UInt64[]) {
  return none3(c, n, "a variable of the type Clock");
}
fmi3Status fmi3SetIntervalDecimal(fmi3Instance c, const fmi3ValueReference[], size_t n, const fmi3Float64[]) {
  return none3(c, n, "a variable of the type Clock");
}
fmi3Status fmi3SetIntervalFraction(fmi3Instance c, const fmi3ValueReference[], size_t n, const fmi3UInt64[],
                                   const fmi3UInt64[]) {
  return none3(c, n, "a variable of the type Clock");
}
fmi3Status fmi3SetShiftDecimal(fmi3Instance c, const fmi3ValueReference[], size_t n, const fmi3Float64[]) {
  return none3(c, n, "a variable of the type Clock");
}
fmi3Status fmi3SetShiftFraction(fmi3Instance c, const fmi3ValueReference[], size_t n, const fmi3UInt64[],
                                const fmi3UInt64[]) {
  return none3(c, n, "a variable of the type Clock");
}

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance c, fmi3ValueReference reference, size_t* count) {
  return values3(
      c, "fmi3GetNumberOfVariableDependencies", 1,
      [&](Component& component) {
        *count = component.dependencies(reference).size();
        return 0;
      },
      count);
}
fmi3Status fmi3GetVariableDependencies(fmi3Instance c, fmi3ValueReference dependent, size_t dependent_elements[],
                                       fmi3ValueReference independents[], size_t independent_elements[],
                                       fmi3DependencyKind kinds[], size_t count) {
  return values3(
      c, "fmi3GetVariableDependencies", count,
      [&](Component& component) {
        const auto on = component.dependencies(dependent);
        if (count != on.size()) return component.unsupported("another number of dependencies than there are");
        for (size_t n = 0; n < count; ++n) {
          dependent_elements[n] = independent_elements[n] = 0;
          independents[n] = fmi3ValueReference(on[n]);
          kinds[n] = fmi3Dependent;
        }
        return 0;
      },
      dependent_elements, independents, independent_elements, kinds);
}

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState* state) {
  return values3(c, "fmi3GetFMUState", 1, [&](Component& component) { return component.save(state); }, state);
}
fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) {
  return with3(c, "fmi3SetFMUState", [&](Component& component) { return component.restore(state); });
}
fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState* state) {
  return with3(c, "fmi3FreeFMUState", [&](Component& component) { return component.free_state(state); });
}
fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t* size) {
  return values3(
      c, "fmi3SerializedFMUStateSize", 1, [&](Component& component) { return component.size_of(state, size); }, size);
}
fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
  return values3(
      c, "fmi3SerializeFMUState", 1, [&](Component& component) { return component.serialise(state, bytes, size); },
      bytes);
}
fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState* state) {
  return values3(
      c, "fmi3DeserializeFMUState", 1, [&](Component& component) { return component.deserialise(bytes, size, state); },
      bytes, state);
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference unknown[], size_t unknowns,
                                        const fmi3ValueReference known[], size_t knowns, const fmi3Float64 seed[],
                                        size_t seeds, fmi3Float64 sensitivity[], size_t sensitivities) {
  constexpr const char* function = "fmi3GetDirectionalDerivative";
  return with3(c, function, [&](Component& component) {
    if (const int wrong = component.check_values(function, unknowns, {unknown, sensitivity})) return wrong;
    if (const int wrong = component.check_values(function, knowns, {known, seed})) return wrong;
    return component.directional(unknown, unknowns, known, knowns, seed, seeds, sensitivity, sensitivities);
  });
}
fmi3Status fmi3GetAdjointDerivative(fmi3Instance c, const fmi3ValueReference[], size_t, const fmi3ValueReference[],
                                    size_t, const fmi3Float64[], size_t, fmi3Float64[], size_t) {
  return unsupported3(c, "the adjoint derivative");
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean* again, fmi3Boolean* terminate, fmi3Boolean* nominals,
                                    fmi3Boolean* values, fmi3Boolean* defined, fmi3Float64* next) {
  return values3(
      c, "fmi3UpdateDiscreteStates", 1,
      [&](Component& component) {
        Component::Updated to;
        const int code = component.update_discrete(to);
        *again = *nominals = false;
        *terminate = to.terminate;
        *values = to.states_changed;
        *defined = to.next_event_defined;
        *next = to.next_event;
        return code;
      },
      again, terminate, nominals, values, defined, next);
}
fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean, fmi3Boolean* enter_event_mode,
                                       fmi3Boolean* terminate) {
  return values3(
      c, "fmi3CompletedIntegratorStep", 1,
      [&](Component&) {
        *enter_event_mode = *terminate = false;
        return 0;
      },
      enter_event_mode, terminate);
}
fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 t) {
  return with3(c, "fmi3SetTime", [&](Component& component) { return component.set_time(t); });
}
fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 y[], size_t n) {
  return values3(c, "fmi3SetContinuousStates", n, [&](Component& component) { return component.set_states(y, n); }, y);
}
fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 dy[], size_t n) {
  return values3(
      c, "fmi3GetContinuousStateDerivatives", n, [&](Component& component) { return component.get_rates(dy, n); }, dy);
}
fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 z[], size_t n) {
  return values3(
      c, "fmi3GetEventIndicators", n, [&](Component& component) { return component.get_indicators(z, n); }, z);
}
fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 y[], size_t n) {
  return values3(c, "fmi3GetContinuousStates", n, [&](Component& component) { return component.get_states(y, n); }, y);
}
fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 sizes[], size_t n) {
  return values3(
      c, "fmi3GetNominalsOfContinuousStates", n, [&](Component& component) { return component.get_nominals(sizes, n); },
      sizes);
}
fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t* n) {
  return values3(
      c, "fmi3GetNumberOfEventIndicators", 1,
      [&](Component& component) {
        *n = component.indicator_count();
        return 0;
      },
      n);
}
fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t* n) {
  return values3(
      c, "fmi3GetNumberOfContinuousStates", 1,
      [&](Component& component) {
        *n = component.state_count();
        return 0;
      },
      n);
}
fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, const fmi3ValueReference[], size_t n, const fmi3Int32[],
                                    fmi3Float64[], size_t) {
  return none3(c, n, "derivatives of outputs");
}
fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 from, fmi3Float64 length, fmi3Boolean, fmi3Boolean* event_needed,
                      fmi3Boolean* terminate, fmi3Boolean* early_return, fmi3Float64* last_time) {
  return values3(
      c, "fmi3DoStep", 1,
      [&](Component& component) {
        const int code = component.step(from, length);
        *event_needed = *early_return = false;
        *terminate = component.ended();
        *last_time = component.time();
        return code;
      },
      event_needed, terminate, early_return, last_time);
}
fmi3Status fmi3ActivateModelPartition(fmi3Instance c, fmi3ValueReference, fmi3Float64) {
  return unsupported3(c, "scheduled execution");
}

}  // extern "C"
