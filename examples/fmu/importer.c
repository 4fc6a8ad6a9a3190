/* A co-simulation of an FMU's binary, FMI 2 or 3, through the functions that the project declares from the standard:
 *   importer BINARY RESOURCES TOKEN 2|3 END STEP REFERENCE...
 * Prints the values of the references [SI] at the end, one a line, to the last digit. The same source for Linux and, by
 * MinGW-w64, Windows. */
#include "importer.h"

#define MOST 64

static void run2(const char* resources, const char* token, double end, double step, const unsigned* references,
                 int count, double* values) {
  LOOK_UP(fmi2DoStep);
  LOOK_UP(fmi2GetReal);
  LOOK_UP(fmi2Terminate);
  LOOK_UP(fmi2FreeInstance);
  fmi2Component one = started2(fmi2CoSimulation, resources, token);
  long k, steps = (long)(end / step + 0.5);
  for (k = 0; k < steps; ++k) check(p_fmi2DoStep(one, (double)k * step, step, 1), "fmi2DoStep");
  check(p_fmi2GetReal(one, references, (size_t)count, values), "fmi2GetReal");
  check(p_fmi2Terminate(one), "fmi2Terminate");
  p_fmi2FreeInstance(one);
}

static void run3(const char* resources, const char* token, double end, double step, const unsigned* references,
                 int count, double* values) {
  LOOK_UP(fmi3DoStep);
  LOOK_UP(fmi3GetFloat64);
  LOOK_UP(fmi3Terminate);
  LOOK_UP(fmi3FreeInstance);
  fmi3Instance one = started3(true, resources, token);
  long k, steps = (long)(end / step + 0.5);
  for (k = 0; k < steps; ++k) {
    fmi3Boolean event = false, terminate = false, early = false;
    fmi3Float64 last = 0.0;
    check(p_fmi3DoStep(one, (double)k * step, step, true, &event, &terminate, &early, &last), "fmi3DoStep");
  }
  check(p_fmi3GetFloat64(one, references, (size_t)count, values, (size_t)count), "fmi3GetFloat64");
  check(p_fmi3Terminate(one), "fmi3Terminate");
  p_fmi3FreeInstance(one);
}

/* Every function of the standard must be there. */
#define LOOK_FOR(result, name, parameters) function(#name);

int main(int argc, char** argv) {
  unsigned references[MOST];
  double values[MOST];
  int n, count = argc - 7;
  if (count < 1 || count > MOST) return 2;
  load(argv[1]);
  FMI2_FUNCTIONS(LOOK_FOR)
  FMI3_FUNCTIONS(LOOK_FOR)
  for (n = 0; n < count; ++n) references[n] = (unsigned)strtoul(argv[7 + n], NULL, 10);
  if (strcmp(argv[4], "2") == 0) run2(argv[2], argv[3], atof(argv[5]), atof(argv[6]), references, count, values);
  else run3(argv[2], argv[3], atof(argv[5]), atof(argv[6]), references, count, values);
  for (n = 0; n < count; ++n) printf("%.17g\n", values[n]);
  return 0;
}
