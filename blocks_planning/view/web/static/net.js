// Connection to the server: a socket receives frames and is reopened when it is lost; finished
// trials are fetched; proposals are posted.

const FIRST_PAUSE_MS = 400;
const LONGEST_PAUSE_MS = 8000;
const SILENCE_MS = 4000; // the server sends something every second

export class Link {
  /** `onFrame` gets every frame, `onState` 'connecting', 'live', 'lost' or 'over' and a sentence. */
  constructor(onFrame, onState) {
    this.onFrame = onFrame;
    this.onState = onState;
    this.failures = 0;
    this.isOver = false;
  }

  open() {
    clearTimeout(this.timer);
    clearTimeout(this.watch);
    this.socket?.close();
    this.isOver = false;
    const socket = new WebSocket(`${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/live`);
    this.socket = socket;
    socket.onmessage = (event) => {
      if (socket === this.socket) this.#take(JSON.parse(event.data));
    };
    socket.onclose = () => {
      if (socket === this.socket) this.#lost();
    };
    this.#watchOver();
  }

  #take(frame) {
    this.failures = 0;
    this.#watchOver();
    this.isOver = frame.kind === 'over';
    this.onState(this.isOver ? 'over' : 'live', this.isOver ? 'the session is over' : 'live');
    this.onFrame(frame);
  }

  #watchOver() {
    clearTimeout(this.watch);
    this.watch = setTimeout(() => this.#lost(), SILENCE_MS);
  }

  async #lost() {
    clearTimeout(this.watch);
    const lost = this.socket;
    this.socket = null;
    lost?.close();
    if (this.isOver) return;
    const pause = Math.min(FIRST_PAUSE_MS * 2 ** this.failures, LONGEST_PAUSE_MS);
    this.failures += 1;
    this.timer = setTimeout(() => this.open(), pause * (0.8 + 0.4 * Math.random()));
    this.onState('lost', 'connection lost, trying again');
    const reason = await this.#reason();
    if (reason !== null && this.socket === null) this.onState('lost', reason);
  }

  /** The reason why the server refuses this page, if it can be reached. */
  async #reason() {
    try {
      const answer = await fetch('/trials?from=999999999');
      return answer.ok ? null : (await answer.json()).reason;
    } catch {
      return null;
    }
  }
}

export async function fetchFrom(path, first) {
  const answer = await fetch(`${path}?from=${Math.max(0, first)}`);
  if (!answer.ok) throw new Error((await answer.json()).reason);
  return answer.json();
}

/** Post a proposal; null if it was accepted, otherwise the reason of the refusal. */
export async function propose(proposal) {
  try {
    const answer = await fetch('/proposal', {
      method: 'POST',
      headers: { 'Content-Type': 'application/json' },
      body: JSON.stringify(proposal),
    });
    const said = await answer.json();
    return answer.ok ? null : said.reason;
  } catch {
    return 'the connection is lost: nothing was sent';
  }
}
