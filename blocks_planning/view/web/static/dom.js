// Creation of elements. Texts are inserted as text, never as markup.

const SVG = 'http://www.w3.org/2000/svg';

function make(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    element.setAttribute(name, value === true ? '' : String(value));
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

export function html(tag, attributes = {}, ...children) {
  return make(document.createElement(tag), attributes, children);
}

export function svg(tag, attributes = {}, ...children) {
  return make(document.createElementNS(SVG, tag), attributes, children);
}

export function byId(id) {
  return document.getElementById(id);
}

/** Set a text, if it has changed. */
export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** The name of a tower; of a file path only the end. */
export function nameOf(stimulus) {
  return stimulus.startsWith('/') ? stimulus.split('/').slice(-2).join('/') : stimulus;
}

export function whole(number) {
  return number.toLocaleString('en-US');
}

export function counted(count, noun) {
  return `${whole(count)} ${noun}${count === 1 ? '' : 's'}`;
}

/** Call a function with a value only when the value differs from that of the last call. */
export function whenNew(call) {
  let last;
  return (value) => {
    const text = JSON.stringify(value);
    if (text === last) return;
    last = text;
    call(value);
  };
}
