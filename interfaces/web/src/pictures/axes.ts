// What the pictures with two axes share.
import type {ScaleLinear} from 'd3-scale';
import {svg} from '../dom';
import {tickText} from '../quantities';

/** Size of a picture and the margins around what it shows, in its own units. */
export interface Frame {
  width: number;
  height: number;
  left: number;
  right: number;
  top: number;
  bottom: number;
}
type Axis = ScaleLinear<number, number>;

/** The least and the largest of the finite numbers, null where there are none. */
export function extent(...columns: Iterable<number>[]): [number, number] | null {
  let low = Infinity,
    high = -Infinity;
  for (const column of columns)
    for (const x of column) {
      if (!Number.isFinite(x)) continue;
      low = Math.min(low, x);
      high = Math.max(high, x);
    }
  return low <= high ? [low, high] : null;
}

/** An empty picture of the frame's size. */
export function cleared(picture: SVGSVGElement, {width, height}: Frame) {
  picture.setAttribute('viewBox', `0 0 ${width} ${height}`);
  picture.replaceChildren();
}

export function sayNothing(parent: SVGElement, {width, height}: Frame, text: string) {
  parent.append(svg('text', {x: width / 2, y: height / 2, class: 'nothing', 'text-anchor': 'middle'}, text));
}

/** Numbers left of the frame, each with a line across it where `grid` is asked for. */
export function numbersBeside(parent: SVGElement, frame: Frame, y: Axis, count: number, grid: boolean) {
  for (const tick of y.ticks(count)) {
    const at = y(tick);
    if (grid)
      parent.append(svg('line', {class: 'grid', x1: frame.left, x2: frame.width - frame.right, y1: at, y2: at}));
    parent.append(svg('text', {x: frame.left - 6, y: at + 4, 'text-anchor': 'end'}, tickText(tick)));
  }
}

/** Numbers `gap` below the frame. */
export function numbersBelow(parent: SVGElement, frame: Frame, x: Axis, ticks: number[], gap = 16) {
  const y = frame.height - frame.bottom + gap;
  for (const tick of ticks) parent.append(svg('text', {x: x(tick), y, 'text-anchor': 'middle'}, tickText(tick)));
}

/** Where a pointer is, in units of the picture. */
export function placeOf(event: MouseEvent, picture: SVGSVGElement, {width, height}: Frame) {
  const box = picture.getBoundingClientRect();
  return {
    x: ((event.clientX - box.left) / box.width) * width,
    y: ((event.clientY - box.top) / box.height) * height,
  };
}

/** What takes clicks inside the frame. */
export function clickable(picture: SVGSVGElement, frame: Frame, clicked: (place: {x: number; y: number}) => void) {
  const {width, height, left, right, top, bottom} = frame;
  const surface = svg('rect', {
    class: 'surface',
    x: left,
    y: top,
    width: width - left - right,
    height: height - top - bottom,
  });
  surface.addEventListener('click', (event) => clicked(placeOf(event, picture, frame)));
  picture.append(surface);
}

/** How far lines may pass by the points between their ends, in units of a picture. */
const close = 0.1;

/** Lines through points, x ascending, as a path: of those that a line passes closely by only the ends. */
export function linesOf(x: Float64Array, y: Float64Array): string {
  if (x.length === 0) return '';
  const point = (n: number) => `${Math.round(100 * x[n]!) / 100},${Math.round(100 * y[n]!) / 100}`;
  let path = `M${point(0)}`,
    start = 0, // of the present line
    least = -Infinity, // of its slope, so that it passes closely by all points so far
    largest = Infinity;
  /** Of a line from the start to a place `off` from point n. */
  const slope = (n: number, off = 0) => (y[n]! + off - y[start]!) / (x[n]! - x[start]!);
  for (let n = 1; n < x.length; ++n) {
    if (!(slope(n) >= least && slope(n) <= largest)) {
      path += `L${point(n - 1)}`;
      start = n - 1;
      least = -Infinity;
      largest = Infinity;
    }
    least = Math.max(least, slope(n, -close));
    largest = Math.min(largest, slope(n, close));
  }
  return start < x.length - 1 ? `${path}L${point(x.length - 1)}` : path;
}
