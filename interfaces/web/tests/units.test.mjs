// State, history, links and quantities, without a browser.
import assert from 'node:assert/strict';
import {before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {build} from 'esbuild';
import {sequence} from './designs.mjs';

let state, link, quantities, elsewhere, hover, measured, axes;
before(async () => {
  const compiled = async (name) => {
    const entry = fileURLToPath(new URL(`../src/${name}.ts`, import.meta.url));
    const {outputFiles} = await build({entryPoints: [entry], bundle: true, format: 'esm', write: false});
    return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString('base64')}`);
  };
  [state, link, quantities, elsewhere, hover, measured, axes] = await Promise.all(
    ['state', 'link', 'quantities', 'elsewhere', 'hover', 'measured', 'pictures/axes'].map(compiled),
  );
});

const shipped = {one: '[vehicle]\nname = "one"\n', two: '[vehicle]\nname = "two"\n'};
const design = (name = 'one', changes = {}, text = shipped[name]) => ({name, text, changes});

test('history: undo, redo, and what a new step drops', () => {
  const history = new state.History('a');
  assert.ok(!history.canUndo && !history.canRedo);
  assert.ok(history.commit('b'));
  assert.ok(!history.commit('b'), 'the same state is no step');
  history.commit('c');
  assert.equal(history.undo(), 'b');
  assert.equal(history.undo(), 'a');
  assert.equal(history.undo(), 'a');
  assert.equal(history.redo(), 'b');
  history.commit('d');
  assert.ok(!history.canRedo);
  assert.equal(history.undo(), 'b');
  history.visit('d');
  assert.equal(history.present, 'd');
  history.visit('e');
  assert.equal(history.undo(), 'd');
});

test('history: quick changes of one control are one step', () => {
  const history = new state.History('a');
  assert.ok(history.commit('b', 'voltage', 0));
  assert.ok(!history.commit('c', 'voltage', 500));
  assert.ok(!history.commit('d', 'voltage', 1200));
  assert.ok(history.commit('e', 'radius', 1300));
  assert.ok(history.commit('f', 'radius', 2400));
  assert.equal(history.undo(), 'e');
  assert.equal(history.undo(), 'd');
  assert.equal(history.undo(), 'a');
});

test('history: an impossible state is taken out wherever it stands; the longest is kept short', () => {
  const history = new state.History('a', 4);
  for (const s of ['b', 'c', 'd', 'e']) history.commit(s);
  history.remove('e');
  assert.equal(history.present, 'd');
  history.remove('c');
  assert.equal(history.undo(), 'b');
  assert.equal(history.undo(), 'b', 'a is forgotten');
});

test('designs are alike where they are computed alike', () => {
  const {identityOf} = state;
  const air = {condition: 'air'};
  const one = identityOf(design('one', {a: '1', b: '2'}), air);
  assert.equal(identityOf(design('one', {b: '2', a: '1'}), air), one);
  assert.notEqual(identityOf(design('one', {a: '1'}), air), one);
  assert.notEqual(identityOf(design('two', {a: '1', b: '2'}), air), one);
  assert.notEqual(identityOf(design('one', {a: '1', b: '2'}), {condition: 'vacuum'}), one);
});

const full = () => ({
  design: design('mine', {'supply.voltage': '2.75 V', 'wing.note': 'a=b & c'}, '[vehicle]\nname = "Flügel"\n'),
  pins: [design('one', {'x.y': '1'}), design('two')],
  condition: 'vacuum',
  hold: 'frequency',
  held: 22.5,
});

test('a link gives the state back', async () => {
  for (const wanted of [full(), state.stateFor(design()), {...full(), hold: 'lift', held: 0.0098}]) {
    const {state: found, problems} = await link.stateOf(await link.linkOf(wanted, shipped), shipped);
    assert.deepEqual(problems, []);
    assert.deepEqual(found, wanted);
  }
});

test('a link that was cut off anywhere is refused with a reason', async () => {
  const whole = await link.linkOf(full(), shipped);
  for (let length = 2; length < whole.length; ++length) {
    const {state: found, problems} = await link.stateOf(whole.slice(0, length), shipped);
    assert.equal(found, null, whole.slice(0, length));
    assert.ok(problems.length > 0);
  }
});

test('a link with a character changed never throws, and is refused or a state', async () => {
  const whole = await link.linkOf(full(), shipped),
    next = sequence(7);
  for (let n = 0; n < 300; ++n) {
    const place = 1 + Math.floor(next() * (whole.length - 1));
    const letter = String.fromCharCode(33 + Math.floor(next() * 90));
    const {state: found, problems} = await link.stateOf(
      whole.slice(0, place) + letter + whole.slice(place + 1),
      shipped,
    );
    assert.equal(found === null, problems.length > 0);
  }
});

test('links written by hand, and names that objects have', async () => {
  const {state: found} = await link.stateOf('#vehicle=two&set=a.b%3D1&lift=0.01', shipped);
  assert.deepEqual(found, {...state.stateFor(design('two', {'a.b': '1'})), hold: 'lift', held: 0.01});
  for (const name of ['constructor', '__proto__', 'toString', '']) {
    assert.equal((await link.stateOf(`#vehicle=${name}`, shipped)).state, null, name);
  }
  assert.deepEqual(await link.stateOf('', shipped), {state: null, problems: []});
});

test('numbers for reading are the numbers to four figures', () => {
  const next = sequence(11);
  const prefixes = {n: 1e-9, µ: 1e-6, m: 1e-3, k: 1e3, M: 1e6};
  for (let n = 0; n < 3000; ++n) {
    const x = (next() < 0.5 ? -1 : 1) * 10 ** (-9 + 15 * next());
    const said = quantities.readable(x, 'V');
    const [, number, prefix] = said.match(/^(-?[\d.]+(?:e-?\d+)?) (.?)V$/);
    const value = Number(number) * (prefixes[prefix] ?? 1);
    assert.ok(Math.abs(value / x - 1) < 5.1e-4, `${x} ${said}`);
    assert.ok(Math.abs(Number(number)) < 1000 || Math.abs(x) > 1e6, `${x} ${said}`);
  }
});

test('units for reading', () => {
  const {readable, shownUnit, tickText, digits} = quantities;
  assert.equal(readable(0.0123456, 'N'), '12.35 mN');
  assert.equal(readable(0.99998, 'V'), '1 V');
  assert.equal(readable(Math.PI / 2, 'rad'), '90°');
  assert.equal(readable(25, 'degC'), '25 °C');
  assert.equal(readable(0, 'A'), '0 A');
  assert.equal(readable(null, 'A'), '–');
  assert.equal(readable(NaN, 'A'), '–');
  assert.equal(readable(1.5e-7, 'kg m2'), '1.500e-7 kg m²');
  assert.equal(shownUnit('kg m2/ohm'), 'kg m²/Ω');
  assert.equal(tickText(-0.5), '−0.5');
  assert.equal(digits(123456), '1.235e5');
});

test('the command and the Python program name the vehicle or its file, and every change', () => {
  const own = elsewhere.shellCommand(full(), true);
  assert.match(own, /^wingbeat run mine\.toml /);
  assert.match(own, /--set "supply\.voltage=2\.75 V"/);
  assert.match(own, /--condition vacuum/);
  assert.match(own, /--frequency "22\.5 Hz"/);
  assert.match(elsewhere.shellCommand(state.stateFor(design()), false), /^wingbeat run one$/);
  assert.match(elsewhere.pythonProgram(full(), true), /wb\.read\("mine\.toml"\)\.replace/);
});

// ---- make it hover

/** Lift and power as powers of two keys. */
const powerLaw = (a, b, c, d) => (values) => {
  const [x, y] = values;
  return {
    values,
    lift: x ** a * y ** b,
    power: x ** c * y ** d,
    liftSlopes: [a * x ** a * y ** b, b * x ** a * y ** b],
    powerSlopes: [c * x ** c * y ** d, d * x ** c * y ** d],
    inside: true,
  };
};

test('make it hover: the design of least power at the target, from either side of it', () => {
  // Along the target x = 2 / y^2, so that the power is 4 / y: least where x is at its lower limit.
  const evaluate = powerLaw(1, 2, 2, 3);
  for (const start of [
    [0.5, 0.6],
    [3, 3],
  ]) {
    const {path, hovers} = hover.makeHover(evaluate(start), {lower: [0.2, 0.2], upper: [4, 4], target: 2}, evaluate);
    const [x, y] = path.at(-1).values;
    assert.ok(hovers);
    assert.ok(Math.abs(x / 0.2 - 1) < 1e-3 && Math.abs(y / Math.sqrt(10) - 1) < 1e-3, `${x} ${y}`);
  }
});

test('make it hover: out of reach is said, limits are kept, no failing design is taken', () => {
  const evaluate = powerLaw(1, 1, 1, 2);
  const limits = {lower: [0.5, 0.5], upper: [2, 2], target: 100};
  const {path, hovers} = hover.makeHover(evaluate([1, 1]), limits, evaluate);
  assert.ok(!hovers);
  assert.ok(path.at(-1).lift > 3.99 && path.at(-1).lift < 4.0001);
  const fails = (values) => (values[0] > 1.3 ? null : {...evaluate(values), inside: values[1] < 1.4});
  const {path: kept} = hover.makeHover(fails([1, 1]), limits, fails);
  for (const {values, inside} of kept) assert.ok(inside && values[0] <= 1.3);
  assert.ok(kept.at(-1).lift > 1.25 * 1.3, String(kept.at(-1).lift));
});

// ---- measured cycles

const cycle = () => {
  const rows = 361,
    share = Array.from({length: rows}, (_, n) => n / (rows - 1));
  return {
    time_s: Float64Array.from(share, (s) => 0.05 * s),
    crank_angle_rad: Float64Array.from(share, (s) => 2 * Math.PI * s + 0.2 * Math.sin(2 * Math.PI * s)),
    current_a: Float64Array.from(
      share,
      (s) => 0.1 + 0.05 * Math.sin(2 * Math.PI * s) + 0.02 * Math.cos(4 * Math.PI * s),
    ),
  };
};
const known = ['time_s', 'crank_angle_rad', 'current_a', 'lift_n'];

test('a measured cycle is found again, whatever its beginning, and its deviation measured', () => {
  const model = cycle(),
    next = sequence(3);
  for (const [separator, comma] of [
    [',', '.'],
    [';', ','],
    ['\t', '.'],
  ]) {
    const lines = [['time_s', 'current_a', 'humidity'].join(separator)];
    for (let n = 0; n < 120; ++n) {
      const t = 0.0137 + 0.0007 * n;
      const s = ((t / 0.05 + 0.31) % 1) * 360;
      const y =
        model.current_a[Math.floor(s)] +
        (s % 1) * (model.current_a[Math.floor(s) + 1] - model.current_a[Math.floor(s)]);
      lines.push([t, y + 0.004 * (n % 2 ? 1 : -1), next()].map((x) => String(x).replace('.', comma)).join(separator));
    }
    const read = measured.readMeasured('bench.csv', `# of today\n${lines.join('\r\n')}\n`, known);
    assert.deepEqual(read.ignored, ['humidity']);
    const {shift, deviations} = measured.match(read, model);
    const wrapped = ((((shift / 0.05 - 0.31 + 0.5) % 1) + 1) % 1) - 0.5;
    assert.ok(Math.abs(wrapped) < 0.004, String(shift));
    assert.ok(Math.abs(deviations.current_a / 0.004 - 1) < 0.02, String(deviations.current_a));
  }
});

test('over crank angles nothing is shifted', () => {
  const model = cycle();
  const rows = Array.from(
    {length: 30},
    (_, n) => `${model.crank_angle_rad[n * 12] + 4 * Math.PI},${model.current_a[n * 12] + 0.01}`,
  );
  const read = measured.readMeasured('a.csv', `crank_angle_rad,current_a\n${rows.join('\n')}`, known);
  const {shift, deviations} = measured.match(read, model);
  assert.equal(shift, null);
  assert.ok(Math.abs(deviations.current_a / 0.01 - 1) < 1e-6);
});

test('a table that is no measured cycle is refused with what is missing', () => {
  const read = (text) => () => measured.readMeasured('a.csv', text, known);
  assert.throws(read('a,b\n1,2\n3,4\n'), /column time_s or crank_angle_rad is missing; the first line has a, b/);
  assert.throws(read('time_s,b\n1,2\n3,4\n'), /no column of a waveform file/);
  assert.throws(read('time_s,current_a\n1,2\n'), /at least two rows/);
  assert.throws(read(''), /missing/);
});

test('lines of a curve pass closely by all of its points, and keep ends and kinks', () => {
  const next = sequence(7);
  const curves = [
    (t) => 60 * Math.sin(7 * t) + 20 * Math.cos(23 * t),
    (t) => Math.abs(40 * Math.sin(5 * t)), // kinks
    (t) => (t > 0.4 ? 50 : -50), // a jump
    () => 12.5, // no change
    () => 100 * next(), // no two alike
  ];
  for (const curve of curves) {
    const x = Float64Array.from({length: 361}, (_, n) => 52 + n),
      y = x.map((at) => 75 + curve((at - 52) / 360));
    const path = axes.linesOf(x, y);
    const ends = path
      .slice(1)
      .split('L')
      .map((p) => p.split(',').map(Number));
    assert.deepEqual(ends[0], [x[0], Math.round(100 * y[0]) / 100]);
    assert.deepEqual(ends.at(-1), [x[360], Math.round(100 * y[360]) / 100]);
    let line = 0;
    x.forEach((at, n) => {
      while (line < ends.length - 2 && at > ends[line + 1][0]) ++line;
      const [[x0, y0], [x1, y1]] = [ends[line], ends[line + 1]];
      const there = y0 + ((at - x0) / (x1 - x0)) * (y1 - y0);
      assert.ok(Math.abs(there - y[n]) < 0.11, `${there} for ${y[n]} at ${at}`);
    });
    if (curve === curves[3]) assert.equal(ends.length, 2);
    if (curve === curves[0]) assert.ok(ends.length < 200, `${ends.length} points`);
  }
});
