// The library of flights in a worker of its own.
import {type FlightCore, type FlightTasks, startFlightCore} from './flight_core';
import {serve} from './worker_loop';

type Request = {[K in keyof FlightTasks]: {id: number; kind: K; ask: FlightTasks[K]['ask']}}[keyof FlightTasks];

serve<FlightCore, Request>(startFlightCore, (library, request) =>
  request.kind === 'begin' ? library.begin(request.ask) : library.fly(request.ask),
);
