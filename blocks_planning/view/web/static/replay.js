// Replay of a finished trial, step by step.

import { byId, say } from './dom.js';

const STEP_MS = 700;
const PLAY = 'M2 1v10l8-5z';
const PAUSE = 'M2 1h3v10H2zM7 1h3v10H7z';

export class Replay {
  /** `onStep` gets the view of a step; `onEnd` is called when the user goes back to live. */
  constructor(onStep, onEnd) {
    this.onStep = onStep;
    this.onEnd = onEnd;
    this.trial = null;
    this.timer = null;
    byId('first').addEventListener('click', () => this.go(0));
    byId('previous').addEventListener('click', () => this.go(this.at - 1));
    byId('next').addEventListener('click', () => this.go(this.at + 1));
    byId('last').addEventListener('click', () => this.go(Infinity));
    byId('play').addEventListener('click', () => this.toggle());
    byId('to-live').addEventListener('click', () => this.end());
    byId('scrubber').addEventListener('input', (event) => this.go(event.target.valueAsNumber));
    document.addEventListener('keydown', (event) => this.#onKey(event));
  }

  get isOn() {
    return this.trial !== null;
  }

  begin(trial) {
    this.trial = trial;
    byId('replay').hidden = false;
    byId('scrubber').max = trial.steps.length - 1;
    this.go(0);
    this.#play(true);
    byId('play').focus({ preventScroll: true });
    byId('tower').scrollIntoView({ block: 'nearest' });
  }

  end() {
    this.#play(false);
    this.trial = null;
    byId('replay').hidden = true;
    this.onEnd();
  }

  toggle() {
    if (this.timer !== null) this.#play(false);
    else {
      if (this.at >= this.trial.steps.length - 1) this.#show(0);
      this.#play(true);
    }
  }

  /** Show a step that the user has chosen; playing stops. */
  go(at) {
    this.#play(false);
    this.#show(at);
  }

  #show(at) {
    const { trial } = this;
    this.at = Math.min(Math.max(at, 0), trial.steps.length - 1);
    const step = trial.steps[this.at];
    const scrubber = byId('scrubber');
    scrubber.value = this.at;
    const text = `step ${this.at} of ${trial.steps.length - 1}`;
    say(byId('step-text'), text);
    scrubber.setAttribute('aria-valuetext', `${text}, ${step.standing.length} blocks`);
    this.onStep({
      ...trial,
      step,
      decision: step.entry < 0 ? null : trial.decisions[step.entry] ?? null,
      curve: trial.curve.slice(0, step.entry + 1),
    });
  }

  #play(isOn) {
    clearInterval(this.timer);
    this.timer = isOn
      ? setInterval(() => {
        if (this.at >= this.trial.steps.length - 1) this.#play(false);
        else this.#show(this.at + 1);
      }, STEP_MS / Number(byId('speed').value))
      : null;
    byId('play-sign').setAttribute('d', isOn ? PAUSE : PLAY);
    say(byId('play-text'), isOn ? 'Pause' : 'Play');
  }

  #onKey(event) {
    if (!this.isOn || event.altKey || event.ctrlKey || event.metaKey) return;
    if (event.target.closest('input, select, textarea, dialog, summary')) return;
    const isButton = event.target.closest('button') !== null;
    const act = {
      ArrowLeft: () => this.go(this.at - 1),
      ArrowRight: () => this.go(this.at + 1),
      Home: () => this.go(0),
      End: () => this.go(Infinity),
      Escape: () => this.end(),
      ' ': isButton ? undefined : () => this.toggle(),
    }[event.key];
    if (act === undefined) return;
    event.preventDefault();
    act();
  }
}
