// The last decision: a bar for each candidate.

import { byId, counted, html, say, svg, whenNew, whole } from './dom.js';

const WIDTH = 200;
const HEIGHT = 18;

/** `shown`: {decision}; the decision is null before the first. */
export const showDecision = whenNew((shown) => {
  const { decision } = shown;
  const place = byId('candidates');
  const note = byId('decision-note');
  if (decision === null) {
    place.replaceChildren();
    say(note, 'Nothing has been decided yet.');
    return;
  }
  const { candidates, total } = decision;
  place.replaceChildren(table(candidates), ...legend(candidates));
  const more = total > candidates.length ? `, the best ${candidates.length} are shown` : '';
  const none = candidates.some((one) => one.chosen) ? '' : ' None could be built: the planner gives up.';
  say(note, `${counted(total, 'candidate')}${more}; weighing cost ${counted(decision.cost, 'state')}.${none}`);
});

function table(candidates) {
  const weighed = candidates.some((one) => one.value !== null);
  const most = Math.max(1, ...candidates.map((one) => one.cells));
  const lowest = Math.min(0, ...candidates.map((one) => one.value ?? 0));
  const least = Math.max(lowest, -most / 2); // what lies lower is cut off
  const dearest = Math.max(10, ...candidates.map((one) => one.cost));
  const head = html('tr', {},
    html('th', { scope: 'col' }, 'region'),
    html('th', { scope: 'col', class: 'number', title: 'r: cells that it adds' }, 'cells'),
    html('th', { scope: 'col', class: 'number wide', title: 'c: states evaluated' }, 'cost'),
    weighed ? html('th', { scope: 'col', class: 'number', title: 'V = r − λc' }, 'value')
      : html('th', { scope: 'col' }, 'answer'),
    html('th', { scope: 'col', class: 'bar' }, weighed ? 'cells − λ cost' : 'cost, log scale'));
  const rows = candidates.map((one) => html('tr', { 'data-chosen': one.chosen },
    html('th', { scope: 'row' }, label(one),
      one.chosen ? html('span', { class: 'visually-hidden' }, ' (chosen)') : null),
    html('td', { class: 'number' }, whole(one.cells)),
    html('td', { class: 'number wide' }, whole(one.cost)),
    weighed ? html('td', { class: 'number' }, one.value === null ? '–' : worth(one.value))
      : html('td', {}, one.status),
    html('td', { class: 'bar' },
      weighed ? tradeOff(one, most, least) : costBar(one, dearest))));
  return html('table', {}, html('thead', {}, head), html('tbody', {}, ...rows));
}

function label({ label: text, chosen }) {
  return `${chosen ? '▶ ' : ''}${text}`;
}

export function worth(value) {
  return Math.abs(value) < 1000 ? value.toFixed(2) : whole(Math.round(value));
}

function tradeOff(one, most, least) {
  const x = (value) => ((Math.max(least, value) - least) / (most - least)) * (WIDTH - 4) + 2;
  const bar = (name, from, to, inset) => svg('rect', {
    class: name, x: Math.min(x(from), x(to)), y: inset, width: Math.abs(x(to) - x(from)),
    height: HEIGHT - 2 * inset,
  });
  const drawn = one.value === null
    ? [bar('bar-none', 0, one.cells, 5)]
    : [
      bar('bar-cost', one.value, one.cells, 4),
      bar(one.value < 0 ? 'bar-loss' : 'bar-value', 0, one.value, 2),
    ];
  const text = one.value === null
    ? one.status
    : `value ${worth(one.value)}: ${one.cells} cells, less ${worth(one.cells - one.value)}`;
  return chart(text, ...drawn,
    svg('path', { class: 'bar-zero', d: `M${x(0)} 0V${HEIGHT}` }));
}

function costBar(one, dearest) {
  const width = (Math.log10(Math.max(1, one.cost)) / Math.log10(dearest)) * (WIDTH - 4);
  return chart(`${counted(one.cost, 'state')}, ${one.status}`,
    svg('rect', {
      class: one.status === 'solved' ? 'bar-value' : 'bar-none', x: 2, y: 3, width, height: HEIGHT - 6,
    }));
}

function chart(text, ...children) {
  return svg('svg', {
    viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: 'none', role: 'img', 'aria-label': text,
  }, svg('title', {}, text),
  ...children);
}

function legend(candidates) {
  if (!candidates.some((one) => one.value !== null)) return [];
  const sample = (name) => svg('svg', { viewBox: '0 0 22 12', 'aria-hidden': 'true' },
    svg('rect', { class: name, x: 1, y: 1, width: 20, height: 10 }));
  return [html('p', { class: 'legend' },
    html('span', {}, sample('bar-value'), 'value'),
    candidates.some((one) => one.value !== null && one.value < 0)
      ? html('span', {}, sample('bar-loss'), 'value below zero') : null,
    html('span', {}, sample('bar-cost'), 'taken off: λ × cost'),
    candidates.some((one) => one.value === null)
      ? html('span', {}, sample('bar-none'), 'not solved') : null)];
}
