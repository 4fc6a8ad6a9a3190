// Designs on the way to hovering: lift over weight and electrical power.
import {scaleLinear} from 'd3-scale';
import {svg} from '../dom';
import type {Tried} from '../hover';
import {scaleFor} from '../quantities';
import {cleared, extent, type Frame, numbersBelow, numbersBeside} from './axes';

const frame: Frame = {width: 560, height: 280, left: 60, right: 14, top: 46, bottom: 40};

export function drawPath(picture: SVGSVGElement, title: string, path: Tried[], target: number) {
  const {width, height, left, right, top, bottom} = frame;
  cleared(picture, frame);
  const lifts = extent(
      path.map((t) => t.lift),
      [target],
    )!,
    powers = extent(path.map((t) => t.power))!;
  const scale = scaleFor(powers[1], 'W');
  const x = scaleLinear(lifts, [left, width - right]).nice(5),
    y = scaleLinear([0, powers[1] * scale.factor], [height - bottom, top]).nice(4);
  numbersBeside(picture, frame, y, 4, true);
  numbersBelow(picture, frame, x, x.ticks(6));
  const place = (t: Tried): [number, number] => [x(t.lift), y(t.power * scale.factor)];
  picture.append(
    svg('text', {x: 4, y: 14}, title),
    svg('text', {x: left, y: 34, class: 'title'}, `electrical power, ${scale.unit}`),
    svg('text', {x: width - right, y: height - 6, 'text-anchor': 'end'}, 'lift over weight'),
    svg('line', {class: 'cursor', x1: x(target), x2: x(target), y1: top, y2: height - bottom}),
    svg('path', {
      class: 'curve series-0',
      d: `M${path
        .map((t) =>
          place(t)
            .map((v) => v.toFixed(1))
            .join(),
        )
        .join('L')}`,
    }),
    ...path.map((t, n) => {
      const [cx, cy] = place(t);
      const kind = n === path.length - 1 ? 'best' : 'dot';
      return svg('circle', {class: t.inside ? kind : `${kind} outside`, cx, cy, r: n === path.length - 1 ? 6 : 3.5});
    }),
  );
}
