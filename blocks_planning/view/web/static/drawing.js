// Drawing a region over the tower: with a mouse, a finger, or the keyboard.

import {
  area, both, joined, keyOf, outline, rectangle, rowsBelow, without,
} from './cells.js';
import { svg } from './dom.js';

export class Drawing {
  /** `board`: where it is drawn; `onChange` gets the cells; `onConfirm`: Enter was pressed. */
  constructor(board, onChange, onConfirm) {
    this.board = board;
    this.onChange = onChange;
    this.onConfirm = onConfirm;
    this.isOn = false;
    this.adds = false;
    this.cells = new Set();
    this.before = new Set();
    this.anchor = null;
    this.cursor = [0, 0];
    const { place } = board;
    place.addEventListener('pointerdown', (event) => this.#onDown(event));
    place.addEventListener('pointermove', (event) => this.#onMove(event));
    place.addEventListener('pointerup', (event) => this.#onUp(event));
    place.addEventListener('pointercancel', () => this.#cancel());
    place.addEventListener('keydown', (event) => this.#onKey(event));
    place.addEventListener('blur', () => place.classList.remove('pointing'));
  }

  turn(isOn) {
    if (this.isOn === isOn) return;
    this.isOn = isOn;
    const { place } = this.board;
    place.classList.toggle('drawing', isOn);
    place.tabIndex = isOn ? 0 : -1;
    if (isOn) {
      place.setAttribute('role', 'application');
      place.setAttribute('aria-label', 'The tower. Arrows move, space begins and ends a rectangle.');
      place.setAttribute('aria-describedby', 'board-text preview');
    } else {
      place.removeAttribute('role');
      place.removeAttribute('aria-label');
      place.removeAttribute('aria-describedby');
      this.clear();
    }
  }

  clear() {
    this.anchor = null;
    this.dragging = null;
    this.#set(new Set());
  }

  /** Draw again, after the board was redrawn. */
  draw() {
    const { height } = this.board.trial;
    const layer = this.board.layers.drawn;
    if (!this.isOn) {
      layer.replaceChildren();
      return;
    }
    const { target, built } = this.board;
    const [column, row] = this.cursor;
    const edge = outline(this.cells, height);
    const useful = without(both(this.cells, target), built);
    layer.replaceChildren(
      svg('path', { class: 'draw-built', d: area(both(this.cells, built), height) }),
      svg('path', { class: 'draw-wash', d: area(useful, height) }),
      svg('path', { class: 'draw-fill', d: area(useful, height) }),
      svg('path', { class: 'draw-off', d: area(without(this.cells, joined(target, built)), height) }),
      svg('path', { class: 'draw-edge-back', d: edge }),
      svg('path', { class: 'draw-edge', d: edge }),
      svg('rect', {
        class: 'cursor', x: column + 0.06, y: height - 1 - row + 0.06, width: 0.88, height: 0.88, rx: 0.1,
      }),
    );
  }

  #set(cells) {
    this.cells = cells;
    if (this.board.trial !== null) this.draw();
    this.onChange(cells);
  }

  #extend(from, to) {
    this.#set(joined(this.before, rectangle(from, to)));
  }

  #begin(event) {
    this.before = this.adds || event.shiftKey ? this.cells : new Set();
  }

  /** The cell under a pointer, the nearest one if it is off the board. */
  #cellAt(event) {
    const { width, height } = this.board.trial;
    const point = new DOMPoint(event.clientX, event.clientY)
      .matrixTransform(this.board.svg.getScreenCTM().inverse());
    const clamp = (value, most) => Math.min(Math.max(Math.floor(value), 0), most);
    return { cell: [clamp(point.x, width - 1), height - 1 - clamp(point.y, height - 1)], x: point.x };
  }

  #onDown(event) {
    if (!this.isOn || event.button !== 0) return;
    const { cell, x } = this.#cellAt(event);
    const { width } = this.board.trial;
    if (x < -1.05 || x > width + 0.6) return;
    event.preventDefault();
    this.board.place.classList.add('pointing');
    this.board.place.focus({ preventScroll: true });
    this.#begin(event);
    this.anchor = null;
    this.cursor = cell;
    if (x < 0) {
      this.#set(joined(this.before, rowsBelow(width, cell[1] + 1)));
      return;
    }
    this.dragging = cell;
    this.board.place.setPointerCapture(event.pointerId);
    this.#extend(cell, cell);
  }

  #onMove(event) {
    if (!this.dragging) return;
    const { cell } = this.#cellAt(event);
    if (keyOf(...cell) === keyOf(...this.cursor)) return;
    this.cursor = cell;
    this.#extend(this.dragging, cell);
  }

  #onUp(event) {
    if (!this.dragging) return;
    this.#onMove(event);
    this.dragging = null;
  }

  #cancel() {
    if (this.dragging) this.clear();
  }

  #onKey(event) {
    if (!this.isOn || event.altKey || event.ctrlKey || event.metaKey) return;
    this.board.place.classList.remove('pointing');
    const { width, height } = this.board.trial;
    const [column, row] = this.cursor;
    const move = {
      ArrowLeft: [column - 1, row], ArrowRight: [column + 1, row],
      ArrowUp: [column, row + 1], ArrowDown: [column, row - 1],
    }[event.key];
    if (move !== undefined) {
      this.cursor = [Math.min(Math.max(move[0], 0), width - 1), Math.min(Math.max(move[1], 0), height - 1)];
      if (this.anchor) this.#extend(this.anchor, this.cursor);
      else this.draw();
    } else if (event.key === ' ') {
      if (this.anchor) this.anchor = null;
      else {
        this.#begin(event);
        this.anchor = this.cursor;
        this.#extend(this.anchor, this.cursor);
      }
    } else if (event.key.toLowerCase() === 'r') {
      this.#begin(event);
      this.anchor = null;
      this.#set(joined(this.before, rowsBelow(width, row + 1)));
    } else if (event.key === 'Enter') this.onConfirm();
    else if (event.key === 'Escape') this.clear();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
