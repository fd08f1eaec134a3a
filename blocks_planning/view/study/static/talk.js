// Connection to the server: one socket. An act that got no answer is sent again after the
// connection was lost; the server takes each number once.

const FIRST_PAUSE_MS = 300;
const LONGEST_PAUSE_MS = 5000;
const TAKEN = 4001;
const REPLACED = 4002;

function ownKey() {
  let key = sessionStorage.getItem('study-key');
  if (key === null) {
    key = Array.from(crypto.getRandomValues(new Uint8Array(16)), (n) => n.toString(16).padStart(2, '0')).join('');
    sessionStorage.setItem('study-key', key);
  }
  return key;
}

export class Talk {
  /** `onFrame` gets frames, `onRefused` refusals, `onState` 'live', 'lost' or 'taken'. */
  constructor(onFrame, onRefused, onState) {
    this.onFrame = onFrame;
    this.onRefused = onRefused;
    this.onState = onState;
    this.failures = 0;
    this.waiting = null; // the act without an answer
  }

  open() {
    clearTimeout(this.timer);
    const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
    const socket = new WebSocket(`${scheme}://${location.host}/live`);
    this.socket = socket;
    socket.onopen = () => socket.send(JSON.stringify({ hello: ownKey() }));
    socket.onmessage = (event) => {
      if (socket === this.socket) this.#take(JSON.parse(event.data));
    };
    socket.onclose = (event) => {
      if (socket === this.socket) this.#lost(event.code);
    };
  }

  get isLive() {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  /** Do something; `frame` is what it refers to. */
  act(frame, act, more = {}) {
    if (this.waiting !== null) return;
    this.waiting = { ...more, act, number: frame.acts, step: frame.step };
    this.#send(this.waiting);
  }

  /** Tell something of the page; it is lost if there is no connection. */
  note(frame, note, more) {
    if (frame?.step !== undefined) this.#send({ ...more, note, step: frame.step });
  }

  #send(said) {
    if (this.isLive) this.socket.send(JSON.stringify(said));
  }

  #take(said) {
    if (said.kind === 'taken') return;
    this.failures = 0;
    if (said.kind === 'refused') {
      this.waiting = null;
      this.onRefused(said);
      return;
    }
    this.onState('live');
    if (this.waiting !== null && this.waiting.number === said.acts && this.waiting.step === said.step) {
      if (this.isFresh !== this.socket) this.#send(this.waiting);
    } else this.waiting = null;
    this.isFresh = this.socket;
    this.onFrame(said);
  }

  #lost(code) {
    this.socket = null;
    if (code === TAKEN || code === REPLACED) {
      this.onState('taken');
      return;
    }
    this.onState('lost');
    const pause = Math.min(FIRST_PAUSE_MS * 2 ** this.failures, LONGEST_PAUSE_MS);
    this.failures += 1;
    this.timer = setTimeout(() => this.open(), pause * (0.8 + 0.4 * Math.random()));
  }
}
