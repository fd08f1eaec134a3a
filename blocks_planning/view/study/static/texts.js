// Texts of the study: the server sends them as data; every word is inserted as text.

import { html } from './dom.js';

const words = (line) => line.map(([tag, text]) => (tag === '' ? text : html(tag, {}, text)));

export function elementsOf(blocks) {
  return blocks.map(({ tag, lines }) => (tag === 'ul' || tag === 'ol'
    ? html(tag, {}, ...lines.map((line) => html('li', {}, ...words(line))))
    : html(tag, {}, ...words(lines[0]))));
}
