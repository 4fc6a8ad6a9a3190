/* Model exchange with CVODE of SUNDIALS, FMI 2 or 3, through the functions that the project declares from the standard:
 *   cvode_importer BINARY RESOURCES TOKEN 2|3 STATES INDICATORS END TOLERANCE REFERENCE...
 * Adams' formulas with Newton's method; events located by CVODE's root search, those known beforehand by its stop time.
 * Prints the values of the references [SI] at the end, one a line, to the last digit; then the peak of the first in the
 * last tenth of a second, the highest top of a parabola through the ends of two steps that follow each other. */
#include "importer.h"

#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#define MOST 64

/* Of either version; the functions of model exchange that differ in no more than their names. */
static struct {
  void* one;
  int version;
  size_t states, indicators;
  int (*set_time)(void*, double);
  int (*set_states)(void*, const double*, size_t);
  int (*get_states)(void*, double*, size_t);
  int (*get_rates)(void*, double*, size_t);
  int (*get_indicators)(void*, double*, size_t);
  int (*get_nominals)(void*, double*, size_t);
  int (*get_reals)(void*, const unsigned*, size_t, double*); /* of FMI 2 */
  int (*completed)(void*, int, int*, int*);                  /* of FMI 2; FMI 3 has other truth values */
} fmu;

typedef struct {
  int terminate, next_defined;
  double next;
} Update;

#define TAKE(member, name) *(void**)&fmu.member = function(name)

static void start2(const char* resources, const char* token) {
  fmu.one = started2(fmi2ModelExchange, resources, token);
  TAKE(set_time, "fmi2SetTime");
  TAKE(set_states, "fmi2SetContinuousStates");
  TAKE(get_states, "fmi2GetContinuousStates");
  TAKE(get_rates, "fmi2GetDerivatives");
  TAKE(get_indicators, "fmi2GetEventIndicators");
  TAKE(get_nominals, "fmi2GetNominalsOfContinuousStates");
  TAKE(get_reals, "fmi2GetReal");
  TAKE(completed, "fmi2CompletedIntegratorStep");
}

static void start3(const char* resources, const char* token) {
  LOOK_UP(fmi3GetNumberOfContinuousStates);
  LOOK_UP(fmi3GetNumberOfEventIndicators);
  size_t states, indicators;
  fmu.one = started3(false, resources, token);
  check(p_fmi3GetNumberOfContinuousStates(fmu.one, &states), "fmi3GetNumberOfContinuousStates");
  check(p_fmi3GetNumberOfEventIndicators(fmu.one, &indicators), "fmi3GetNumberOfEventIndicators");
  check(states == fmu.states && indicators == fmu.indicators ? 0 : 3, "numbers of states and event indicators");
  TAKE(set_time, "fmi3SetTime");
  TAKE(set_states, "fmi3SetContinuousStates");
  TAKE(get_states, "fmi3GetContinuousStates");
  TAKE(get_rates, "fmi3GetContinuousStateDerivatives");
  TAKE(get_indicators, "fmi3GetEventIndicators");
  TAKE(get_nominals, "fmi3GetNominalsOfContinuousStates");
}

/* From event mode to continuous time. */
static Update update(void) {
  Update to = {0, 0, 0.0};
  int again = 1;
  while (again) {
    if (fmu.version == 2) {
      LOOK_UP(fmi2NewDiscreteStates);
      fmi2EventInfo info;
      check(p_fmi2NewDiscreteStates(fmu.one, &info), "fmi2NewDiscreteStates");
      again = info.newDiscreteStatesNeeded;
      to.terminate = info.terminateSimulation, to.next_defined = info.nextEventTimeDefined;
      to.next = info.nextEventTime;
    } else {
      LOOK_UP(fmi3UpdateDiscreteStates);
      fmi3Boolean needed, terminate, nominals, states, defined;
      check(p_fmi3UpdateDiscreteStates(fmu.one, &needed, &terminate, &nominals, &states, &defined, &to.next),
            "fmi3UpdateDiscreteStates");
      again = needed;
      to.terminate = terminate, to.next_defined = defined;
    }
  }
  check(((int (*)(void*))function(fmu.version == 2 ? "fmi2EnterContinuousTimeMode" : "fmi3EnterContinuousTimeMode"))(
            fmu.one),
        "EnterContinuousTimeMode");
  return to;
}

static void enter_event_mode(void) {
  check(((int (*)(void*))function(fmu.version == 2 ? "fmi2EnterEventMode" : "fmi3EnterEventMode"))(fmu.one),
        "EnterEventMode");
}

/* True where the FMU asks for an event after a step. */
static int completed_step(void) {
  if (fmu.version == 2) {
    int event = 0, terminate = 0;
    check(fmu.completed(fmu.one, 1, &event, &terminate), "fmi2CompletedIntegratorStep");
    return event;
  }
  LOOK_UP(fmi3CompletedIntegratorStep);
  fmi3Boolean event = false, terminate = false;
  check(p_fmi3CompletedIntegratorStep(fmu.one, true, &event, &terminate), "fmi3CompletedIntegratorStep");
  return event;
}

static void get(const unsigned* references, size_t count, double* values) {
  if (fmu.version == 2) {
    check(fmu.get_reals(fmu.one, references, count, values), "fmi2GetReal");
  } else {
    LOOK_UP(fmi3GetFloat64);
    check(p_fmi3GetFloat64(fmu.one, references, count, values, count), "fmi3GetFloat64");
  }
}

static void put(double t, N_Vector y) {
  check(fmu.set_time(fmu.one, t), "SetTime");
  check(fmu.set_states(fmu.one, NV_DATA_S(y), fmu.states), "SetContinuousStates");
}

static int rates(realtype t, N_Vector y, N_Vector dy, void* data) {
  (void)data;
  put(t, y);
  return fmu.get_rates(fmu.one, NV_DATA_S(dy), fmu.states) > 1 ? 1 : 0;
}

static int roots(realtype t, N_Vector y, realtype* values, void* data) {
  (void)data;
  put(t, y);
  return fmu.get_indicators(fmu.one, values, fmu.indicators) > 1 ? 1 : 0;
}

/* The last three points, and the highest top of a parabola through such. */
static struct {
  int count;
  double t[3], value[3], top;
} peak;

static void sample(double t, unsigned reference) {
  double a, b, curvature, slope, top;
  int k;
  for (k = 0; k < 2; ++k) peak.t[k] = peak.t[k + 1], peak.value[k] = peak.value[k + 1];
  peak.t[2] = t;
  get(&reference, 1, &peak.value[2]);
  if (++peak.count < 3 || peak.value[1] < peak.value[0] || peak.value[1] < peak.value[2]) return;
  a = (peak.value[1] - peak.value[0]) / (peak.t[1] - peak.t[0]);
  b = (peak.value[2] - peak.value[1]) / (peak.t[2] - peak.t[1]);
  curvature = (b - a) / (peak.t[2] - peak.t[0]);
  slope = a + curvature * (peak.t[1] - peak.t[0]); /* at the middle point */
  top = peak.value[1] - (curvature < 0.0 ? 0.25 * slope * slope / curvature : 0.0);
  if (top > peak.top) peak.top = top;
}

static void integrate(double end, double tolerance, unsigned sampled) {
  SUNContext context;
  Update next = update();
  double t = 0.0;
  check(SUNContext_Create(NULL, &context) ? 3 : 0, "SUNContext_Create");
  N_Vector y = N_VNew_Serial((sunindextype)fmu.states, context), sizes = N_VClone(y);
  SUNMatrix jacobian = SUNDenseMatrix((sunindextype)fmu.states, (sunindextype)fmu.states, context);
  SUNLinearSolver solver = SUNLinSol_Dense(y, jacobian, context);
  void* cvode = CVodeCreate(CV_ADAMS, context);
  check(fmu.get_states(fmu.one, NV_DATA_S(y), fmu.states), "GetContinuousStates");
  check(fmu.get_nominals(fmu.one, NV_DATA_S(sizes), fmu.states), "GetNominalsOfContinuousStates");
  N_VScale(tolerance, sizes, sizes);
  check(CVodeInit(cvode, rates, t, y) ? 3 : 0, "CVodeInit");
  check(CVodeSVtolerances(cvode, tolerance, sizes) ? 3 : 0, "CVodeSVtolerances");
  check(CVodeSetLinearSolver(cvode, solver, jacobian) ? 3 : 0, "CVodeSetLinearSolver");
  check(CVodeRootInit(cvode, (int)fmu.indicators, roots) ? 3 : 0, "CVodeRootInit");
  check(CVodeSetMaxNumSteps(cvode, 1000000) ? 3 : 0, "CVodeSetMaxNumSteps");
  CVodeSetNoInactiveRootWarn(cvode);
  while (t < end && !next.terminate) {
    const double stop = next.next_defined && next.next < end ? next.next : end;
    check(CVodeSetStopTime(cvode, stop) ? 3 : 0, "CVodeSetStopTime");
    const int result = CVode(cvode, stop, y, &t, CV_ONE_STEP);
    check(result < 0 ? 3 : 0, "CVode");
    put(t, y);
    if (t > end - 0.1) {
      check(CVodeSetMaxStep(cvode, 2e-5) ? 3 : 0, "CVodeSetMaxStep");
      sample(t, sampled);
    }
    if (!completed_step() && result != CV_ROOT_RETURN && !(next.next_defined && t >= next.next)) continue;
    enter_event_mode();
    next = update();
    check(fmu.get_states(fmu.one, NV_DATA_S(y), fmu.states), "GetContinuousStates");
    check(CVodeReInit(cvode, t, y) ? 3 : 0, "CVodeReInit");
  }
  CVodeFree(&cvode);
  SUNLinSolFree(solver);
  SUNMatDestroy(jacobian);
  N_VDestroy(sizes);
  N_VDestroy(y);
  SUNContext_Free(&context);
}

int main(int argc, char** argv) {
  unsigned references[MOST];
  double values[MOST];
  int n, count = argc - 9;
  if (count < 1 || count > MOST) return 2;
  load(argv[1]);
  fmu.version = atoi(argv[4]);
  fmu.states = (size_t)atoi(argv[5]), fmu.indicators = (size_t)atoi(argv[6]);
  (fmu.version == 2 ? start2 : start3)(argv[2], argv[3]);
  for (n = 0; n < count; ++n) references[n] = (unsigned)strtoul(argv[9 + n], NULL, 10);
  integrate(atof(argv[7]), atof(argv[8]), references[0]);
  get(references, (size_t)count, values);
  ((void (*)(void*))function(fmu.version == 2 ? "fmi2FreeInstance" : "fmi3FreeInstance"))(fmu.one);
  for (n = 0; n < count; ++n) printf("%.17g\n", values[n]);
  printf("%.17g\n", peak.top);
  return 0;
}
