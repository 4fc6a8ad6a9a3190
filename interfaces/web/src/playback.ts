// Time in slow motion: which share of the cycle is shown.
/** [ms] without a picture that look like no motion. */
const longestWait = 80;

export class Playback {
  share = 0;
  playing = true;
  slowdown = 100;
  private last = 0;
  private drawn = 0;

  /**
   * `period` [s] of what is shown; `draw` is called once a frame while it moves, less often while `awaited` says that
   * a picture is on its way that will be drawn at the present share.
   */
  constructor(
    private readonly period: () => number,
    private readonly draw: (share: number) => void,
    private readonly repeats: () => boolean,
    private readonly awaited: () => boolean = () => false,
  ) {
    this.playing = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    requestAnimationFrame((now) => this.frame(now));
  }

  show(share: number) {
    this.share = share;
    this.drawn = performance.now();
    this.draw(share);
  }

  private frame(now: number) {
    const elapsed = Math.min(0.1, (now - this.last) / 1000);
    this.last = now;
    const period = this.period();
    if (this.playing && period > 0 && !document.hidden) {
      const next = this.share + elapsed / (this.slowdown * period);
      const share = this.repeats() ? next % 1 : Math.min(1, next);
      const waits = this.awaited() && now - this.drawn < longestWait;
      if (waits) this.share = share;
      else if (share !== this.share) this.show(share);
    }
    requestAnimationFrame((time) => this.frame(time));
  }
}
