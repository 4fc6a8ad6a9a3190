// Joints of the mechanism moved by hand: crank pin, hinge and wing tip, by pointer, finger or arrow keys. A drag is one
// step of the history; while it lasts the picture keeps its scale.
import {Refused} from './core';
import {byId, html} from './dom';
import type {Explorer} from './explorer';
import {type Grip, gripsOf, valueAt} from './pictures/grips';
import {type Drawn, height, type Instant, jointsOf, placeIn, type Point, pointOf, width} from './pictures/mechanism';
import {exact, readable} from './quantities';
import type {State} from './state';

const origin = 'drag';

interface Drag {
  grip: Grip;
  /** The picture at the beginning, from which every move counts. */
  drawn: Drawn;
  at: (joint: string) => Point;
  from: State;
  values: Explorer['values'];
  begun: Point;
  taken: string | null;
  played: boolean;
}

export class Touch {
  private readonly buttons = new Map<string, HTMLElement>();
  private drag: Drag | null = null;
  private drawn: Drawn | null = null;
  private instant: Instant | null = null;

  constructor(
    private readonly explorer: Explorer,
    private readonly picture: SVGSVGElement,
    private readonly play: {playing: () => boolean; set: (on: boolean) => void},
  ) {
    const note = byId('drag-note');
    explorer.fields.set(origin, {
      complain: (text) => (note.textContent = text),
      accept: () => (note.textContent = ''),
    });
  }

  /** The room of the picture while a joint is held. */
  get room() {
    return this.drag?.drawn.room ?? null;
  }

  /** The grips lie on the joints as they are drawn. */
  show(drawn: Drawn, instant: Instant) {
    this.drawn = drawn;
    this.instant = instant;
    const {shown, core} = this.explorer;
    const grips = shown ? gripsOf(drawn.mechanism, shown.values, core.tables.keys) : [];
    const at = jointsOf(drawn, instant);
    for (const [joint, button] of this.buttons) if (!grips.some((g) => g.joint === joint)) button.hidden = true;
    for (const grip of grips) {
      const button = this.buttonOf(grip.joint);
      const [x, y] = placeIn(drawn.room, at(grip.joint));
      button.hidden = false;
      button.style.left = `${((100 * x) / width).toFixed(2)}%`;
      button.style.top = `${((100 * y) / height).toFixed(2)}%`;
      this.describe(button, grip);
    }
  }

  private describe(button: HTMLElement, grip: Grip) {
    const value = Number(this.explorer.shown?.values[grip.key] ?? 1);
    const unit = this.explorer.core.tables.keys.find((k) => k.key === grip.key)?.unit ?? '1';
    const text = readable(value, unit, 4);
    if (button.dataset.grip === grip.key && button.getAttribute('aria-valuetext') === text) return;
    button.dataset.grip = grip.key;
    button.title = `${grip.name}: ${grip.key} ${text}. Drag, or use the arrow keys.`;
    button.setAttribute('aria-label', `${grip.name}, ${grip.key}`);
    button.setAttribute('aria-valuenow', String(value));
    button.setAttribute('aria-valuetext', text);
  }

  private buttonOf(joint: string): HTMLElement {
    const known = this.buttons.get(joint);
    if (known) return known;
    const button = html('div', {class: 'grip', role: 'slider', tabindex: 0, 'data-joint': joint});
    const current = () => this.gripOf(joint);
    button.addEventListener('pointerdown', (event) => {
      const grip = current();
      if (!grip || event.button !== 0 || this.drag) return;
      event.preventDefault();
      button.focus();
      button.setPointerCapture(event.pointerId);
      this.begin(grip, this.pointAt(event));
    });
    button.addEventListener('pointermove', (event) => {
      if (button.hasPointerCapture(event.pointerId)) this.move(this.pointAt(event));
    });
    button.addEventListener('pointerup', () => this.end(true));
    button.addEventListener('pointercancel', () => this.end(false));
    button.addEventListener('keydown', (event) => {
      if (event.key === 'Escape' && this.drag) return this.end(false);
      const share = shares[event.key],
        grip = current();
      if (share === undefined || !grip || this.drag) return;
      event.preventDefault();
      const value = Number(this.explorer.values[grip.key] ?? 1);
      void this.explorer.change({[grip.key]: exact(Number((value * share).toPrecision(5)))}, {origin: grip.key});
    });
    this.buttons.set(joint, button);
    this.picture.parentElement!.append(button);
    return button;
  }

  private gripOf(joint: string): Grip | undefined {
    const {shown, core} = this.explorer;
    return shown ? gripsOf(shown.mechanism, shown.values, core.tables.keys).find((g) => g.joint === joint) : undefined;
  }

  private pointAt(event: PointerEvent): Point {
    const box = this.picture.getBoundingClientRect();
    const room = this.drag?.drawn.room ?? this.drawn!.room;
    return pointOf(room, [
      ((event.clientX - box.left) * width) / box.width,
      ((event.clientY - box.top) * height) / box.height,
    ]);
  }

  private begin(grip: Grip, begun: Point) {
    const {explorer} = this;
    if (!this.drawn || !this.instant || !explorer.shown) return;
    const played = this.play.playing();
    this.play.set(false);
    this.drag = {
      grip,
      drawn: this.drawn,
      at: jointsOf(this.drawn, this.instant),
      from: explorer.state,
      values: explorer.shown.values,
      begun,
      taken: null,
      played,
    };
    document.body.dataset.dragging = grip.joint;
  }

  private move(p: Point) {
    const {drag, explorer} = this;
    if (!drag) return;
    const joint = drag.at(drag.grip.joint);
    const moved: Point = [joint[0] + p[0] - drag.begun[0], joint[1] + p[1] - drag.begun[1]];
    const value = valueAt(drag.grip, drag.values, drag.at, moved);
    if (value === null || exact(value) === drag.taken) return;
    const {key} = drag.grip,
      text = exact(value),
      design = explorer.changed(drag.from.design, {[key]: text});
    try {
      explorer.core.values(design);
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      return explorer.refuse(error, origin); // the joint stays where it can be
    }
    drag.taken = text;
    explorer.controls.accept(key);
    void explorer.go({...drag.from, design}, {final: false, origin});
  }

  /** The last place that could be taken becomes a step; what is broken off leaves none. */
  private end(keep: boolean) {
    const {drag, explorer} = this;
    if (!drag) return;
    this.drag = null;
    delete document.body.dataset.dragging;
    explorer.fields.get(origin)?.accept();
    if (drag.taken !== null) {
      if (keep) {
        const design = explorer.changed(drag.from.design, {[drag.grip.key]: drag.taken});
        void explorer.go({...drag.from, design}, {origin, apart: true});
      } else {
        void explorer.go(drag.from, {final: false});
      }
    }
    if (drag.played) this.play.set(true);
  }
}

const shares: Record<string, number> = {
  ArrowRight: 1.01,
  ArrowUp: 1.01,
  ArrowLeft: 1 / 1.01,
  ArrowDown: 1 / 1.01,
  PageUp: 1.1,
  PageDown: 1 / 1.1,
};
