// The vehicles and the motor catalogue that come with the program.
const files = import.meta.glob<string>('#data/designs/*.toml', {query: '?raw', import: 'default', eager: true});
import type {Design} from './state';
import motorCatalogue from '#data/motors/motors.csv?raw';

const nameOf = (path: string) => path.slice(path.lastIndexOf('/') + 1).replace('.toml', '');

/** Texts of data/designs by name. */
export const shipped: Readonly<Record<string, string>> = Object.fromEntries(
  Object.entries(files).map(([path, text]) => [nameOf(path), text]),
);
export {motorCatalogue};

export const isShipped = (name: string) => Object.hasOwn(shipped, name);
export const shippedDesign = (name: string): Design => ({name, text: shipped[name] ?? '', changes: {}});

const storage = 'wingbeat-files';

/** The user's own files of this tab by name; they outlast a reload. */
export class OwnFiles {
  private readonly files = new Map<string, string>();

  constructor() {
    try {
      const kept: unknown = JSON.parse(sessionStorage.getItem(storage) ?? '[]');
      for (const [name, text] of kept as [string, string][]) this.files.set(name, text);
    } catch {
      // Without storage, or with something else in it, there are no files yet.
    }
  }

  get names() {
    return [...this.files.keys()];
  }

  /** The design of a file; a name that a vehicle of the page has is left to that vehicle. */
  add(name: string, text: string): Design {
    const own = isShipped(name) && shipped[name] !== text ? `${name}-own` : name;
    if (shipped[own] !== text) this.files.set(own, text);
    try {
      sessionStorage.setItem(storage, JSON.stringify([...this.files]));
    } catch {
      // They stay until the page is left.
    }
    return {name: own, text, changes: {}};
  }

  design(name: string): Design | null {
    const text = this.files.get(name);
    return text === undefined ? null : {name, text, changes: {}};
  }
}
