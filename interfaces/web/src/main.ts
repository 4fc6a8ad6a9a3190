import './style.css';
import './pictures/pictures.css';
import {Background} from './background';
import {compiledCore, startCore} from './core';
import {byId} from './dom';
import {Explorer} from './explorer';
import {initialState, stateOf} from './state';
import {Studies} from './studies';
import {Toolbar} from './toolbar';
import {Tour} from './tour';
import {shipped} from './vehicles';

async function start() {
  const compiled = await compiledCore();
  const core = await startCore(compiled);
  const explorer = new Explorer(core, new Background(compiled), initialState());
  if (!explorer.open(await stateOf(location.hash))) explorer.open(initialState());
  const studies = new Studies(explorer, explorer.background);
  explorer.keysChanged = () => studies.offerKeys();
  new Toolbar(explorer);
  new Tour(explorer);
  window.addEventListener('resize', () => explorer.resized());
  window.addEventListener('hashchange', async () => {
    explorer.open(await stateOf(location.hash));
    explorer.refreshTools();
  });
  Object.assign(explorer, {shipped});
  Object.assign(window, {explorer}); // for tests, and for the curious
  document.body.dataset.ready = 'true';
}

start().catch((error) => {
  const message = byId('message');
  message.hidden = false;
  message.textContent = `The explorer cannot start in this browser: ${error}`;
});
