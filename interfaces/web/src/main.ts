import './style.css';
import './parts.css';
import './embed_print.css';
import './pictures/pictures.css';
import {About} from './about';
import {Compare} from './compare';
import {Controls} from './controls';
import {compiledCore, startCore} from './core';
import {byId} from './dom';
import {Explorer} from './explorer';
import {Files} from './files';
import {FitPanel} from './fit_panel';
import {FlightView} from './flight';
import {Glossary} from './glossary';
import {HoverPanel} from './hover_panel';
import {stateOf} from './link';
import {Share} from './share';
import {Sound} from './sound';
import {stateFor} from './state';
import {Studies} from './studies';
import {Toolbar} from './toolbar';
import {Tour} from './tour';
import {shipped, shippedDesign} from './vehicles';
import {Views} from './views';

declare global {
  interface Window {
    /** When the first result stood on the page [ms since navigation]. */
    firstNumber?: number;
  }
}

/** Shows the state of the address; the address stays where it cannot be used, and the page says why. */
async function openAddress(explorer: Explorer) {
  const {state, problems} = await stateOf(location.hash, shipped);
  const why = [...problems, ...(state ? explorer.problemsOf(state) : [])];
  if (state && why.length === 0) {
    const {name, text} = state.design;
    if (shipped[name] !== text) explorer.files.add(name, text);
    return explorer.go(state, {from: 'browser'});
  }
  if (!explorer.shown) await explorer.go(explorer.state, {from: 'browser', keepAddress: why.length > 0});
  if (why.length) {
    explorer.say(
      `The link in the address cannot be used; what is shown is ${explorer.state.design.name}.\n${why.join('\n')}`,
    );
  }
}

/** ?embed=mechanism,lift: the pictures named and nothing else, for the frame of another page. */
function embed() {
  const names = new URLSearchParams(location.search).get('embed')?.split(',') ?? [];
  const figures = names.flatMap((name) =>
    Array.from(document.querySelectorAll(`[data-picture="${CSS.escape(name)}"]`)),
  );
  if (figures.length === 0) return;
  document.body.dataset.embed = names.join();
  for (const figure of figures) figure.classList.add('embedded');
}

async function start() {
  const compiled = await compiledCore();
  const core = await startCore(compiled);
  const explorer = new Explorer(core, compiled, stateFor(shippedDesign('friction2022')));
  explorer.controls = new Controls(byId('controls'), core.tables.keys, explorer.typical, {
    change: (key, value, final) => void explorer.change({[key]: value}, {final, origin: key}),
    reset: (key) => void explorer.change({[key]: ''}, {origin: key}),
  });
  explorer.views = new Views(explorer);
  new Toolbar(explorer);
  new Compare(explorer);
  new Files(explorer);
  new Share(explorer);
  new Glossary(core.tables);
  new Sound(explorer);
  const flight = new FlightView(explorer);
  explorer.views.followers.push((share, playing) => flight.show(share, playing));
  new Tour(explorer);
  new About();
  embed();
  await openAddress(explorer);
  await explorer.idle();
  new Studies(explorer);
  new HoverPanel(explorer);
  new FitPanel(explorer);
  window.addEventListener('beforeprint', () => explorer.inView.flush());
  window.addEventListener('resize', () => explorer.views.resized());
  window.addEventListener('popstate', (event) => {
    const state = explorer.visitedState(event.state);
    void (state ? explorer.go(state, {from: 'browser'}) : openAddress(explorer));
  });
  Object.assign(window, {explorer, shipped, flight}); // for tests, and for the curious
  document.body.dataset.ready = 'true';
}

start().catch((error) => {
  const message = byId('message');
  message.hidden = false;
  message.textContent = `The explorer cannot start in this browser: ${error}`;
});
