// The health of the nodes.

import { byId, html, say } from './dom.js';

const lines = new Map();

/** Lines are reused, so that an open one stays open. */
export function showHealth(nodes) {
  if (nodes.length === 0) return;
  const place = byId('health');
  if (place.firstElementChild?.tagName !== 'UL') place.replaceChildren(html('ul', {}));
  const list = place.firstElementChild;
  const names = new Set(nodes.map((node) => node.name));
  for (const [name, line] of lines) {
    if (!names.has(name)) {
      line.item.remove();
      lines.delete(name);
    }
  }
  for (const node of nodes) {
    if (!lines.has(node.name)) {
      const line = newLine(node.name);
      lines.set(node.name, line);
      list.append(line.item);
    }
    update(lines.get(node.name), node);
  }
}

function newLine(name) {
  const level = html('span', { class: 'level' });
  const message = html('span', { class: 'quiet' });
  const values = html('dl');
  const item = html('li', {}, html('details', {},
    html('summary', {}, html('span', { class: 'node-name' }, name), level, message), values));
  return { item, level, message, values, told: '' };
}

function update(line, node) {
  const isSilent = node.level === 'silent';
  if (line.item.dataset.level !== node.level) line.item.dataset.level = node.level;
  say(line.level, isSilent ? `silent for ${node.age} s` : node.level);
  say(line.message, node.message);
  const told = JSON.stringify(node.values);
  if (told === line.told) return;
  line.told = told;
  line.values.replaceChildren(...node.values.flatMap(([key, value]) =>
    [html('dt', {}, key), html('dd', {}, value)]));
}
