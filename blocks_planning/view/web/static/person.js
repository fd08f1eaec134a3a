// The person who plans: their turn, the drawn region, the results of their proposals.

import { both, pictureOf, without } from './cells.js';
import { byId, counted, html, say, svg, whenNew } from './dom.js';
import { Drawing } from './drawing.js';
import { propose } from './net.js';

export class Person {
  constructor(board) {
    this.board = board;
    this.drawing = new Drawing(board, () => this.#preview(), () => this.#confirm());
    this.turn = null;
    this.shownAt = 0;
    this.isSending = false;
    this.notice = null;
    this.told = []; // the accepted proposals of the current state
    this.showBlocks = whenNew((library) => this.#showBlocks(library));
    this.showSaid = whenNew((said) => this.#showSaid(said));
    byId('confirm').addEventListener('click', () => this.#confirm());
    byId('withdraw').addEventListener('click', () => this.#send('withdrawn', this.drawing.cells));
    byId('give-up').addEventListener('click', () => byId('sure').showModal());
    byId('sure').addEventListener('close', (event) => {
      if (event.target.returnValue === 'yes') this.#send('give_up', new Set());
      event.target.returnValue = '';
    });
    byId('add').addEventListener('change', (event) => {
      this.drawing.adds = event.target.checked;
    });
  }

  /** Whether a frame has a new turn. */
  isNewTurn(frame) {
    return frame.turn !== null && frame.turn !== undefined && !frame.turn.waiting
      && keyOf(frame) !== this.turn?.key;
  }

  /** Show a frame; `isSeen`: whether the page shows its tower now, not a replay. */
  show(frame, isSeen) {
    if (frame.kind === 'over') this.told = []; // the next session is another one
    const isPerson = frame.trial?.person === true;
    byId('person').hidden = !isPerson || !isSeen;
    if (!isPerson || !isSeen) {
      this.drawing.turn(false);
      return;
    }
    this.frame = frame;
    const { trial } = frame;
    byId('participant').hidden = trial.participant === '';
    say(byId('participant'), `participant ${trial.participant}`);
    this.showBlocks(trial.library);
    this.showSaid([frame.proposals, trial.costs_hidden]);
    this.#takeTurn(frame);
    const isMine = this.turn !== null;
    say(byId('person-title'), this.#title(frame));
    byId('ask').hidden = !isMine;
    this.drawing.turn(isMine);
    if (isMine) this.drawing.draw();
    this.#enable();
    this.#answer(frame);
  }

  #title({ step, turn, trial }) {
    if (step.status !== 'building') return 'This tower is done';
    if (turn === null) return trial.person && step.region !== null ? 'Building…' : 'One moment…';
    return turn.waiting ? 'Looking for a way to build it…' : 'Your turn';
  }

  #takeTurn(frame) {
    const { turn } = frame;
    if (turn === null || turn.waiting) {
      this.turn = null;
      return;
    }
    const key = keyOf(frame);
    if (this.turn?.key === key) return;
    const untold = this.told.filter((one) => one.trial_id === frame.trial.id
      && one.sequence === turn.sequence && one.number >= turn.number);
    if (untold.length > 0) {
      this.#tellAgain(untold);
      return;
    }
    const isSameState = this.state === stateOf(frame);
    this.state = stateOf(frame);
    this.turn = { ...turn, key, trial_id: frame.trial.id };
    this.notice = null;
    this.shownAt = performance.now();
    if (!isSameState) this.drawing.clear();
  }

  #counts() {
    const { cells } = this.drawing;
    const { target, built } = this.board;
    const inside = both(cells, target);
    return {
      drawn: cells.size,
      toFill: without(inside, built).size,
      built: both(cells, built).size,
      outside: without(without(cells, target), built).size,
    };
  }

  #preview() {
    if (this.board.trial === null) return;
    const place = byId('preview');
    const { drawn, toFill, built, outside } = this.#counts();
    const notes = [
      built ? `${built} built already` : '', outside ? `${outside} outside, left out` : '',
    ].filter(Boolean).join(', ');
    let text = 'Nothing is drawn yet.';
    if (this.notice) text = this.notice;
    else if (drawn && toFill) text = `${counted(toFill, 'cell')} to fill${notes ? ` (${notes})` : ''}.`;
    else if (drawn && built) text = 'All of it is built already: draw over cells that are still empty.';
    else if (drawn) text = 'This is outside the silhouette: draw over the grey cells.';
    say(place, text);
    place.dataset.check = this.notice || (drawn && !toFill) ? 'bad' : drawn ? 'good' : 'none';
    this.#enable();
  }

  #enable() {
    const isMine = this.turn !== null && !this.isSending;
    byId('confirm').disabled = !isMine || this.#counts().toFill === 0;
    byId('withdraw').disabled = !isMine || this.drawing.cells.size === 0;
    byId('give-up').disabled = !isMine;
  }

  #confirm() {
    if (!byId('confirm').disabled) this.#send('build', this.drawing.cells);
  }

  async #send(kind, cells) {
    const { turn } = this;
    if (turn === null || this.isSending) return;
    const { width, height } = this.board.trial;
    const proposal = {
      trial_id: turn.trial_id,
      sequence: turn.sequence,
      number: turn.number,
      kind,
      region: pictureOf(cells, width, height),
      thinking_s: Math.max(0, (performance.now() - this.shownAt) / 1000),
    };
    this.isSending = true;
    this.#enable();
    const refused = await propose(proposal);
    this.isSending = false;
    this.notice = refused === null ? null : `Not accepted: ${refused}.`;
    if (refused === null) {
      this.#remember(proposal);
      this.drawing.clear();
    } else this.#preview();
  }

  #remember(proposal) {
    this.told = [...this.told.filter((one) => one.trial_id === proposal.trial_id
      && one.sequence === proposal.sequence), proposal];
  }

  /** Send the proposals of this state again to a restarted server. */
  async #tellAgain(untold) {
    if (this.isSending) return;
    this.isSending = true;
    for (const one of untold) {
      if (await propose({ ...one, again: true }) !== null) break;
    }
    this.isSending = false;
  }

  #answer({ proposals, step }) {
    const last = proposals.at(-1);
    const place = byId('answer');
    let text = '';
    let outcome = '';
    if (step.status !== 'building') {
      outcome = step.status === 'success' ? 'built' : 'failed';
      text = step.status === 'success' ? 'The tower is complete.' : `The trial is over: ${step.word}.`;
    } else if (last?.outcome === 'built') {
      outcome = 'built';
      text = `It can be built: ${counted(last.cells, 'cell')}${cost(last)}.`;
    } else if (last?.outcome === 'failed') {
      outcome = 'failed';
      text = `It could not be built${cost(last)}. Try another region.`;
    } else if (last?.outcome === 'withdrawn') text = 'Withdrawn. Draw another region.';
    say(place, text);
    place.dataset.outcome = outcome;
  }

  #showBlocks(library) {
    const unit = 9;
    byId('blocks').replaceChildren(...library.map(([width, height]) =>
      svg('svg', {
        width: width * unit + 2, height: height * unit + 2, role: 'img', 'aria-label': `${width} wide, ${height} high`,
      }, svg('rect', { x: 1, y: 1, width: width * unit, height: height * unit }))));
  }

  #showSaid([proposals]) {
    byId('said-box').hidden = proposals.length === 0;
    const words = {
      built: 'built', failed: 'could not be built', searching: 'searching',
      withdrawn: 'withdrawn', give_up: 'gave up',
    };
    byId('said').replaceChildren(...proposals.map((one) => {
      const cells = one.kind === 'give_up' ? '' : `${counted(one.cells, 'cell')}: `;
      return html('li', { 'data-outcome': one.outcome === 'built' ? 'success' : 'none' },
        `${cells}${words[one.outcome]}${cost(one)}`);
    }));
  }
}

function cost(one) {
  return one.cost === undefined ? '' : `, ${counted(one.cost, 'state')} evaluated`;
}

const stateOf = (frame) => `${frame.trial.id}/${frame.turn.sequence}`;
const keyOf = (frame) => `${stateOf(frame)}/${frame.turn.number}`;
