// The page: it receives frames, and draws the latest when the browser has time.

import { Board } from './board.js';
import { Costs, hideCosts, showDeciding } from './costs.js';
import { showDecision } from './decision.js';
import { byId, counted, nameOf, say } from './dom.js';
import { showHealth } from './health.js';
import { Link } from './net.js';
import { Person } from './person.js';
import { Replay } from './replay.js';
import { Trials } from './trials.js';

const board = new Board(byId('board'));
const costs = new Costs();
const person = new Person(board);
const replay = new Replay(showReplay, goLive);
const trials = new Trials((trial) => {
  trials.mark(trial.number);
  replay.begin(trial);
});
const link = new Link(take, showLink);

let latest = null;
let isDue = false;

function take(frame) {
  latest = frame;
  trials.take(frame);
  if (isDue) return;
  isDue = true;
  requestAnimationFrame(() => {
    isDue = false;
    draw();
  });
}

function draw() {
  const frame = latest;
  showHealth(frame.health);
  if (replay.isOn && person.isNewTurn(frame)) replay.end();
  if (frame.trial === null) return;
  if (!replay.isOn) {
    showMode('live');
    showView(frame);
    showDeciding(frame.phase === 'running' && frame.step.region === null && !frame.trial.person);
    showBetween(frame);
  }
  person.show(frame, !replay.isOn);
}

/** A moment of a trial, live or replayed. */
function showView(view) {
  const { trial, step } = view;
  say(byId('tower-name'), nameOf(trial.stimulus));
  byId('tower-name').title = trial.stimulus;
  const planner = trial.person ? 'A person chooses what is built next' : trial.strategy;
  say(byId('planner'), `${planner}; search ${trial.search}; seed ${trial.seed}`);
  const status = byId('status');
  status.hidden = false;
  const region = step.label === '' ? '' : ` ${step.label}`;
  say(status, `${step.word}${region} · ${counted(step.standing.length, 'block')}`);
  status.dataset.outcome = step.status === 'success' ? 'success' : step.status === 'building' ? 'none' : 'failed';
  board.show(view);
  hideCosts(trial.costs_hidden);
  if (!trial.costs_hidden) {
    costs.show(step, view.curve);
    showDecision({ decision: view.decision });
  }
}

function showReplay(view) {
  showMode('replay', `replay of trial ${view.number + 1}`);
  byId('between').hidden = true;
  showDeciding(false);
  showView(view);
  person.show(latest, false);
}

function showMode(mode, text = mode) {
  const pill = byId('mode');
  pill.dataset.mode = mode;
  say(pill, text);
}

function goLive() {
  trials.mark(null);
  if (latest !== null) draw();
}

/** Between two trials: the result of the last one. */
function showBetween(frame) {
  const place = byId('between');
  const isBetween = frame.phase === 'between' && (frame.trial.person || frame.kind === 'over');
  place.hidden = !isBetween;
  if (!isBetween) return;
  const is = { success: 'The tower is complete.', gave_up: 'This tower was given up.' }[frame.step.status]
    ?? `The trial is over: ${frame.step.word}.`;
  const isLast = frame.total > 0 && frame.index === frame.total - 1;
  const next = frame.kind === 'over' || isLast ? 'That was the last one. Thank you.' : 'The next tower comes in a moment.';
  say(place, `${is} ${next}`);
}

function showLink(state, text) {
  const place = byId('connection');
  place.dataset.state = state;
  document.body.dataset.link = state;
  say(byId('connection-text'), text);
  byId('reconnect').hidden = state !== 'lost' && state !== 'over';
  say(byId('reconnect'), state === 'over' ? 'Connect again' : 'Try now');
  const banner = byId('banner');
  banner.hidden = state !== 'over';
  banner.dataset.kind = state;
  if (state === 'over') say(banner, 'The session is over. The trials that ran can still be replayed here.');
}

byId('reconnect').addEventListener('click', () => {
  link.failures = 0;
  link.open();
});
link.open();
