// Marking: before a tower is built, a participant marks the parts that its silhouette has.

import { without } from './cells.js';
import { byId, counted } from './dom.js';
import { Drawn } from './scoping.js';

export class Marking extends Drawn {
  constructor(board, wish, tell) {
    super(board, wish, tell, { panel: 'marking', confirm: 'mark', add: 'mark-add' }, 'mark');
    byId('unmark').addEventListener('click', () => {
      if (this.isPressable('unmark')) this.wish('unmark', {});
    });
  }

  static isMeant = (trial) => trial.wishes.includes('mark');

  begin() {
    this.allow('unmark', this.board.built.size > 0);
  }

  words(size, own) {
    if (own) return `A part of ${counted(own, 'cell')}.`;
    if (size) return 'Draw over grey cells that belong to no part yet.';
    const left = without(this.board.target, this.board.built).size;
    return left ? `${counted(left, 'cell')} left that ${left === 1 ? 'belongs' : 'belong'} to no part.` : '';
  }
}
