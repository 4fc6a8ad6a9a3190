// Pictures in 3D, drawn in a worker, for a graphics driver can take long over the first of them. Loaded when they are
// asked for, as one file, so it imports nothing of the page.
import type {FlightBegun} from './answers';
import type {Look, Pose} from './flight_scene';
import type {FreeColours, FreeLook} from './free_scene';
import SceneWorker from './scene_worker?worker&inline';
import type {Order} from './scene_worker';

export {default as FlightWorker} from './flight_worker?worker&inline';

/** A picture in the worker. What is asked of one after another has taken its place has no effect. */
class Picture<Shown extends Pose | FreeLook> {
  constructor(
    protected readonly send: (order: Order) => void,
    protected readonly id: number,
  ) {}
  show(shown: Shown) {
    this.send({id: this.id, kind: 'show', shown});
  }
  resize(width: number, height: number) {
    this.send({id: this.id, kind: 'resize', size: {width, height, ratio: Math.min(2, devicePixelRatio)}});
  }
  dispose() {
    this.send({id: this.id, kind: 'dispose'});
  }
}
export type FlightPicture = Picture<Pose>;

export class FreePicture extends Picture<FreeLook> {
  /** Further points of the path [m]: north, east, height. */
  extend(places: readonly number[][]) {
    this.send({id: this.id, kind: 'extend', places});
  }
}

/** The pictures of a canvas, one at a time. */
export class Scenes {
  /** Rejected where the browser has no WebGL for a worker. */
  readonly ready: Promise<void>;
  private readonly worker: Worker = new SceneWorker();
  private made = 0;

  constructor(canvas: HTMLCanvasElement) {
    this.ready = new Promise((done, failed) => {
      this.worker.onmessage = ({data}: MessageEvent<string>) => (data ? failed(new Error(data)) : done());
      this.worker.onerror = (event) => failed(new Error(event.message));
    });
    const offscreen = canvas.transferControlToOffscreen();
    this.worker.postMessage({canvas: offscreen}, [offscreen]);
  }

  flight(look: Look): FlightPicture {
    this.send({id: ++this.made, kind: 'flight', look});
    return new Picture<Pose>(this.send, this.made);
  }
  free(begun: FlightBegun, colours: FreeColours): FreePicture {
    this.send({id: ++this.made, kind: 'free', begun, colours});
    return new FreePicture(this.send, this.made);
  }

  private readonly send = (order: Order) => this.worker.postMessage(order);
}
