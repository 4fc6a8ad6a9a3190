// The library of flights, compiled to WebAssembly, with types. All numbers are SI; earth axes are north, east and up.
import createFlight from '#core/wingbeat-flight.mjs';
import type {FlightBegun, FlightPiece} from './answers';
import {type Answer, type Columns, instance, list, resultOf, type Stated} from './library';

export interface Triple {
  north?: number;
  east?: number;
  up?: number;
}
export interface Push {
  u?: number;
  v?: number;
  w?: number;
  p?: number;
  q?: number;
  r?: number;
}
export interface Aim {
  north: number;
  east: number;
  height: number;
  yaw: number;
  /** [s] until it is reached; as far and fast as it takes unless given. */
  within?: number;
}
export interface FlightOptions {
  controller: FlightBegun['controller'];
  height: number;
  wind?: Triple;
  /** What is added to the motion at hover. */
  start?: Push;
}
/** What changes at the beginning of a piece. */
export interface Wish {
  until: number;
  aim?: Aim;
  wind?: Triple;
  push?: Push;
}
export type Piece = FlightPiece & {columns: Columns};
export interface FlightTasks {
  begin: {ask: {stated: Stated; options: FlightOptions}; answer: FlightBegun};
  fly: {ask: Wish; answer: Piece};
}
interface Module {
  begin(text: string, changes: string, options: string): Answer;
  fly(wish: string): Answer;
}

export class FlightCore {
  constructor(private readonly module: Module) {}

  begin({stated, options}: FlightTasks['begin']['ask']): FlightBegun {
    return resultOf(this.module.begin(stated.text, list(stated), JSON.stringify(options)));
  }
  fly(wish: Wish): Piece {
    return resultOf(this.module.fly(JSON.stringify(wish)));
  }
}

export const startFlightCore = async (compiled: WebAssembly.Module) =>
  new FlightCore(await instance<Module>(createFlight, compiled));
