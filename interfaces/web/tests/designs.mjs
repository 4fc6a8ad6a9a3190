// Designs around the vehicles that come along: voltages, springs, friction, wings, cranks; locking ones among them.

/** A sequence of numbers between 0 and 1, the same in every run. */
export function sequence(seed) {
  let state = seed;
  return () => (state = (state * 1664525 + 1013904223) % 4294967296) / 4294967296;
}

const varied = [
  'spring.stiffness',
  'spring.resonance',
  'friction.radius',
  'friction.torque',
  'wing.inertia',
  'transmission.crank_radius',
  'motor.armature_resistance',
  'motor.inertia',
  'aerodynamics.air_density',
];
const voltages = ['supply.voltage', 'supply.amplitude', 'supply.duty', 'supply.state_of_charge'];

/** `count` designs: vehicle, changes and condition; `values` are those of every vehicle's keys. */
export function designs(count, values) {
  const next = sequence(2022),
    ofDuties = sequence(2026); // of batteries, which leave the other numbers as they were
  const vehicles = Object.keys(values);
  // A piezo damps so little that some changes leave it without one orbit, which takes seconds to see.
  const changed = vehicles.filter((name) => !('piezo.force_per_volt' in values[name]));
  return Array.from({length: count}, (_, n) => {
    const vehicle = n < vehicles.length ? vehicles[n] : changed[n % changed.length],
      of = values[vehicle],
      changes = {};
    const scale = (key, low, high, draw = next) => {
      const value = of[key];
      if (typeof value === 'number' && value !== 0)
        changes[key] = String(Number((value * (low + (high - low) * draw())).toPrecision(6)));
    };
    if (n >= vehicles.length) {
      for (const key of voltages)
        if (key in of) {
          const draw = key === 'supply.duty' && 'supply.capacity' in of ? ofDuties : next;
          scale(key, 0.1, key === 'supply.voltage' || key === 'supply.amplitude' ? 1.6 : 1, draw);
        }
      for (const key of varied) if (key in of && next() < 0.3) scale(key, 0.4, 1.7);
      if (!('spring.stiffness' in of) && !('spring.resonance' in of) && next() < 0.4) {
        changes['spring.stiffness'] = String(Number((2e-3 * next()).toPrecision(6)));
      }
    }
    return {vehicle, changes, condition: next() < 0.12 ? 'vacuum' : 'air'};
  });
}
