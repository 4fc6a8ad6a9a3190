// The beat of the wings to be heard: the cycle's lift as a tone whose fundamental is the flapping frequency itself.
import type {Columns} from './core';
import {byId} from './dom';
import type {Explorer, Shown} from './explorer';

const harmonics = 32,
  volume = 0.25,
  fade = 0.05; // [s]

/** Fourier coefficients of a column over one cycle, without its mean, the largest partial tone scaled to 1. */
export function partialsOf(numbers: Float64Array, count = harmonics): {real: Float32Array; imag: Float32Array} {
  const real = new Float32Array(count + 1),
    imag = new Float32Array(count + 1),
    rows = numbers.length - 1; // the last row is the first of the next cycle
  let largest = 0;
  for (let k = 1; k <= count; ++k) {
    let c = 0,
      s = 0;
    for (let row = 0; row < rows; ++row) {
      const angle = (2 * Math.PI * k * row) / rows;
      c += numbers[row]! * Math.cos(angle);
      s += numbers[row]! * Math.sin(angle);
    }
    real[k] = c;
    imag[k] = s;
    largest = Math.max(largest, Math.hypot(c, s));
  }
  if (largest > 0) for (let k = 1; k <= count; ++k) [real[k], imag[k]] = [real[k]! / largest, imag[k]! / largest];
  return {real, imag};
}

const tone = ({lift_n, aero_moment_nm}: Columns) =>
  [lift_n, aero_moment_nm].find((c) => c && Number.isFinite(c[0]) && c.some((x) => x !== 0)) ?? null;

export class Sound {
  private context: AudioContext | null = null;
  private oscillator: OscillatorNode | null = null;
  private gain: GainNode | null = null;
  private shown: Shown | null = null;

  constructor(private readonly explorer: Explorer) {
    const button = byId('sound');
    button.addEventListener('click', () => void this.turn(button.getAttribute('aria-pressed') !== 'true'));
    explorer.watch(() => this.follow());
  }

  private async turn(on: boolean) {
    byId('sound').setAttribute('aria-pressed', String(on));
    if (!on) {
      this.gain?.gain.setTargetAtTime(0, this.context!.currentTime, fade);
      setTimeout(() => {
        if (byId('sound').getAttribute('aria-pressed') !== 'true') void this.context?.suspend();
      }, 400);
      return this.say(null);
    }
    if (!this.context) {
      await new Promise((done) => setTimeout(done)); // a browser takes up to 50 ms for its first context
      this.context = new AudioContext();
      this.gain = new GainNode(this.context, {gain: 0});
      this.oscillator = new OscillatorNode(this.context, {frequency: 1});
      this.oscillator.connect(this.gain).connect(this.context.destination);
      this.oscillator.start();
    }
    await this.context.resume();
    this.shown = null;
    this.follow();
  }

  private follow() {
    const {shown} = this.explorer;
    if (!shown || shown === this.shown || !this.context || byId('sound').getAttribute('aria-pressed') !== 'true')
      return;
    this.shown = shown;
    const {columns, report} = shown.solved;
    const column = columns.time_s ? tone(columns) : null,
      frequency = typeof report.frequency_hz === 'number' ? report.frequency_hz : 0;
    const now = this.context.currentTime;
    if (!column || !(frequency > 0)) {
      this.gain!.gain.setTargetAtTime(0, now, fade);
      return this.say(null);
    }
    const {real, imag} = partialsOf(column);
    this.oscillator!.setPeriodicWave(this.context.createPeriodicWave(real, imag));
    this.oscillator!.frequency.setTargetAtTime(frequency, now, fade);
    this.gain!.gain.setTargetAtTime(volume, now, fade);
    this.say(frequency);
  }

  private say(frequency: number | null) {
    const button = byId('sound');
    button.title = frequency ? `the lift of the cycle at ${frequency.toPrecision(3)} Hz` : '';
    if (frequency) document.body.dataset.sound = frequency.toPrecision(6);
    else delete document.body.dataset.sound;
  }
}
