declare module '#core/wingbeat-core.mjs' {
  const create: (options: object) => Promise<unknown>;
  export default create;
}
declare module '#core/wingbeat-flight.mjs' {
  const create: (options: object) => Promise<unknown>;
  export default create;
}
declare module '#packed/*?url' {
  const url: string;
  export default url;
}
