// A vehicle whose body MuJoCo moves under the loads of its wings, beside the same flight by wingbeat alone:
//   fly VEHICLE.toml MODEL.xml [SECONDS]
// MODEL.xml is what wingbeat.export_mjcf wrote of the vehicle. Both begin in the trim of hover with a small disturbance
// and keep its controls. Prints the distance between them for four steps of MuJoCo; it is to shrink with the step.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "wingbeat_flight.h"

namespace {

void check(int failed) {
  if (!failed) return;
  std::fprintf(stderr, "fly: %s\n", wingbeat_flight_error());
  std::exit(1);
}

/// The body in hover, moving a little.
void begin(wingbeat_flight* flight, double* controls, double* qpos, double* qvel) {
  check(wingbeat_flight_trim(flight, 0.0, controls, qpos, qvel));
  const double disturbance[6] = {0.05, 0.02, 0.0, 0.1, -0.2, 0.3};  // m/s, rad/s
  for (int k = 0; k < 6; ++k) qvel[k] += disturbance[k];
  check(wingbeat_flight_place(flight, qpos, qvel));
}

struct Distances {
  double largest = 0.0, last = 0.0;  ///< [m]
};

Distances fly(const char* vehicle, mjModel* model, double step, double seconds) {
  wingbeat_flight* moved = wingbeat_flight_create(vehicle);
  wingbeat_flight* alone = wingbeat_flight_create(vehicle);
  if (!moved || !alone) check(1);
  model->opt.timestep = step;
  mjData* data = mj_makeData(model);
  double controls[WINGBEAT_FLIGHT_CONTROLS], qpos[7], qvel[6];
  begin(moved, controls, data->qpos, data->qvel);
  begin(alone, controls, qpos, qvel);
  const int body = mj_name2id(model, mjOBJ_BODY, "body");
  const long steps = std::lround(seconds / step), per_look = std::max(1L, std::lround(0.01 / step));
  Distances distances;
  for (long n = 1; n <= steps; ++n) {
    double* applied = data->xfrc_applied + 6 * body;  // force, then torque
    check(wingbeat_flight_step(moved, data->qpos, data->qvel, step, controls, applied, applied + 3));
    mj_step(model, data);
    if (n % per_look != 0) continue;
    check(wingbeat_flight_fly(alone, double(per_look) * step, controls, qpos, qvel));
    distances.last = std::hypot(data->qpos[0] - qpos[0], data->qpos[1] - qpos[1], data->qpos[2] - qpos[2]);
    distances.largest = std::max(distances.largest, distances.last);
  }
  mj_deleteData(data);
  wingbeat_flight_free(moved);
  wingbeat_flight_free(alone);
  return distances;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) return std::fprintf(stderr, "fly VEHICLE.toml MODEL.xml [SECONDS]\n"), 2;
  const double seconds = count > 3 ? std::atof(arguments[3]) : 1.0;
  char error[1000] = "";
  mjModel* model = mj_loadXML(arguments[2], nullptr, error, sizeof error);
  if (!model) return std::fprintf(stderr, "fly: %s\n", error), 2;
  std::printf("distance between MuJoCo %s and wingbeat over %g s\n", mj_versionString(), seconds);
  std::printf("%10s %14s %14s\n", "step [s]", "largest [mm]", "last [mm]");
  double before = 0.0;
  bool shrinks = true;
  for (const double step : {4e-4, 2e-4, 1e-4, 5e-5}) {
    const Distances found = fly(arguments[1], model, step, seconds);
    std::printf("%10.1e %14.5f %14.5f\n", step, 1e3 * found.largest, 1e3 * found.last);
    shrinks = shrinks && (before == 0.0 || found.largest < 0.7 * before);
    before = found.largest;
  }
  mj_deleteModel(model);
  if (!shrinks) std::fprintf(stderr, "fly: the distance does not shrink with the step\n");
  return shrinks ? 0 : 1;
}
