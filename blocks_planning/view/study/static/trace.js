// What the page tells of itself: where the pointer is over the board, ten times a second at most, and
// whether the page can be seen.

const SAMPLE_MS = 100;
const SEND_MS = 2000;
const MOST = 100;

export class Trace {
  constructor(board, tell) {
    this.board = board;
    this.tell = tell;
    this.points = [];
    this.latest = null;
    this.isOn = false;
    board.place.addEventListener('pointermove', (event) => {
      this.latest = [event.clientX, event.clientY];
    });
    setInterval(() => this.#sample(), SAMPLE_MS);
    setInterval(() => this.flush(), SEND_MS);
    document.addEventListener('visibilitychange', () => {
      this.flush();
      tell('visible', { visible: document.visibilityState === 'visible' });
    });
  }

  flush() {
    if (this.points.length > 0) this.tell('pointer', { points: this.points });
    this.points = [];
  }

  #sample() {
    if (!this.isOn || this.latest === null || this.points.length >= MOST || !this.board.svg) return;
    const point = new DOMPoint(...this.latest).matrixTransform(this.board.svg.getScreenCTM().inverse());
    this.latest = null;
    const rounded = (value) => Math.round(value * 1000) / 1000;
    this.points.push([rounded(performance.now() / 1000), rounded(point.x), rounded(this.board.trial.height - point.y)]);
  }
}
