// Fits, motion in flight, joints moved by hand, powers of an instant, tones, states as text: without a browser.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {build} from 'esbuild';
import {doi, published} from '../notices.js';
import {sequence} from './designs.mjs';

let fitting, measured, motion, grips, live, sound, card;
before(async () => {
  const compiled = async (name) => {
    const entry = fileURLToPath(new URL(`../src/${name}.ts`, import.meta.url));
    const {outputFiles} = await build({
      entryPoints: [entry],
      bundle: true,
      format: 'esm',
      write: false,
      plugins: [
        {
          name: 'packed',
          setup: ({onResolve, onLoad}) => {
            onResolve({filter: /^#packed/}, ({path}) => ({path, namespace: 'packed'}));
            onLoad({filter: /.*/, namespace: 'packed'}, () => ({contents: 'export default ""'}));
          },
        },
      ],
      define: {__VERSION__: '"1.2.3"', __DOI__: '"10.5281/example"'},
    });
    return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString('base64')}`);
  };
  [fitting, measured, motion, grips, live, sound, card] = await Promise.all(
    ['fit', 'measured', 'flight_motion', 'pictures/grips', 'pictures/live_flow', 'sound', 'card'].map(compiled),
  );
});

// ---- fits

const rows = 181;
/** A current whose mean, swing and delay follow from two keys. */
const cycleOf = ([a, b]) => {
  const share = Array.from({length: rows}, (_, n) => n / (rows - 1)),
    time_s = Float64Array.from(share, (s) => 0.05 * s),
    current_a = Float64Array.from(
      share,
      (s) => 0.1 * a + 0.05 * Math.sqrt(b) * Math.sin(2 * Math.PI * s) + 0.01 * a * b * Math.cos(4 * Math.PI * s),
    );
  return {time_s, crank_angle_rad: time_s.map((t) => (2 * Math.PI * t) / 0.05), current_a};
};
/** What is measured of it from an instant on, with even scatter. */
function bench(truth, begin, scatter = 0) {
  const cycle = cycleOf(truth),
    next = sequence(5);
  const lines = ['time_s,current_a'];
  for (let n = 0; n < 90; ++n) {
    const t = 0.0009 * n;
    const y = measured.atShare(cycle.current_a, t / 0.05 + begin) + scatter * (2 * next() - 1);
    lines.push(`${t},${y}`);
  }
  return measured.readMeasured('bench.csv', lines.join('\n'), ['time_s', 'crank_angle_rad', 'current_a', 'lift_n']);
}
function fitted(table, start, limits = {lower: [0.1, 0.1], upper: [10, 10]}, model = cycleOf) {
  const first = model(start),
    sizes = measured.sizesOf(table, first),
    {shift} = measured.match(table, first);
  const compare = (values, at) => {
    const cycle = model(values);
    return cycle && measured.residualsOf(table, cycle, sizes, at);
  };
  const seen = [];
  const found = fitting.fit(start, (shift ?? 0) / 0.05, limits, compare, (f) => seen.push(f));
  return {...found, seen};
}

test('a fit finds the keys and the beginning of a measurement', () => {
  const {path, converged, errors, seen} = fitted(bench([1.7, 0.6], 0.3), [1, 1]);
  const last = path.at(-1);
  assert.ok(converged);
  assert.ok(
    Math.abs(last.values[0] / 1.7 - 1) < 1e-3 && Math.abs(last.values[1] / 0.6 - 1) < 2e-3,
    String(last.values),
  );
  assert.ok(last.deviation < 1e-3, String(last.deviation));
  const wrapped = ((((last.shift - 0.3 + 0.5) % 1) + 1) % 1) - 0.5;
  assert.ok(Math.abs(wrapped) < 1e-3, String(last.shift));
  assert.equal(seen.length, path.length);
  for (const [n, {deviation}] of path.entries()) if (n) assert.ok(deviation < path[n - 1].deviation);
  for (const error of errors) assert.ok(error < 1e-3);
});

test('standard errors of a fit are those of the scatter', () => {
  const scatter = 0.004;
  const {path, errors} = fitted(bench([1.7, 0.6], 0.3, scatter), [1, 1]);
  const {values} = path.at(-1);
  // The mean of 90 values scattered evenly by +-0.004 is known to 0.004 / sqrt(3 * 90), of 0.17 A.
  const expected = scatter / Math.sqrt(270) / 0.17;
  assert.ok(errors[0] > 0.7 * expected && errors[0] < 1.5 * expected, `${errors[0]} ${expected}`);
  assert.ok(Math.abs(Math.log(values[0] / 1.7)) < 4 * errors[0], `${values[0]}`);
  assert.ok(Math.abs(Math.log(values[1] / 0.6)) < 4 * errors[1], `${values[1]}`);
});

test('a fit keeps its limits, avoids designs that fail, and says what the data do not fix', () => {
  const {path} = fitted(bench([1.7, 0.6], 0.3), [1, 1], {lower: [0.5, 0.5], upper: [1.5, 2]});
  for (const {values} of path) assert.ok(values[0] <= 1.5 + 1e-12 && values[1] >= 0.5);
  assert.ok(Math.abs(path.at(-1).values[0] - 1.5) < 1e-6);
  const fails = (values) => (values[0] > 1.6 ? null : cycleOf(values));
  const {path: kept} = fitted(bench([1.7, 0.6], 0.3), [1, 1], undefined, fails);
  assert.ok(kept.at(-1).values[0] <= 1.6 && kept.at(-1).values[0] > 1.3, String(kept.at(-1).values));
  // A key without any effect, and two that act as one.
  const {errors: idle} = fitted(bench([1.7, 1], 0.3), [1, 1], undefined, ([a]) => cycleOf([a, 1]));
  assert.ok(idle[0] !== null && idle[1] === null, String(idle));
  const {errors: one} = fitted(bench([1.7, 1], 0.3), [1, 1], undefined, ([a, b]) => cycleOf([a * b, 1]));
  assert.deepEqual(one, [null, null]);
});

test('positive definite systems', () => {
  assert.deepEqual(
    fitting
      .solvePositive(
        [
          [4, 2],
          [2, 3],
        ],
        [2, 5],
      )
      .map((x) => Number(x.toFixed(12))),
    [-0.5, 2],
  );
  assert.equal(
    fitting.solvePositive(
      [
        [1, 1],
        [1, 1],
      ],
      [1, 2],
    ),
    null,
  );
  assert.equal(fitting.solvePositive([[0]], [1]), null);
});

// ---- in flight

const lifts = (f, period = 0.04, count = 201) => {
  const time_s = Float64Array.from({length: count}, (_, n) => (period * n) / (count - 1));
  return {time_s, lift_n: time_s.map(f)};
};

test('a vehicle falls as a stone without lift, and rests where lift is weight', () => {
  const stone = new motion.Flight(
    lifts(() => 0),
    0.03,
  );
  for (let n = 0; n < 40; ++n) stone.advance((n % 10) / 10, ((n % 10) + 1) / 10);
  const t = 4 * 0.04;
  assert.ok(Math.abs(stone.speed / (-motion.gravity * t) - 1) < 1e-9);
  assert.ok(Math.abs(stone.height / (-0.5 * motion.gravity * t * t) - 1) < 1e-9);
  const even = new motion.Flight(
    lifts(() => 0.03),
    0.03,
  );
  for (let n = 0; n < 40; ++n) even.advance((n * 0.37) % 1, ((n + 1) * 0.37) % 1);
  assert.ok(Math.abs(even.speed) < 1e-12 && Math.abs(even.height) < 1e-12);
});

test('a lift that swings about the weight is integrated, whatever the steps', () => {
  const weight = 0.03,
    period = 0.04,
    swing = (t) => weight * (1 + Math.sin((2 * Math.PI * t) / period));
  const whole = (steps) => {
    const flight = new motion.Flight(lifts(swing, period, 2001), weight);
    for (let n = 0; n < steps; ++n) flight.advance(n / steps, (n + 1) / steps);
    return flight;
  };
  // From rest the speed is g T / 2 pi (1 - cos), so that a cycle climbs g T^2 / 2 pi.
  const expected = (motion.gravity * period ** 2) / (2 * Math.PI);
  for (const steps of [1, 7, 100]) {
    const {height, speed} = whole(steps);
    assert.ok(Math.abs(height / expected - 1) < 1e-5, `${steps} ${height}`);
    assert.ok(Math.abs(speed) < 1e-9);
  }
  // Over the end of the cycle, too.
  const flight = new motion.Flight(lifts(swing, period, 2001), weight);
  flight.advance(0.75, 0.25);
  assert.ok(Math.abs(flight.speed) < 1e-9, String(flight.speed)); // half a swing each way
  assert.deepEqual(['falls', 'hovers', 'climbs'], [0.9, 1, 1.1].map(motion.fate));
});

test('the chord trails behind the moving wing, of hinges and of the pitch law', () => {
  const velocity = Float64Array.from([2, 1, 0, -1, -2]);
  const law = motion.chordAngles({
    flapping_velocity_rad_per_s: velocity,
    angle_of_attack_deg: Float64Array.from([30, 60, 90, 60, 30]),
  });
  const degrees = Array.from(law, (x) => Math.round((x * 180) / Math.PI));
  assert.deepEqual(
    degrees.map((x) => x + 0),
    [60, 30, 0, -30, -60],
  );
  for (const sense of [1, -1]) {
    const hinge = motion.chordAngles({
      flapping_velocity_rad_per_s: velocity,
      pitch_angle_rad: velocity.map((v) => 0.3 * sense * v),
      angle_of_attack_deg: velocity,
    });
    assert.ok(hinge[0] > 0 && hinge[4] < 0);
  }
});

// ---- joints moved by hand

const plane = {axis: [0, 0], pin: [0.003, 0.004], hinge: [0.006, 0.02], tip: [0.026, 0.02]};
const at = (joint) => plane[joint];
const crank = {type: 'slider-crank'};

test('a joint that is moved gives its key', () => {
  const values = {'transmission.crank_radius': 0.005, 'transmission.hinge_offset': 0.006, 'wing.planform.length': 0.08};
  const [pin, hinge, tip] = grips.gripsOf(crank, values, []);
  assert.deepEqual([pin.key, hinge.key, tip.key], Object.keys(values));
  const {valueAt} = grips;
  assert.equal(valueAt(pin, values, at, [0.006, 0.008]), 0.01);
  assert.equal(valueAt(pin, values, at, [0.003 + 0.004, 0.004 - 0.003]), 0.005); // across the crank: nothing
  assert.equal(valueAt(pin, values, at, [-0.003, -0.004]), null); // beyond the axis
  assert.equal(valueAt(hinge, values, at, [0.009, 0.5]), 0.009);
  assert.equal(valueAt(tip, values, at, [0.016, 0.02]), 0.04);
  assert.equal(valueAt(hinge, values, at, [-0.001, 0]), null);
});

test('of a stated stroke the hinge gives the stroke; without a length of the outline the tip gives the scale', () => {
  const values = {'transmission.crank_radius': 0.005, 'transmission.stroke_amplitude': 0.7};
  const keys = [{key: 'wing.planform.scale'}];
  const [, hinge, tip] = grips.gripsOf(crank, values, keys);
  assert.equal(hinge.key, 'transmission.stroke_amplitude');
  assert.ok(Math.abs(grips.valueAt(hinge, values, at, [0.005, 0]) - Math.PI / 4) < 1e-5);
  assert.equal(tip.key, 'wing.planform.scale');
  assert.equal(grips.valueAt(tip, values, at, [0.036, 0.02]), 1.5);
  assert.deepEqual(
    grips.gripsOf({type: 'direct'}, values, keys).map((g) => g.joint),
    ['tip'],
  );
  assert.equal(grips.gripsOf({type: 'four-bar'}, {...values, 'transmission.ground_length': 0.01}, []).length, 2);
  assert.equal(grips.drawnWing({'wing.planform.scale': 9}, {}), 2.5);
  assert.equal(grips.drawnWing({'wing.planform.length': 0.03}, {'wing.planform.length': 0.02}), 1.5);
});

// ---- powers of an instant

test('losses of an instant have their means, and all of them the input', () => {
  const n = 401,
    of = (f) => Float64Array.from({length: n}, (_, i) => f((2 * Math.PI * i) / (n - 1)));
  const columns = {
    time_s: of((x) => 0.05 * (x / (2 * Math.PI))),
    current_a: of((x) => 0.1 + 0.05 * Math.sin(x)),
    crank_speed_rad_per_s: of((x) => 130 + 20 * Math.cos(x)),
    power_electrical_w: of((x) => 0.3 + 0.1 * Math.sin(x)),
    power_motor_w: of((x) => 0.1 - 0.2 * Math.sin(x)),
    power_friction_w: of(() => 0.02),
    power_aerodynamic_w: of((x) => 0.07 * (1 - Math.cos(2 * x))),
  };
  const balance = {electrical: 0.3, copper: 0.15, viscous: 0.05, motor_friction: 0, gear: 0.01};
  const powers = live.powersOf(columns, balance);
  for (const part of ['copper', 'viscous', 'gear'])
    assert.ok(Math.abs(live.meanOf(powers[part], columns.time_s) / balance[part] - 1) < 1e-9, part);
  assert.ok(Math.abs(powers.copper[100] / powers.copper[0] - 0.15 ** 2 / 0.1 ** 2) < 1e-9);
  assert.equal(powers.electrical, columns.power_electrical_w);
});

// ---- tones

test('the partial tones of a cycle are its harmonics', () => {
  const cycle = Float64Array.from(
    {length: 361},
    (_, n) => 3 + Math.sin((4 * Math.PI * n) / 360) + 0.25 * Math.cos((2 * Math.PI * n) / 360),
  );
  const {real, imag} = sound.partialsOf(cycle, 6);
  assert.ok(Math.abs(imag[2] - 1) < 1e-6 && Math.abs(real[1] - 0.25) < 1e-6);
  for (const k of [3, 4, 5, 6]) assert.ok(Math.hypot(real[k], imag[k]) < 1e-6);
  assert.equal(real[0], 0); // a mean is no tone
});

// ---- values of the paper, cards

test('every value of the paper is read, with what it compares', () => {
  const values = published();
  assert.equal(values.length, 12);
  const lift = values.find((v) => v.metric === 'lift_mean_n' && v.voltage === '3 V');
  assert.equal(lift.value, '33.3 %');
  assert.ok(lift.change && lift.design === 'friction2022-springs' && lift.against === 'friction2022');
  const peak = values.find((v) => v.metric === 'rod_force_peak_n' && v.design === 'friction2022');
  assert.equal(peak.value, '432 mN');
  assert.equal(peak.against, null);
  for (const {where, basis, voltage, frequency} of values) assert.ok(where && basis && (voltage ?? frequency));
  const cited = doi();
  assert.ok(cited === null || /^10\./.test(cited), String(cited));
});

test('texts of a card are broken at blanks', () => {
  assert.deepEqual(card.wrapped('one two three four', 9), ['one two', 'three', 'four']);
  assert.deepEqual(card.wrapped('', 9), ['']);
});
