// The participant's page: it shows the step that the server says, and sends what is done.

import { Board } from './board.js';
import { Building } from './building.js';
import { byId, say, whenNew } from './dom.js';
import { Marking } from './marking.js';
import { Scoping } from './scoping.js';
import { Talk } from './talk.js';
import { elementsOf } from './texts.js';
import { Trace } from './trace.js';

const ENDS = {
  waiting: 'Please wait: the experimenter begins the session.',
  finished: 'The session is over. You can close this page. Thank you.',
  stopped: 'The session is over. You can close this page. Thank you.',
  declined: 'You did not agree, so nothing more is asked of you. You can close this page. Thank you.',
  taken: 'The study is open in another window. Go on there, or close that window and try again.',
};
const TITLES = {
  consent: 'Consent', text: 'Instructions', break: 'Break', debrief: 'The end',
};
const ANSWERS = {
  built: 'It is built.',
  failed: 'There is no way to fill this part. Try another one.',
  withdrawn: 'Withdrawn. Draw another part.',
  marked: 'Every cell belongs to a part. You can go on.',
};
const OVER = {
  success: 'The tower is complete.',
  stuck: 'Nothing fits any more: this tower is over.',
  gave_up: 'You gave this tower up.',
};

const SETTLED_MS = 150; // a preview that is shown for less is not told

let frame = null;
let shownAt = 0; // when this state came up
const board = new Board(byId('board'));
const talk = new Talk(take, refused, showLink);
const tell = (note, more) => talk.note(frame, note, more);
const tellPreview = settled((more) => tell('preview', more));
const modes = [Marking, Scoping, Building].map((Mode) => ({ Mode, own: new Mode(board, wish, tellPreview) }));
const trace = new Trace(board, tell);
const showText = whenNew((blocks) => byId('text').replaceChildren(...elementsOf(blocks)));
const showStep = whenNew(() => {
  scrollTo(0, 0);
  byId(frame.trial ? 'tower-name' : 'page-title').focus({ preventScroll: true });
});
const showState = whenNew(() => {
  shownAt = performance.now();
});

function settled(call) {
  let timer;
  return (value) => {
    clearTimeout(timer);
    timer = setTimeout(() => call(value), SETTLED_MS);
  };
}

function wish(word, fields) {
  if (talk.waiting !== null) return;
  const thinking_s = Math.max(0, (performance.now() - shownAt) / 1000);
  trace.flush();
  talk.act(frame, word, { ...fields, thinking_s });
  if (talk.waiting === null) return;
  say(byId('answer'), 'One moment…');
  byId('answer').dataset.outcome = 'none';
}

function take(next) {
  frame = next;
  document.title = frame.title;
  say(byId('title'), frame.title);
  byId('progress').hidden = frame.steps === undefined;
  byId('progress-bar').max = frame.steps ?? 1;
  byId('progress-bar').value = frame.step ?? 0;
  byId('stop').hidden = !frame.may_stop;
  byId('banner').hidden = true;
  const { trial } = frame;
  for (const id of ['tower', 'panel']) byId(id).hidden = trial === null;
  byId('page').hidden = trial !== null;
  if (trial === null) showPage(frame.stage);
  else showTrial(trial);
  showStep([frame.stage, frame.step]);
}

function showPage(stage) {
  trace.isOn = false;
  for (const { own } of modes) own.turn(false);
  const end = ENDS[stage];
  say(byId('page-title'), TITLES[stage] ?? frame?.title ?? 'Study');
  showText(end === undefined ? frame.text : [{ tag: 'p', lines: [[['', end]]] }]);
  for (const id of ['agree', 'decline']) byId(id).hidden = stage !== 'consent';
  byId('go-on').hidden = stage === 'consent' || end !== undefined;
  say(byId('go-on'), stage === 'debrief' ? 'Finish' : 'Go on');
  byId('again').hidden = stage !== 'taken';
}

function showTrial(trial) {
  const isOpen = trial.status === 'building';
  const isNew = board.trial?.id !== trial.id || board.shownSequence !== trial.sequence;
  say(byId('tower-name'), trial.stimulus);
  const standing = trial.all_blocks.map((_, index) => index);
  board.show({ trial: fixed(trial), all_blocks: trial.all_blocks, step: { standing, region: null, planned: [], top: 0, label: '', colour: '' } });
  board.shownSequence = trial.sequence;
  showState([trial.id, trial.sequence, trial.proposals]);
  for (const { Mode, own } of modes) {
    if (!Mode.isMeant(trial) || !isOpen) own.turn(false);
  }
  const meant = modes.find(({ Mode }) => Mode.isMeant(trial));
  if (isOpen) meant.own.turn(true, trial, isNew || trial.answer === 'withdrawn');
  trace.isOn = isOpen;
  byId('preview').hidden = !isOpen;
  byId('give-up').hidden = !isOpen || Marking.isMeant(trial);
  byId('next').hidden = isOpen && trial.answer !== 'marked';
  showAnswer(trial, isOpen);
  showTime(trial, isOpen);
  if (!isOpen && document.activeElement === document.body) byId('next').focus();
}

/** The part of a trial that does not change while it runs, so that the board is made once. */
const fixed = ({ id, stimulus, width, height, silhouette, wishes }) => ({
  id, stimulus, width, height, silhouette, done: wishes.includes('mark') ? 'marked' : 'built',
});

function showAnswer(trial, isOpen) {
  const place = byId('answer');
  const over = trial.timed_out ? 'The time for this tower is over.' : OVER[trial.status] ?? 'This tower is over.';
  say(place, isOpen ? ANSWERS[trial.answer] ?? '' : over);
  const isGood = isOpen ? ['built', 'marked'].includes(trial.answer) : trial.status === 'success';
  place.dataset.outcome = isGood ? 'built' : 'failed';
}

function showTime(trial, isOpen) {
  const endsAt = isOpen && trial.left_s !== null ? performance.now() + trial.left_s * 1000 : null;
  clearInterval(showTime.timer);
  byId('time').hidden = endsAt === null;
  if (endsAt === null) return;
  const show = () => {
    const s = Math.max(0, Math.ceil((endsAt - performance.now()) / 1000));
    say(byId('time'), `${Math.floor(s / 60)}:${String(s % 60).padStart(2, '0')} left`);
  };
  show();
  showTime.timer = setInterval(show, 500);
}

function refused({ code, reason }) {
  if (code === 'disk' || frame?.trial == null) {
    showBanner(reason);
    return;
  }
  say(byId('answer'), `This was not taken: ${reason}.`);
  byId('answer').dataset.outcome = 'failed';
}

function showBanner(text) {
  say(byId('banner'), text);
  byId('banner').hidden = false;
}

function showLink(state) {
  document.body.dataset.link = state;
  if (state === 'lost') showBanner('The connection is lost. Nothing that you did is lost; the page tries again by itself.');
  if (state !== 'taken') return;
  byId('banner').hidden = true;
  for (const id of ['tower', 'panel', 'progress', 'stop']) byId(id).hidden = true;
  byId('page').hidden = false;
  showPage('taken');
}

function askWhether(title, text, act) {
  say(byId('sure-title'), title);
  say(byId('sure-text'), text);
  byId('sure').onclose = (event) => {
    if (event.target.returnValue === 'yes') act();
    event.target.returnValue = '';
  };
  byId('sure').showModal();
}

for (const [id, word] of [['agree', 'agree'], ['decline', 'decline'], ['go-on', 'next'], ['next', 'next']]) {
  byId(id).addEventListener('click', () => talk.act(frame, word));
}
byId('again').addEventListener('click', () => talk.open());
byId('give-up').addEventListener('click', () => askWhether(
  'Give up this tower?', 'It stays as it is, and you go on with what comes next.', () => wish('give_up', {})));
byId('stop').addEventListener('click', () => askWhether(
  'Stop taking part?', 'The study ends for you. What you did so far is kept, unless you ask for it to be deleted.',
  () => talk.act(frame, 'stop')));
talk.open();
