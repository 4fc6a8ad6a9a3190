/* What the importers in C have in common: the library of an FMU's binary, its functions by the prototypes that the
 * project declares from the standard, messages. */
#ifndef WINGBEAT_TESTS_IMPORTER_H
#define WINGBEAT_TESTS_IMPORTER_H

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

#include "fmu/binary/fmi2_functions.h"
#include "fmu/binary/fmi3_functions.h"

static void* library;

static void load(const char* file) {
#ifdef _WIN32
  library = (void*)LoadLibraryA(file);
#else
  library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
#endif
  if (library) return;
  fprintf(stderr, "importer: cannot load %s\n", file);
  exit(1);
}

/* FMI 2 gives the folder of resources as a URI. */
static void uri_of(const char* folder, char* uri, size_t size) {
  snprintf(uri, size, "file://%s%s", folder[0] == '/' ? "" : "/", folder);
}

static void* function(const char* name) {
#ifdef _WIN32
  void* found = (void*)GetProcAddress((HMODULE)library, name);
#else
  void* found = dlsym(library, name);
#endif
  if (!found) {
    fprintf(stderr, "importer: no function %s\n", name);
    exit(1);
  }
  return found;
}

/* A pointer of the type of a declared function, to that of the binary. */
#define LOOK_UP(name) __typeof__(&name) p_##name = (__typeof__(&name))function(#name)

static void check(int status, const char* what) {
  if (status <= 1) return;
  fprintf(stderr, "importer: %s: status %d\n", what, status);
  exit(1);
}

static void logger2(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                    fmi2String message, ...) {
  va_list arguments;
  (void)environment, (void)status;
  va_start(arguments, message);
  fprintf(stderr, "%s: %s: ", name, category);
  vfprintf(stderr, message, arguments);
  fprintf(stderr, "\n");
  va_end(arguments);
}

static void logger3(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String message) {
  (void)environment, (void)status;
  fprintf(stderr, "%s: %s\n", category, message);
}

/* An instance of FMI 2, initialised at time 0. */
static fmi2Component started2(fmi2Type type, const char* resources, const char* token) {
  LOOK_UP(fmi2Instantiate);
  LOOK_UP(fmi2SetupExperiment);
  LOOK_UP(fmi2EnterInitializationMode);
  LOOK_UP(fmi2ExitInitializationMode);
  static const fmi2CallbackFunctions callbacks = {logger2, calloc, free, NULL, NULL};
  char uri[4096];
  fmi2Component one;
  uri_of(resources, uri, sizeof uri);
  one = p_fmi2Instantiate("one", type, token, uri, &callbacks, 0, 1);
  if (!one) exit(1);
  check(p_fmi2SetupExperiment(one, 0, 0.0, 0.0, 0, 0.0), "fmi2SetupExperiment");
  check(p_fmi2EnterInitializationMode(one), "fmi2EnterInitializationMode");
  check(p_fmi2ExitInitializationMode(one), "fmi2ExitInitializationMode");
  return one;
}

/* The same of FMI 3. */
static fmi3Instance started3(bool co_simulation, const char* resources, const char* token) {
  LOOK_UP(fmi3InstantiateModelExchange);
  LOOK_UP(fmi3InstantiateCoSimulation);
  LOOK_UP(fmi3EnterInitializationMode);
  LOOK_UP(fmi3ExitInitializationMode);
  char folder[4096];
  fmi3Instance one;
  snprintf(folder, sizeof folder, "%s/", resources);
  one = co_simulation ? p_fmi3InstantiateCoSimulation("one", token, folder, false, true, false, false, NULL, 0, NULL,
                                                      logger3, NULL)
                      : p_fmi3InstantiateModelExchange("one", token, folder, false, true, NULL, logger3);
  if (!one) exit(1);
  check(p_fmi3EnterInitializationMode(one, false, 0.0, 0.0, false, 0.0), "fmi3EnterInitializationMode");
  check(p_fmi3ExitInitializationMode(one), "fmi3ExitInitializationMode");
  return one;
}

#endif
