// The planning cost so far: numbers, and steps on a logarithmic scale.

import { byId, html, say, svg, whenNew, whole } from './dom.js';

const HEIGHT = 180;
const ROOM = { left: 46, right: 14, top: 10, bottom: 38 };

export class Costs {
  constructor() {
    this.place = byId('curve');
    this.draw = whenNew((shown) => this.#draw(shown));
    new ResizeObserver(() => this.shown && this.show(...this.shown)).observe(this.place);
  }

  /** `curve`: [sequence, action, subgoal] after each decision; `step.sequence` is the latest. */
  show(step, curve) {
    this.shown = [step, curve];
    for (const name of ['action', 'subgoal']) {
      const cost = step[`${name}_cost`];
      const text = cost === undefined ? '–' : whole(cost);
      const place = byId(`cost-${name}`);
      if (place.dataset.shown !== text) {
        place.dataset.shown = text;
        place.replaceChildren(text, ' ', html('small', {}, cost === 1 ? 'state' : 'states'));
      }
    }
    this.draw([Math.round(this.place.clientWidth), step.sequence, curve]);
  }

  #draw([width, blocks, curve]) {
    if (width < 80) return;
    const most = Math.max(10, ...curve.flatMap(([, action, subgoal]) => [action, subgoal]));
    const decades = Math.ceil(Math.log10(most));
    const last = Math.max(4, blocks);
    const x = (placed) => ROOM.left + (placed / last) * (width - ROOM.left - ROOM.right);
    const y = (cost) => HEIGHT - ROOM.bottom
      - (Math.log10(Math.max(1, cost)) / decades) * (HEIGHT - ROOM.top - ROOM.bottom);
    const ticks = [];
    for (let power = 0; power <= decades; power += decades > 4 ? 2 : 1) {
      const at = y(10 ** power);
      ticks.push(svg('path', { class: 'tick', d: `M${ROOM.left} ${at}H${width - ROOM.right}` }),
        svg('text', { x: ROOM.left - 6, y: at + 4, 'text-anchor': 'end' }, short(10 ** power)));
    }
    const every = Math.max(1, Math.ceil(last / 8));
    for (let placed = 0; placed <= last; placed += every) {
      ticks.push(svg('text', { x: x(placed), y: HEIGHT - ROOM.bottom + 15, 'text-anchor': 'middle' }, String(placed)));
    }
    ticks.push(svg('text', { x: width - ROOM.right, y: HEIGHT - 5, 'text-anchor': 'end' }, 'orders'));
    const lines = ['action', 'subgoal'].flatMap((name, index) => {
      const points = curve.map((point) => [x(point[0]), y(point[index + 1])]);
      if (points.length === 0) return [];
      const path = points.map(([a, b], at) => (at === 0 ? `M${a} ${b}` : `H${a}V${b}`)).join('');
      return [svg('path', { class: `line ${name}`, d: `${path}H${x(blocks)}` }),
        ...points.map(([a, b]) => (name === 'action'
          ? svg('circle', { class: 'mark action', cx: a, cy: b, r: 3.4 })
          : svg('rect', { class: 'mark subgoal', x: a - 3, y: b - 3, width: 6, height: 6 })))];
    });
    const drawing = this.place.firstElementChild ?? svg('svg', { role: 'img' });
    drawing.setAttribute('viewBox', `0 0 ${width} ${HEIGHT}`);
    drawing.setAttribute('aria-label', 'Planning cost in states evaluated, on a logarithmic scale, over the orders');
    drawing.replaceChildren(...ticks, ...lines);
    if (!drawing.isConnected) this.place.append(drawing);
  }
}

function short(number) {
  if (number >= 1e6) return `${number / 1e6}M`;
  return number >= 1e3 ? `${number / 1e3}k` : String(number);
}

export function hideCosts(hidden) {
  byId('costs').hidden = hidden;
  byId('decision').hidden = hidden;
}

/** Whether a planner is weighing what comes next. */
export function showDeciding(isDeciding) {
  say(byId('deciding'), isDeciding ? 'deciding…' : '');
}
