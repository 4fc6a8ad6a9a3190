/* Loads of flapping wings for another program's rigid body, such as MuJoCo's free joint: each step the body's state in,
 * the mean force and torque of the step out. C, for any language that calls C.
 *
 *   wingbeat_flight* flight = wingbeat_flight_create("flight-friction2022.toml");
 *   wingbeat_flight_trim(flight, 0.0, controls, d->qpos, d->qvel);
 *   wingbeat_flight_step(flight, d->qpos, d->qvel, m->opt.timestep, controls, force, torque);
 *
 * Axes are those of MuJoCo: x forward, y to the left, z up. `qpos` is position [m] and unit quaternion (w, x, y, z),
 * `qvel` the velocity in world axes [m/s] and the angular velocity in body axes [rad/s], both of the centre of mass.
 * Controls are SI, angles in radians, in the order of wingbeat_flight_control_name. Functions that return int return 0,
 * or another number where wingbeat_flight_error has a sentence. A flight has one user at a time. */
#ifndef WINGBEAT_FLIGHT_H
#define WINGBEAT_FLIGHT_H

#ifdef __cplusplus
extern "C" {
#endif

#define WINGBEAT_FLIGHT_CONTROLS 7

typedef struct wingbeat_flight wingbeat_flight;

/* Of a vehicle file with a body, drives at rest; null where it cannot be used. Vehicles whose wings have mass that acts
 * on the body (body.wing_mass) are refused: their loads alone do not give the motion of the body. */
wingbeat_flight* wingbeat_flight_create(const char* vehicle_file);
void wingbeat_flight_free(wingbeat_flight* flight);

/* The last error of the calling thread. */
const char* wingbeat_flight_error(void);

/* "voltage", "mean_stroke_angle", ...; null for an index from WINGBEAT_FLIGHT_CONTROLS on. */
const char* wingbeat_flight_control_name(int index);

/* Steady flight at a speed [m/s]: controls, and the state of the body at the origin. The flight begins there, at time
 * 0, the drives in the cycle of that flight. */
int wingbeat_flight_trim(wingbeat_flight* flight, double speed, double controls[WINGBEAT_FLIGHT_CONTROLS],
                         double qpos[7], double qvel[6]);

/* Wind in world axes [m/s], from now on. */
int wingbeat_flight_wind(wingbeat_flight* flight, const double wind[3]);

/* Goes on by dt [s] from that state of the body. `force` [N] and `torque` [N m] are means over the step of what the air
 * does to the vehicle, at its centre of mass, in world axes, without its weight: for xfrc_applied. */
int wingbeat_flight_step(wingbeat_flight* flight, const double qpos[7], const double qvel[6], double dt,
                         const double controls[WINGBEAT_FLIGHT_CONTROLS], double force[3], double torque[3]);

/* Moves the body, and lets the flight go on by dt [s] by itself: what it is compared with. */
int wingbeat_flight_place(wingbeat_flight* flight, const double qpos[7], const double qvel[6]);
int wingbeat_flight_fly(wingbeat_flight* flight, double dt, const double controls[WINGBEAT_FLIGHT_CONTROLS],
                        double qpos[7], double qvel[6]);

#ifdef __cplusplus
}
#endif

#endif
