// Numbers with units for reading: SI prefixes where a unit takes them, degrees for radians. Display alone.
const prefixed = new Set(['m', 's', 'V', 'A', 'Hz', 'W', 'N', 'N m', 'ohm', 'H', 'N m/A', 'N m/rad', 'C']);
const prefixes: [number, string][] = [
  [1e6, 'M'],
  [1e3, 'k'],
  [1, ''],
  [1e-3, 'm'],
  [1e-6, 'µ'],
  [1e-9, 'n'],
];

export interface Scale {
  factor: number;
  unit: string;
}

/** What a number of that size in an SI unit is multiplied by for reading, and the unit it then has. */
export function scaleFor(size: number, unit: string): Scale {
  if (unit === 'rad') return {factor: 180 / Math.PI, unit: '°'};
  if (unit === 'degree') return {factor: 1, unit: '°'};
  if (unit === 'degC') return {factor: 1, unit: '°C'};
  if (unit === '1' || unit === '') return {factor: 1, unit: ''};
  if (!prefixed.has(unit) || !(Math.abs(size) > 0)) return {factor: 1, unit};
  const [value, prefix] = prefixes.find(([p]) => Math.abs(size) >= p * 0.99995) ?? prefixes[prefixes.length - 1]!;
  return {factor: 1 / value, unit: prefix + unit};
}

export function digits(x: number, figures = 4): string {
  if (!Number.isFinite(x)) return '–';
  if (x === 0) return '0';
  const size = Math.abs(x);
  if (size >= 1e5 || size < 1e-3) return x.toExponential(figures - 1).replace('e+', 'e');
  return Number(x.toPrecision(figures)).toString();
}

/** A number beside an axis. */
export function tickText(x: number): string {
  const short = Number(x.toPrecision(6));
  const size = Math.abs(short);
  return withMinus(size > 0 && (size >= 1e5 || size < 1e-3) ? short.toExponential() : String(short));
}

/** With a minus sign in place of a leading hyphen, for numbers that are not typed. */
export const withMinus = (text: string) => text.replace(/^-/, '\u2212');

export function readable(x: number | null | undefined, unit: string, figures = 4): string {
  if (x === null || x === undefined || !Number.isFinite(x)) return '–';
  const scale = scaleFor(x, unit);
  return `${digits(x * scale.factor, figures)}${scale.unit === '°' || !scale.unit ? '' : ' '}${shownUnit(scale.unit)}`;
}

/** kg m2 as kg m². */
export function shownUnit(unit: string): string {
  return unit
    .replace(/([a-zA-Z])(\d)/g, (_, letter: string, digit) => letter + '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(digit)])
    .replace('ohm', 'Ω');
}

/** The number as text that the library reads back to the same double. */
export const exact = (x: number) => String(x);
