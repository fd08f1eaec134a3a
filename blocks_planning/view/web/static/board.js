// The tower: silhouette, blocks, the region of the current subgoal, its planned blocks.

import { area, cellsOf, filledBy, outline } from './cells.js';
import { byId, say, svg, whenNew } from './dom.js';

const GUTTER = 1.05;

export class Board {
  constructor(place) {
    this.place = place;
    this.trial = null;
    this.blocks = [];
    this.showRegion = whenNew((shown) => this.#drawRegion(shown));
  }

  /** Show a view: {trial, all_blocks, step}. */
  show(view) {
    const { trial, step } = view;
    if (this.trial === null || JSON.stringify(this.trial) !== JSON.stringify(trial)) {
      this.#begin(trial);
    }
    this.#showBlocks(step.standing.map((index) => view.all_blocks[index]));
    this.showRegion([trial.id, step.region, step.planned, step.top, step.colour]);
    this.#describe(view);
  }

  get built() {
    return filledBy(this.blocks);
  }

  #begin(trial) {
    const { width, height } = trial;
    this.trial = trial;
    this.blocks = [];
    this.target = cellsOf(trial.silhouette);
    const lines = [];
    for (let x = 0; x <= width; x += 1) lines.push(`M${x} 0V${height}`);
    for (let y = 0; y <= height; y += 1) lines.push(`M0 ${y}H${width}`);
    this.labels = [];
    const gutter = svg('g', { class: 'gutter' });
    for (let row = 1; row <= height; row += 1) {
      const y = height - row;
      const label = svg('text', { class: 'row-label', x: -0.54, y: y + 0.5 }, String(row));
      this.labels.push(label);
      gutter.append(
        svg('rect', { class: 'row-chip', x: -0.92, y: y + 0.14, width: 0.76, height: 0.72, rx: 0.16 }),
        label,
        svg('rect', { class: 'row-handle', 'data-rows': row, x: -GUTTER, y, width: GUTTER, height: 1 }),
        svg('path', { class: 'row-guide', d: `M-0.9 ${y}H${width}` }),
      );
    }
    this.layers = Object.fromEntries(
      ['blocks', 'region', 'drawn'].map((name) => [name, svg('g', { class: name })]));
    this.svg = svg('svg', {
      viewBox: `${-GUTTER} -0.15 ${width + GUTTER + 0.15} ${height + 0.35}`,
      'aria-hidden': 'true',
      focusable: 'false',
    },
    svg('defs', {}, hatch('hatch', 'hatch', 0.3), hatch('draw-hatch', 'draw-hatch', 0.25)),
    svg('path', { class: 'grid', d: lines.join('') }),
    svg('path', { class: 'target', d: area(this.target, height) }),
    this.layers.region, this.layers.blocks, this.layers.drawn,
    svg('path', { class: 'ground', d: `M0 ${height}H${width}` }),
    gutter);
    this.place.replaceChildren(this.svg);
  }

  #showBlocks(blocks) {
    const same = (one, other) => JSON.stringify(one) === JSON.stringify(other);
    let kept = 0;
    while (kept < blocks.length && kept < this.blocks.length
      && same(blocks[kept], this.blocks[kept])) kept += 1;
    const layer = this.layers.blocks;
    while (layer.childElementCount > kept) layer.lastChild.remove();
    // A single new block is animated; several at once would be too fast to follow.
    const drops = kept === this.blocks.length && blocks.length === kept + 1;
    for (const block of blocks.slice(kept)) layer.append(this.#block(block, drops));
    this.blocks = blocks;
  }

  #block({ width, height, column, row, subgoal, fill, ink }, drops) {
    const y = this.trial.height - row - height;
    const gap = 0.035;
    return svg('g', { class: drops ? 'block new' : 'block' },
      svg('rect', {
        x: column + gap, y: y + gap, width: width - 2 * gap, height: height - 2 * gap, rx: 0.07, fill,
      }),
      svg('text', { x: column + width / 2, y: y + height / 2, fill: ink }, String(subgoal + 1)));
  }

  #drawRegion([, region, planned, top, colour]) {
    this.labels.forEach((label, index) => label.classList.toggle('current', index + 1 === top));
    this.svg.style.setProperty('--hatch', colour);
    if (region === null) {
      this.layers.region.replaceChildren();
      return;
    }
    const cells = cellsOf(region);
    const edge = outline(cells, this.trial.height);
    this.layers.region.replaceChildren(
      svg('path', { class: 'region', d: area(cells, this.trial.height) }),
      ...planned.map(([w, h, column, row]) => svg('rect', {
        class: 'planned',
        x: column + 0.1, y: this.trial.height - row - h + 0.1, width: w - 0.2, height: h - 0.2,
      })),
      svg('path', { class: 'region-edge', d: edge }),
    );
  }

  /** The picture in words. */
  #describe({ trial, step }) {
    const built = this.built.size;
    const subgoal = step.label === '' ? '' : `; the subgoal is ${step.label}`;
    say(byId('board-text'), `The tower ${trial.stimulus} on a board of ${trial.width} by `
      + `${trial.height} cells: ${built} of ${this.target.size} cells are ${trial.done ?? 'built'}${subgoal}.`);
  }
}

function hatch(id, name, size) {
  return svg('pattern', {
    id, width: size, height: size, patternUnits: 'userSpaceOnUse', patternTransform: 'rotate(45)',
  }, svg('path', { class: name, d: `M0 0V${size}` }));
}
