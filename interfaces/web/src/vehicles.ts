// The vehicles and the motor catalogue that come with the program.
const files = import.meta.glob('#data/designs/*.toml', {query: '?raw', import: 'default', eager: true}) as Record<
  string,
  string
>;
import motorCatalogue from '#data/motors/motors.csv?raw';

const nameOf = (path: string) => path.slice(path.lastIndexOf('/') + 1).replace('.toml', '');

/** Texts of data/designs by name. */
export const shipped: Record<string, string> = Object.fromEntries(
  Object.entries(files).map(([path, text]) => [nameOf(path), text]),
);
export {motorCatalogue};
