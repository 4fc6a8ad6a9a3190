// Where the power goes: from the supply through motor and mechanism to the air, mean powers of a cycle.
import {sankey, sankeyLinkHorizontal} from 'd3-sankey';
import type {Balance} from '../core';
import {layerOf, set, svg, update} from '../dom';
import {digits, readable} from '../quantities';

interface Place {
  name: string;
  kind: string;
}
interface Flow {
  source: number;
  target: number;
  value: number;
  kind: string;
  /** What it has of the balance. */
  part: Part;
}
export type Part = keyof Balance | 'motor';
/** A flow as it is drawn. */
export interface DrawnFlow {
  part: Part;
  mean: number; // [W]
  width: number;
  d: string;
  kind: string;
}

const height = 270;

/** Stations and flows of a balance [W]. A flow below a thousandth of the input is left to the table; a residual that
 * brings power in enters at the mechanism. */
function network(b: Balance): {nodes: Place[]; links: Flow[]} {
  const nodes: Place[] = [],
    links: Flow[] = [];
  const least = 1e-3 * b.electrical;
  const add = (name: string, kind: string) => nodes.push({name, kind}) - 1;
  const flow = (source: number, target: number, value: number, kind: string, part: Part) =>
    links.push({source, target, value, kind, part});
  const supply = add('supply', 'input'),
    motor = add('motor', 'station');
  if (b.electronics > least) flow(supply, add('electronics', 'loss'), b.electronics, 'electronics', 'electronics');
  const taken = b.electrical - Math.max(b.electronics, 0);
  flow(supply, motor, taken, 'useful', 'electrical');
  if (b.copper > least) flow(motor, add('copper loss', 'loss'), b.copper, 'copper', 'copper');
  if (b.viscous > least) flow(motor, add('motor viscous loss', 'loss'), b.viscous, 'viscous', 'viscous');
  if (b.motor_friction > least)
    flow(motor, add('motor friction', 'loss'), b.motor_friction, 'friction', 'motor_friction');
  const onward = taken - Math.max(b.copper, 0) - Math.max(b.viscous, 0) - Math.max(b.motor_friction, 0);
  if (!(onward > least)) return {nodes, links};
  const mechanism = add('mechanism', 'station');
  flow(motor, mechanism, onward, 'useful', 'motor');
  if (b.gear > least) flow(mechanism, add('gear loss', 'loss'), b.gear, 'gear', 'gear');
  if (b.friction > least) flow(mechanism, add('friction', 'loss'), b.friction, 'friction', 'friction');
  if (b.hinge > least) flow(mechanism, add('pitch hinges', 'loss'), b.hinge, 'hinge', 'hinge');
  if (b.residual > least) flow(mechanism, add('formulation residual', 'loss'), b.residual, 'residual', 'residual');
  if (b.residual < -least) flow(add('formulation residual', 'input'), mechanism, -b.residual, 'residual', 'residual');
  if (b.aerodynamic > least) flow(mechanism, add('air', 'useful'), b.aerodynamic, 'aerodynamic', 'aerodynamic');
  return {nodes, links};
}

/** `room` is what the page has for the picture [px]: letters keep their size. Returns the flows. */
export function drawSankey(picture: SVGSVGElement, balance: Balance | null, room: number): DrawnFlow[] {
  const width = Math.max(330, Math.min(720, room || 640));
  set(picture, {viewBox: `0 0 ${width} ${height}`});
  const means = layerOf(picture, 'flows');
  if (!balance || !(balance.electrical > 0)) {
    const nothing = {x: width / 2, y: height / 2, 'text-anchor': 'middle', class: 'nothing'};
    update(means, [svg('text', nothing, 'no steady cycle')]);
    return [];
  }
  const parts: SVGElement[] = [];
  const layout = sankey<Place, Flow>()
    .nodeWidth(10)
    .nodePadding(22)
    .extent([
      [4, 22],
      [width - (width < 500 ? 196 : 290), height - 12],
    ]);
  const {nodes, links} = layout(network(balance));
  const flows = links.map(({part, value, width: thick, kind}, n) => {
    const d = sankeyLinkHorizontal()(links[n]!) ?? '';
    return {part, mean: value, width: Math.max(1, thick ?? 0), d, kind};
  });
  for (const {kind, d, width: thick, mean} of flows) {
    parts.push(
      svg('path', {class: `flow flow-${kind}`, d, 'stroke-width': thick}, svg('title', {}, `${readable(mean, 'W')}`)),
    );
  }
  for (const node of nodes) {
    const x0 = node.x0 ?? 0,
      x1 = node.x1 ?? 0,
      y0 = node.y0 ?? 0,
      y1 = node.y1 ?? 0;
    parts.push(
      svg('rect', {class: `node node-${node.kind}`, x: x0, y: y0, width: x1 - x0, height: Math.max(1, y1 - y0)}),
    );
    const share = `${digits((100 * (node.value ?? 0)) / balance.electrical, 3)} %`;
    const label = width < 500 ? `${node.name} ${share}` : `${node.name} ${readable(node.value, 'W')} (${share})`;
    const above = node.kind === 'station' || node.kind === 'input';
    parts.push(
      above
        ? svg('text', {...stationPlace(x0, x1, width), y: y0 - 6, class: 'halo'}, node.name)
        : svg('text', {x: x1 + 6, y: (y0 + y1) / 2 + 4}, label),
    );
  }
  update(means, parts);
  return flows;
}

/** In a narrow picture a station's name ends where it does, for those of the losses begin close by. */
const stationPlace = (x0: number, x1: number, width: number): Record<string, string | number> =>
  width < 500 && x0 > 70 ? {x: x1, 'text-anchor': 'end'} : {x: x0};

/** The balance as rows of a table: name, power [W], share of the input. */
export function balanceRows(b: Balance): [string, number, number][] {
  const rows: [string, number][] = [
    ['electrical input', b.electrical],
    ['electronics', b.electronics],
    ['copper loss', b.copper],
    ['motor viscous loss', b.viscous],
    ['motor friction', b.motor_friction],
    ['gear loss', b.gear],
    ['friction', b.friction],
    ['pitch hinges', b.hinge],
    ['aerodynamic', b.aerodynamic],
    ['formulation residual', b.residual],
    ['energy-balance error', b.imbalance],
  ];
  return rows
    .filter(([name, value]) => value !== 0 || name === 'energy-balance error')
    .map(([name, value]) => [name, value, value / b.electrical]);
}
