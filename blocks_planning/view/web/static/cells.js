// Sets of cells. A picture is rows of '#' and '.', top row first; a cell is [column, row], row 0
// being the ground; a set holds `column,row`.

export const keyOf = (column, row) => `${column},${row}`;

export function cellsOf(picture) {
  const found = new Set();
  picture.forEach((text, line) => {
    for (let column = 0; column < text.length; column += 1) {
      if (text[column] === '#') found.add(keyOf(column, picture.length - 1 - line));
    }
  });
  return found;
}

export function pictureOf(cells, width, height) {
  return Array.from({ length: height }, (_, line) =>
    Array.from({ length: width }, (_, column) =>
      cells.has(keyOf(column, height - 1 - line)) ? '#' : '.').join(''));
}

export function filledBy(blocks) {
  const found = new Set();
  for (const block of blocks) {
    for (const cell of rectangle(
      [block.column, block.row],
      [block.column + block.width - 1, block.row + block.height - 1],
    )) found.add(cell);
  }
  return found;
}

/** The cells of a rectangle by two opposite corners. */
export function rectangle([a, b], [c, d]) {
  const found = new Set();
  for (let column = Math.min(a, c); column <= Math.max(a, c); column += 1) {
    for (let row = Math.min(b, d); row <= Math.max(b, d); row += 1) found.add(keyOf(column, row));
  }
  return found;
}

export const rowsBelow = (width, height) => rectangle([0, 0], [width - 1, height - 1]);

export const both = (one, other) => new Set([...one].filter((cell) => other.has(cell)));
export const without = (one, other) => new Set([...one].filter((cell) => !other.has(cell)));
export const joined = (one, other) => new Set([...one, ...other]);

/** The outline of a set, as the path of an SVG on a board of a height. */
export function outline(cells, height) {
  const parts = [];
  for (const cell of cells) {
    const [x, row] = cell.split(',').map(Number);
    const y = height - 1 - row;
    if (!cells.has(keyOf(x, row + 1))) parts.push(`M${x} ${y}h1`);
    if (!cells.has(keyOf(x, row - 1))) parts.push(`M${x} ${y + 1}h1`);
    if (!cells.has(keyOf(x - 1, row))) parts.push(`M${x} ${y}v1`);
    if (!cells.has(keyOf(x + 1, row))) parts.push(`M${x + 1} ${y}v1`);
  }
  return parts.join('');
}

/** All cells of a set, as the path of an SVG. */
export function area(cells, height) {
  return [...cells].map((cell) => {
    const [x, row] = cell.split(',').map(Number);
    return `M${x} ${height - 1 - row}h1v1h-1z`;
  }).join('');
}
