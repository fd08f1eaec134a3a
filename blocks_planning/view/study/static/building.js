// Building: a participant drags blocks over the picture and lets them fall. Where a block would come
// to rest, and whether it may stand there, the server has told beforehand.

import { pictureOf, rectangle } from './cells.js';
import { byId, html, say, svg, whenNew } from './dom.js';
import { blockName, blockPicture } from './scoping.js';

export class Building {
  /** `wish` asks for something: (word, fields); `tell` notes over what a block is held. */
  constructor(board, wish, tell) {
    this.board = board;
    this.wish = wish;
    this.tell = tell;
    this.isOn = false;
    this.block = 0;
    this.column = null;
    this.held = null; // the pointer that drags a block
    this.showPalette = whenNew((library) => this.#showPalette(library));
    this.tellHeld = whenNew((held) => this.#tellHeld(held));
    const { place } = board;
    place.addEventListener('pointermove', (event) => this.#onMove(event));
    place.addEventListener('pointerleave', () => this.#hold(null));
    place.addEventListener('pointerdown', (event) => {
      if (!this.isOn || event.button !== 0) return;
      place.focus({ preventScroll: true });
      place.classList.add('pointing');
      event.preventDefault();
      this.#onMove(event);
    });
    place.addEventListener('pointerup', (event) => {
      if (this.isOn && this.held === null) this.#letFall(event);
    });
    place.addEventListener('keydown', (event) => this.#onKey(event));
    const palette = byId('palette');
    palette.addEventListener('pointerdown', (event) => this.#grab(event));
    addEventListener('pointermove', (event) => {
      if (event.pointerId === this.held) this.#onMove(event);
    });
    addEventListener('pointerup', (event) => {
      if (event.pointerId !== this.held) return;
      this.held = null;
      if (this.#columnAt(event) !== null) this.#letFall(event);
    });
    addEventListener('pointercancel', () => {
      this.held = null;
      this.#hold(null);
    });
  }

  static isMeant = (trial) => trial.wishes.includes('place');

  turn(isOn, trial, isNew) {
    byId('building').hidden = !isOn;
    const { place } = this.board;
    if (this.isOn !== isOn) this.#name(place, isOn);
    this.isOn = isOn;
    if (!isOn) return;
    this.trial = trial;
    this.showPalette(trial.library);
    if (isNew) this.#hold(null);
    this.#draw();
  }

  #name(place, isOn) {
    place.classList.toggle('placing', isOn);
    place.tabIndex = isOn ? 0 : -1;
    const attributes = {
      role: 'application',
      'aria-label': 'The tower. Numbers choose a block, arrows move it, Enter lets it fall.',
      'aria-describedby': 'board-text preview',
    };
    for (const [name, value] of Object.entries(attributes)) {
      if (isOn) place.setAttribute(name, value);
      else place.removeAttribute(name);
    }
    if (!isOn) this.board.layers?.drawn.replaceChildren();
  }

  #showPalette(library) {
    const palette = byId('palette');
    palette.replaceChildren(palette.firstElementChild, ...library.map((block, index) => {
      const input = html('input', { type: 'radio', name: 'block', value: index });
      input.checked = index === this.block;
      input.addEventListener('change', () => this.#choose(index));
      return html('label', { class: 'piece', 'data-block': index },
        input, blockPicture(block), html('span', {}, blockName(block)));
    }));
  }

  #choose(index) {
    if (index >= this.trial.library.length) return;
    this.block = index;
    byId('palette').querySelectorAll('input')[index].checked = true;
    this.#hold(this.column);
  }

  #grab(event) {
    const piece = event.target.closest('.piece');
    if (!this.isOn || piece === null || event.button !== 0) return;
    this.#choose(Number(piece.dataset.block));
    this.held = event.pointerId;
    // A finger would hold on to the palette.
    if (event.target.hasPointerCapture(event.pointerId)) event.target.releasePointerCapture(event.pointerId);
  }

  /** The column of the block under a pointer, whose middle it holds; null beside the board. */
  #columnAt(event) {
    const { width, height } = this.board.trial;
    const point = new DOMPoint(event.clientX, event.clientY)
      .matrixTransform(this.board.svg.getScreenCTM().inverse());
    if (point.x < -0.6 || point.x > width + 0.6 || point.y < -1 || point.y > height + 0.6) return null;
    const [wide] = this.trial.library[this.block];
    return Math.min(Math.max(Math.round(point.x - wide / 2), 0), width - wide);
  }

  #onMove(event) {
    if (this.isOn) this.#hold(this.#columnAt(event));
  }

  #hold(column) {
    this.column = column === null ? null
      : Math.min(column, this.board.trial.width - this.trial.library[this.block][0]);
    this.#draw();
    if (this.column !== null) this.tellHeld([this.trial.sequence, this.block, this.column]);
  }

  #place() {
    return this.trial.places[this.block].find(([column]) => column === this.column);
  }

  #tellHeld([, block, column]) {
    const place = this.#place();
    if (place === undefined) return;
    const { width, height } = this.board.trial;
    const [wide, high] = this.trial.library[block];
    const cells = rectangle([column, place[1]], [column + wide - 1, place[1] + high - 1]);
    this.tell({ region: pictureOf(cells, width, height) });
  }

  #letFall(event) {
    this.#hold(this.#columnAt(event));
    this.#ask();
  }

  #ask() {
    if (this.column !== null) this.wish('place', { block: this.block, column: this.column });
  }

  #onKey(event) {
    if (!this.isOn || event.altKey || event.ctrlKey || event.metaKey) return;
    this.board.place.classList.remove('pointing');
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (step !== undefined) this.#hold(this.column === null ? 0 : Math.max(0, this.column + step));
    else if (event.key === 'Enter' || event.key === ' ') {
      if (this.column === null) this.#hold(0);
      else this.#ask();
    } else if (/^[1-9]$/.test(event.key)) this.#choose(Number(event.key) - 1);
    else return;
    event.preventDefault();
  }

  #draw() {
    const layer = this.board.layers?.drawn;
    if (!layer || !this.isOn) return; // what others draw is in this layer too
    if (this.column === null) {
      layer.replaceChildren();
      this.#say('Choose a block and hold it over the picture.', 'none');
      return;
    }
    const [wide, high] = this.trial.library[this.block];
    const place = this.#place();
    const row = place === undefined ? this.board.trial.height - high : place[1];
    const isGood = place !== undefined && place[2];
    layer.replaceChildren(svg('rect', {
      class: isGood ? 'ghost' : 'ghost bad',
      x: this.column + 0.04, y: this.board.trial.height - row - high + 0.04, width: wide - 0.08, height: high - 0.08, rx: 0.07,
    }));
    const where = `Block ${blockName([wide, high])}, column ${this.column + 1}`;
    if (place === undefined) this.#say(`${where}: it does not fit into the picture there.`, 'bad');
    else if (isGood) this.#say(`${where}: it comes to rest on row ${row + 1}.`, 'good');
    else this.#say(`${where}: it would stick out of the silhouette.`, 'bad');
  }

  #say(text, check) {
    say(byId('preview'), text);
    byId('preview').dataset.check = check;
  }
}
