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

/** A part of the tower is drawn, and asked for with a button or Enter. */
export class Drawn {
  /**
   * `wish` asks for something: (word, fields); `tell` notes what is drawn; `ids`: of the panel, of
   * its button and of its box for adding; `word` is what is asked for.
   */
  constructor(board, wish, tell, ids, word) {
    Object.assign(this, { board, wish, ids, word });
    this.drawing = new Drawing(board, () => this.preview(), () => this.confirm());
    byId(ids.confirm).addEventListener('click', () => this.confirm());
    byId(ids.add).addEventListener('change', (event) => {
      this.drawing.adds = event.target.checked;
    });
    const drawn = () => {
      if (this.drawing.isOn && this.drawing.cells.size > 0) tell(this.region());
    };
    board.place.addEventListener('pointerup', drawn);
    board.place.addEventListener('keyup', (event) => {
      if (event.key === ' ' || event.key.toLowerCase() === 'r') drawn();
    });
  }

  /** Show the turn of a trial; `isNew`: the state is another one. */
  turn(isOn, trial, isNew) {
    byId(this.ids.panel).hidden = !isOn;
    this.drawing.turn(isOn);
    if (!isOn) return;
    this.begin(trial);
    if (isNew) this.drawing.clear();
    else this.drawing.draw();
    this.preview();
  }

  region() {
    const { width, height } = this.board.trial;
    return { region: pictureOf(this.drawing.cells, width, height) };
  }

  isPressable(id) {
    return byId(id).getAttribute('aria-disabled') !== 'true';
  }

  /** A disabled button would lose the focus of who uses the keyboard. */
  allow(id, isPressable) {
    byId(id).setAttribute('aria-disabled', String(!isPressable));
  }

  preview() {
    if (!this.drawing.isOn || this.board.trial === null) return;
    const { cells } = this.drawing;
    const useful = without(both(cells, this.board.target), this.board.built).size;
    const outside = without(without(cells, this.board.target), this.board.built).size;
    say(byId('preview'), this.words(cells.size, useful, outside));
    byId('preview').dataset.check = cells.size && !useful ? 'bad' : cells.size ? 'good' : 'none';
    this.allow(this.ids.confirm, useful > 0);
  }

  confirm() {
    if (this.drawing.isOn && this.isPressable(this.ids.confirm)) this.wish(this.word, this.region());
  }
}

export class Scoping extends Drawn {
  constructor(board, wish, tell) {
    super(board, wish, tell, { panel: 'scoping', confirm: 'confirm', add: 'add' }, 'build');
    this.showBlocks = whenNew((library) => byId('blocks').replaceChildren(
      ...library.map((block) => blockPicture(block, blockName(block)))));
    byId('withdraw').addEventListener('click', () => {
      if (this.isPressable('withdraw')) this.wish('withdrawn', this.region());
    });
  }

  static isMeant = (trial) => trial.wishes.includes('build');

  begin(trial) {
    this.showBlocks(trial.library);
  }

  words(size, toFill, outside) {
    this.allow('withdraw', size > 0);
    if (toFill) return `${counted(toFill, 'cell')} to fill${outside ? ` (${outside} outside, left out)` : ''}.`;
    if (size && outside === size) return 'This is outside the silhouette: draw over the grey cells.';
    if (size) return 'All of it is built already: draw over cells that are still empty.';
    return 'Nothing is drawn yet.';
  }
}
