// The trials of the session: running, next, finished. Finished trials are fetched one after the
// other, so that they can be replayed when the server has ended.

import { byId, counted, html, nameOf, say, whenNew, whole } from './dom.js';
import { fetchFrom } from './net.js';

const MOST_KEPT = 500;
const LATE = 4; // the last trials may still change
const LOOK_MS = 1000;
const PAGE = 30;
const SIGNS = { success: '✓', building: '…', cancelled: '–' };

export class Trials {
  /** `onReplay` gets a finished trial, step by step, when the user replays it. */
  constructor(onReplay) {
    this.onReplay = onReplay;
    this.count = 0;
    this.summaries = new Map();
    this.replays = new Map();
    this.shown = null;
    this.visible = PAGE;
    this.isOver = false;
    this.showQueue = whenNew((frame) => this.#showQueue(frame));
    byId('more').addEventListener('click', () => {
      this.visible += PAGE;
      this.draw();
    });
    setInterval(() => this.#look(), LOOK_MS);
  }

  take(frame) {
    if (frame.past < this.count) this.#forget(); // the server now has another session
    const isNew = frame.past !== this.count;
    this.count = frame.past;
    this.showQueue({
      index: frame.index, total: frame.total, past: frame.past, coming: frame.coming,
      phase: frame.phase, stimulus: frame.trial?.stimulus ?? null,
    });
    this.isOver = frame.kind === 'over';
    if (this.isOver) this.#keep(frame.trials, frame.replays);
    else if (isNew && !this.soon) this.soon = setTimeout(() => this.#look(), 100);
  }

  /** Mark the trial that is being replayed; null for none. */
  mark(number) {
    this.shown = number;
    this.draw();
  }

  async replay(number) {
    const isSettled = number < this.count - LATE || this.isOver;
    if (isSettled && this.replays.has(number)) return this.onReplay(this.replays.get(number));
    try {
      this.#keep([], await fetchFrom('/replays', number));
    } catch { /* use the kept replay */ }
    const kept = this.replays.get(number);
    return kept === undefined ? undefined : this.onReplay(kept);
  }

  get lastNumber() {
    return this.count - 1;
  }

  #forget() {
    this.summaries.clear();
    this.replays.clear();
    this.known = 0;
  }

  #keep(summaries, replays) {
    for (const one of summaries) this.summaries.set(one.number, one);
    for (const one of replays) {
      this.summaries.set(one.number, one);
      this.replays.set(one.number, one);
    }
    for (const kept of [this.summaries, this.replays]) {
      for (const number of [...kept.keys()].sort((a, b) => a - b).slice(0, -MOST_KEPT)) kept.delete(number);
    }
    this.draw();
  }

  async #look() {
    clearTimeout(this.soon);
    this.soon = null;
    if (this.isOver || this.isLooking) return;
    this.isLooking = true;
    try {
      const known = this.known ?? 0;
      if (this.count > known) {
        const { count } = this;
        this.#keep(await fetchFrom('/trials', known - LATE), []);
        this.known = count;
      }
      const wanted = this.#wanted();
      if (wanted !== null) this.#keep([], await fetchFrom('/replays', wanted));
    } catch { /* the connection status shows it */ }
    this.isLooking = false;
  }

  /** Number from which to fetch replays: the latest that are settled and not kept yet. */
  #wanted() {
    const oldest = Math.max(0, this.count - MOST_KEPT);
    for (let number = this.count - 1 - LATE; number >= oldest; number -= 1) {
      if (!this.replays.has(number)) return number - 4;
    }
    for (let number = this.count - 1; number >= Math.max(0, this.count - LATE); number -= 1) {
      if (!this.replays.has(number)) return number;
    }
    return null;
  }

  #showQueue({ index, total, past, coming, phase, stimulus }) {
    const number = index === null ? past + (phase === 'running' ? 1 : 0) : index + 1;
    const of = total ? ` of ${whole(total)}` : '';
    const done = total ? Math.max(past, index === null ? 0 : index + (phase === 'between' ? 1 : 0)) : past;
    const text = stimulus === null ? 'Waiting for the first trial'
      : `Trial ${whole(number)}${of}: ${nameOf(stimulus)}`;
    say(byId('progress-text'), text);
    const bar = byId('progress-bar');
    bar.hidden = !total;
    bar.max = total || 1;
    bar.value = Math.min(done, total);
    say(byId('queue-text'), total ? `${whole(done)} of ${whole(total)} done` : `${counted(past, 'trial')} done`);
    const names = coming.map((one) => nameOf(one.stimulus));
    const more = total && index !== null ? total - index - 1 - names.length : 0;
    say(byId('coming'), names.length === 0 ? ''
      : `Next: ${names.join(', ')}${more > 0 ? ` and ${whole(more)} more` : ''}`);
  }

  draw() {
    const all = [...this.summaries.values()].sort((a, b) => b.number - a.number);
    byId('more').hidden = all.length <= this.visible;
    if (all.length === 0) return;
    const wide = (attributes) => ({ ...attributes, class: `${attributes.class} wide` });
    const head = html('tr', {},
      html('th', { scope: 'col' }, '#'),
      html('th', { scope: 'col' }, 'tower'),
      html('th', { scope: 'col' }, 'outcome'),
      html('th', { scope: 'col', class: 'number' }, 'blocks'),
      html('th', wide({ scope: 'col', class: 'number' }), 'action'),
      html('th', wide({ scope: 'col', class: 'number' }), 'subgoal'),
      html('th', { scope: 'col' }, html('span', { class: 'visually-hidden' }, 'replay')));
    const rows = all.slice(0, this.visible).map((one) => {
      const button = html('button', {
        type: 'button', class: 'small', 'aria-label': `Replay trial ${one.number + 1}, ${nameOf(one.stimulus)}`,
      }, 'Replay');
      button.addEventListener('click', () => this.replay(one.number));
      const outcome = one.status === 'success' ? 'success' : one.status === 'building' ? 'none' : 'failed';
      return html('tr', { 'data-shown': one.number === this.shown, 'data-number': one.number },
        html('td', {}, whole(one.number + 1)),
        html('th', { scope: 'row', title: one.stimulus }, nameOf(one.stimulus),
          html('span', { class: 'planner' }, `${one.strategy}; ${one.search}`)),
        html('td', { class: 'outcome', 'data-outcome': outcome }, `${SIGNS[one.status] ?? '✗'} ${one.word}`),
        html('td', { class: 'number' }, whole(one.blocks)),
        html('td', wide({ class: 'number' }), one.action_cost === null ? '–' : whole(one.action_cost)),
        html('td', wide({ class: 'number' }), one.subgoal_cost === null ? '–' : whole(one.subgoal_cost)),
        html('td', { class: 'number' }, button));
    });
    const focused = document.activeElement?.closest?.('#past tr')?.dataset.number;
    const place = byId('past');
    const { scrollTop } = place;
    place.replaceChildren(html('table', {}, html('thead', {}, head), html('tbody', {}, ...rows)));
    place.scrollTop = scrollTop;
    if (focused !== undefined) place.querySelector(`tr[data-number="${focused}"] button`)?.focus();
  }
}
