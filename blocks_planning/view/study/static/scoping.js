// Scoping: a participant draws the part that is built next.

import { both, pictureOf, without } from './cells.js';
import { byId, counted, say, svg, whenNew } from './dom.js';
import { Drawing } from './drawing.js';

const UNIT = 9;

export function blockPicture([width, height], name) {
  const label = name ? { role: 'img', 'aria-label': name } : { 'aria-hidden': 'true' };
  return svg('svg', {
    width: width * UNIT + 2, height: height * UNIT + 2, ...label,
  }, svg('rect', { x: 1, y: 1, width: width * UNIT, height: height * UNIT }));
}

export const blockName = ([width, height]) => `${width} wide, ${height} high`;

export class Scoping {
  /** `wish` asks for something: (word, fields); `tell` notes what is drawn. */
  constructor(board, wish, tell) {
    this.board = board;
    this.wish = wish;
    this.drawing = new Drawing(board, () => this.#preview(), () => this.#confirm());
    this.showBlocks = whenNew((library) => byId('blocks').replaceChildren(
      ...library.map((block) => blockPicture(block, blockName(block)))));
    byId('confirm').addEventListener('click', () => this.#confirm());
    byId('withdraw').addEventListener('click', () => {
      if (this.#isPressable('withdraw')) this.wish('withdrawn', this.#region());
    });
    byId('add').addEventListener('change', (event) => {
      this.drawing.adds = event.target.checked;
    });
    const drawn = () => {
      if (this.drawing.isOn && this.drawing.cells.size > 0) tell(this.#region());
    };
    board.place.addEventListener('pointerup', drawn);
    board.place.addEventListener('keyup', (event) => {
      if (event.key === ' ' || event.key.toLowerCase() === 'r') drawn();
    });
  }

  static isMeant = (trial) => trial.wishes.includes('build');

  /** Show the turn of a trial; `isNew`: the state is another one. */
  turn(isOn, trial, isNew) {
    byId('scoping').hidden = !isOn;
    this.drawing.turn(isOn);
    if (!isOn) return;
    this.showBlocks(trial.library);
    if (isNew) this.drawing.clear();
    else this.drawing.draw();
    this.#preview();
  }

  #region() {
    const { width, height } = this.board.trial;
    return { region: pictureOf(this.drawing.cells, width, height) };
  }

  #toFill() {
    return without(both(this.drawing.cells, this.board.target), this.board.built).size;
  }

  #isPressable(id) {
    return byId(id).getAttribute('aria-disabled') !== 'true';
  }

  #preview() {
    if (!this.drawing.isOn || this.board.trial === null) return;
    const { size } = this.drawing.cells;
    const toFill = this.#toFill();
    const outside = without(without(this.drawing.cells, this.board.target), this.board.built).size;
    let text = 'Nothing is drawn yet.';
    if (toFill) text = `${counted(toFill, 'cell')} to fill${outside ? ` (${outside} outside, left out)` : ''}.`;
    else if (size && outside === size) text = 'This is outside the silhouette: draw over the grey cells.';
    else if (size) text = 'All of it is built already: draw over cells that are still empty.';
    say(byId('preview'), text);
    byId('preview').dataset.check = size && !toFill ? 'bad' : size ? 'good' : 'none';
    // A disabled button would lose the focus of who uses the keyboard.
    byId('confirm').setAttribute('aria-disabled', String(toFill === 0));
    byId('withdraw').setAttribute('aria-disabled', String(size === 0));
  }

  #confirm() {
    if (this.drawing.isOn && this.#isPressable('confirm')) this.wish('build', this.#region());
  }
}
