// The pictures in 3D, by three.js. Of what is to be shown the latest is drawn, once a frame.
import {WebGLRenderer} from 'three';
import type {FlightBegun} from './answers';
import {FlightScene, type Look, type Pose} from './flight_scene';
import {type FreeColours, type FreeLook, FreeScene} from './free_scene';
import type {Size} from './stage';

/** `id`: of the picture, which counts up from 1. */
export type Order = {id: number} & (
  | {kind: 'flight'; look: Look}
  | {kind: 'free'; begun: FlightBegun; colours: FreeColours}
  | {kind: 'show'; shown: Pose | FreeLook}
  | {kind: 'extend'; places: readonly number[][]}
  | {kind: 'resize'; size: Size}
  | {kind: 'dispose'}
);
type Scene = FlightScene | FreeScene;

let renderer: WebGLRenderer | null = null,
  scene: Scene | null = null,
  present = 0, // picture
  waiting: Pose | FreeLook | null = null;

function replace(make: ((renderer: WebGLRenderer) => Scene) | null) {
  scene?.dispose();
  waiting = null;
  scene = make && renderer ? make(renderer) : null;
}

function draw() {
  const shown = waiting;
  waiting = null;
  if (shown) scene?.show(shown as Pose & FreeLook); // a picture sends what its scene shows
}

function obey(order: Order) {
  if (order.kind === 'flight' || order.kind === 'free') {
    present = order.id;
    return replace((on) =>
      order.kind === 'flight' ? new FlightScene(on, order.look) : new FreeScene(on, order.begun, order.colours),
    );
  }
  if (order.id !== present) return;
  switch (order.kind) {
    case 'show':
      if (!waiting) requestAnimationFrame(draw);
      waiting = order.shown;
      return;
    case 'extend':
      if (scene instanceof FreeScene) scene.extend(order.places);
      return;
    case 'resize':
      return scene?.resize(order.size);
    case 'dispose':
      return replace(null);
  }
}

/** Answers the canvas with an empty text, or with why there will be no pictures. */
self.onmessage = ({data}: MessageEvent<Order | {canvas: OffscreenCanvas}>) => {
  if (!('canvas' in data)) return obey(data);
  try {
    renderer = new WebGLRenderer({canvas: data.canvas, antialias: true});
    self.postMessage('');
  } catch (error) {
    self.postMessage(error instanceof Error ? error.message : String(error));
  }
};
