// A vehicle that stays upright over the ground: gravity and the lift of the cycle move it up or down. The drag of the
// body, and what its speed changes about the lift, are left out.
import type {Columns} from './core';
import {interpolated} from './measured';

export const gravity = 9.80665; // [m/s2], as in the library

/** The vertical motion of a vehicle whose lift repeats cycle by cycle. */
export class Flight {
  height = 0; // [m] above where it was let go
  speed = 0; // [m/s], upwards
  /** Change of speed from the cycle's beginning to each row [m/s], and of the height at that [m]. */
  private readonly gained: Float64Array;
  private readonly climbed: Float64Array;
  readonly period: number;

  constructor({time_s, lift_n}: Columns, weight: number) {
    const time = time_s!,
      lift = lift_n!;
    this.gained = new Float64Array(time.length);
    this.climbed = new Float64Array(time.length);
    for (let row = 1; row < time.length; ++row) {
      const step = time[row]! - time[row - 1]!,
        before = gravity * (lift[row - 1]! / weight - 1),
        after = gravity * (lift[row]! / weight - 1);
      // The lift is linear in between.
      this.gained[row] = this.gained[row - 1]! + ((before + after) / 2) * step;
      this.climbed[row] =
        this.climbed[row - 1]! + this.gained[row - 1]! * step + (before / 3 + after / 6) * step * step;
    }
    this.period = time[time.length - 1]! - time[0]!;
  }

  /** From one share of the cycle to a later one, at most one cycle on. */
  advance(from: number, to: number): void {
    if (to < from) {
      this.advance(from, 1);
      return this.advance(0, to);
    }
    const duration = (to - from) * this.period,
      gainedBefore = interpolated(this.gained, from);
    // Relative to a vehicle that goes on at the speed it had at `from`.
    this.height +=
      this.speed * duration +
      interpolated(this.climbed, to) -
      interpolated(this.climbed, from) -
      gainedBefore * duration;
    this.speed += interpolated(this.gained, to) - gainedBefore;
  }

  rest() {
    this.height = this.speed = 0;
  }
}

/** What the mean lift over the weight does. */
export const fate = (ratio: number) => (ratio > 1.005 ? 'climbs' : ratio < 0.995 ? 'falls' : 'hovers');

/**
 * The angle of the wing's chord out of the upright [rad], positive where its trailing edge is behind a wing that moves
 * towards positive stroke angles, row by row: of hinges the pitch angle, else from the angle of attack.
 */
export function chordAngles(c: Columns): Float64Array {
  const velocity = c.flapping_velocity_rad_per_s!,
    pitch = c.pitch_angle_rad;
  if (pitch && Number.isFinite(pitch[0])) {
    const lag = pitch.reduce((sum, psi, row) => sum + psi * velocity[row]!, 0);
    return pitch.map((psi) => (lag < 0 ? -psi : psi));
  }
  const attack = c.angle_of_attack_deg!;
  return velocity.map((v, row) => Math.sign(v) * (Math.PI / 2 - (attack[row]! * Math.PI) / 180));
}
