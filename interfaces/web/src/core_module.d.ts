declare module '#core/wingbeat-core.mjs' {
  const create: (options: object) => Promise<unknown>;
  export default create;
}
declare module '#core/wingbeat-core.wasm?url' {
  const url: string;
  export default url;
}
