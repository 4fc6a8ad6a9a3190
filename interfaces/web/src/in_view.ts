// Parts of the page that are drawn when somebody can see them.

export class InView {
  private readonly outside = new Set<Element>();
  private readonly watched = new Set<Element>();
  private readonly late = new Map<Element, () => void>();
  private readonly observer = new IntersectionObserver((entries) => this.seen(entries));

  /** `waits` says that parts out of sight may be drawn later. */
  constructor(private readonly waits: () => boolean) {}

  /** True as well of an element of which nothing is known yet. */
  private has(element: Element): boolean {
    if (!this.watched.has(element)) {
      this.watched.add(element);
      this.observer.observe(element);
    }
    return !this.outside.has(element);
  }

  /** Draws what an element shows: at once, or, where that may wait, when the element comes into sight or at flush(). */
  draw(element: Element, draw: () => void) {
    if (this.has(element) || !this.waits()) {
      this.late.delete(element);
      draw();
    } else {
      this.late.set(element, draw);
    }
  }

  /** Shows what follows each instant and is a part of what draw() draws: now if in sight, else as what waits. */
  show(element: Element, show: () => void) {
    if (this.has(element)) show();
    else if (!this.late.has(element)) this.late.set(element, show);
  }

  /** Draws all that waits. */
  flush() {
    const late = [...this.late.values()];
    this.late.clear();
    for (const draw of late) draw();
  }

  private seen(entries: IntersectionObserverEntry[]) {
    for (const {target, isIntersecting} of entries) {
      if (!isIntersecting) {
        this.outside.add(target);
        continue;
      }
      this.outside.delete(target);
      const draw = this.late.get(target);
      this.late.delete(target);
      draw?.();
    }
  }
}
