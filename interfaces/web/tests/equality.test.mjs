// The page's numbers are the program's: random designs, quantities in many spellings, the sentences of what is refused.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {launch, open, serve} from './browser.mjs';
import {designs} from './designs.mjs';
import {answer} from './program.mjs';

let server, browser, page, problems;
before(async () => {
  server = await serve();
  browser = await launch();
  ({page, problems} = await open(browser, server.url));
});
after(async () => {
  await browser.close();
  server.close();
});

/** With `scripts/test-explorer --all` 500. */
const count = process.env.WINGBEAT_ALL ? 500 : 150;

const inPage = (list) =>
  page.evaluate(
    (all) =>
      all.map(({vehicle, changes, condition}) => {
        const {core} = window.explorer,
          {shipped} = window;
        try {
          const stated = {text: shipped[vehicle], changes};
          const {report} = core.solve(stated, {condition, endurance: true});
          return {report, resistance: core.values(stated)['motor.armature_resistance']};
        } catch (error) {
          if (!error.problems) throw error;
          return {refused: error.problems.map((p) => p.message)};
        }
      }),
    list,
  );

async function inProgram(list) {
  const answers = new Array(list.length);
  let next = 0;
  const worker = async () => {
    for (let n = next++; n < list.length; n = next++)
      answers[n] = await answer(list[n].vehicle, list[n].changes, list[n].condition);
  };
  await Promise.all([worker(), worker(), worker()]);
  return answers;
}

/** Asserts that both take the design or both refuse it; the design in words. */
function refusedByBothOrNone(design, ours, theirs) {
  const what = JSON.stringify(design);
  assert.equal('refused' in ours, 'refused' in theirs, `${what}: ${JSON.stringify(ours)} ${JSON.stringify(theirs)}`);
  return what;
}

/**
 * What the rounding of a metric is relative to where it is the difference of far larger numbers: current and powers of
 * the motor blocked at this voltage, for they follow from voltage less induced voltage; 1 for a Floquet multiplier.
 */
function scaleOf(key, report, resistance) {
  const current = Math.abs(report.voltage_v) / resistance,
    power = current * Math.abs(report.voltage_v);
  if (/^current_/.test(key)) return current;
  if (/^power_/.test(key)) return power;
  if (/^efficiency_/.test(key)) return power / Math.abs(report.power_electrical_w);
  return key === 'floquet_multiplier_max' ? 1 : 0;
}

/**
 * Times that a search along a flight ends, and to what: a thousandth of the tolerance of its orbits, 1e-6, on either
 * side (Flight in src/study/endurance.cpp).
 */
const searched = ['hover_s', 'endurance_s'],
  resolution = 2e-9;

/**
 * The largest relative difference of the numbers, after asserting that all else is equal; of those `which` takes.
 */
function compare({report: ours, resistance}, {report: theirs}, what, which = () => true) {
  assert.deepEqual(Object.keys(ours), Object.keys(theirs), what);
  const idle = Math.abs(theirs.power_electrical_w) < 1e-12 * scaleOf('power_', theirs, resistance);
  let largest = 0;
  for (const [key, value] of Object.entries(theirs)) {
    // Sentences hold rounded numbers. Where the input power is rounding, so is the efficiency that the domain assesses.
    if (['status_detail', 'domain_detail', 'warnings'].includes(key) || (key === 'domain' && idle)) continue;
    if (typeof value !== 'number' || typeof ours[key] !== 'number') {
      assert.deepEqual(ours[key], value, `${what}: ${key}`);
      continue;
    }
    if (!which(key)) continue;
    const size = Math.max(Math.abs(value), scaleOf(key, theirs, resistance));
    if (size > 0) largest = Math.max(largest, Math.abs(ours[key] - value) / size);
  }
  return largest;
}

test('random designs: statuses are equal, metrics to 1e-12', async () => {
  const values = await page.evaluate(() => {
    const {core} = window.explorer,
      {shipped} = window;
    return Object.fromEntries(Object.entries(shipped).map(([name, text]) => [name, core.values({text, changes: {}})]));
  });
  const list = designs(count, values);
  const [ours, theirs] = [await inPage(list), await inProgram(list)];
  const statuses = {},
    far = [];
  let near = 0,
    largest = 0,
    flights = 0;
  list.forEach((design, n) => {
    const what = refusedByBothOrNone(design, ours[n], theirs[n]);
    const status = theirs[n].report ? theirs[n].report.status : 'refused';
    statuses[status] = (statuses[status] ?? 0) + 1;
    if (!theirs[n].report) return;
    const flight = compare(ours[n], theirs[n], what, (key) => searched.includes(key));
    flights = Math.max(flights, flight);
    const difference = compare(ours[n], theirs[n], what, (key) => !searched.includes(key));
    largest = Math.max(largest, difference);
    if (difference <= 1e-12 && flight <= resolution) ++near;
    else far.push(`${difference.toExponential(1)} ${what}`);
  });
  console.log(
    `${count} designs: ${JSON.stringify(statuses)}; ${near} equal to 1e-12, the others to ${largest.toExponential(1)}; ` +
      `times of flight to ${flights.toExponential(1)}`,
  );
  assert.ok(statuses.locked > 0 && statuses.stalled > 0, 'designs that do not flap are among them');
  // An orbit that is searched for from where the motion in time has come to depends on who integrated that, within the
  // tolerance of the search, 1e-6.
  assert.ok(far.length <= 0.01 * count && Math.max(largest, flights) < 1e-8, far.join('\n'));
});

test('quantities in many spellings', async () => {
  const spelled = [
    ['supply.voltage', ['3000 mV', '2.9 V', '0.003 kV', '3e6 µV', '3 volt', '3 W/A']],
    ['transmission.crank_radius', ['5 mm', '0.2 inch', '0.5 cm', '5000 um', '5e-3 m', '0.005 meters', '0.02 ft']],
    ['motor.inertia', ['1.5 gcm2', '1.5e-7 kg m2', '1.5e-7 kg·m²', '1.5e-7 kg*m^2', '1.5e-7 N m s2', '150 g mm2']],
    ['motor.torque_constant', ['10 mNm/A', '0.01 V s', '955 rpm/V', '0.01 N.m.A-1', '0.01 N m per A', '1 Ncm/A']],
    [
      'motor.viscous_damping',
      ['3.6e-6 N m s/rad', '3.6 uNm s', '3.6e-6 N*m*s', '6.3e-8 N m/(deg/s)', '3.8e-7 mNm/rpm'],
    ],
    ['motor.temperature', ['25 degC', '300 K', '77 degF', '25 celsius']],
  ];
  const list = spelled.flatMap(([key, texts]) =>
    texts.map((text) => ({vehicle: 'friction2022', changes: {[key]: text}, condition: 'air'})),
  );
  const [ours, theirs] = [await inPage(list), await inProgram(list)];
  list.forEach((design, n) => {
    const what = refusedByBothOrNone(design, ours[n], theirs[n]);
    if (theirs[n].report) assert.ok(compare(ours[n], theirs[n], what) <= 1e-12, what);
  });
});

test('what is refused is refused in the same words', async () => {
  const bad = [
    {'motor.inertia': '-1'},
    {'motor.inertia': '5 mm'},
    {'motor.torque_constan': '1'},
    {'friction.radius': '1 parsnip'},
    {'friction.type': 'sticky'},
    {'supply.voltage': '3,5 V'},
    {'wing.count': '1.5'},
    {'supply.voltage': '5 2 V'},
    {'transmission.crank_radius': '1 m', 'motor.inertia': '0'},
    {'motor.armature_resistance': '20 degC'},
  ];
  const list = bad.map((changes) => ({vehicle: 'friction2022', changes, condition: 'air'}));
  const [ours, theirs] = [await inPage(list), await inProgram(list)];
  list.forEach((design, n) => {
    assert.ok(theirs[n].refused, JSON.stringify(design));
    for (const sentence of ours[n].refused ?? ['(accepted)']) {
      // The program names the option as the place: "--set motor.inertia=-1: motor.inertia: must be ...".
      assert.ok(
        theirs[n].refused.includes(sentence),
        `${JSON.stringify(design)}\n  page: ${sentence}\n  program: ${theirs[n].refused}`,
      );
    }
  });
  assert.deepEqual(problems, []);
});
