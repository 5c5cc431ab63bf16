// SPDX-License-Identifier: GPL-3.0-or-later
//
// Scales and frames of plots.

/** Round values for an axis' ticks. */
function ticks(low, high, count) {
  if (!(high > low)) return [low];
  const raw = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= raw * 0.999);
  const found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + step * 1e-9; ++i) found.push(i * step);
  return found;
}

function tickText(value, step) {
  const decimals = Math.max(0, Math.min(6, -Math.floor(Math.log10(step) + 1e-9)));
  return number(value, decimals);
}

/** The range of values, widened by a share; never empty. */
function range(values, share = 0.06) {
  const known = values.filter(isNumber);
  if (known.length === 0) return [0, 1];
  let low = Infinity;
  let high = -Infinity;
  for (const value of known) {
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  const room = (high - low || Math.abs(high) || 1) * share;
  return [low - room, high + room];
}

function scale([low, high], [from, to]) {
  return (value) => from + ((value - low) / (high - low)) * (to - from);
}

/** Grid and labels of a vertical axis, left of `left`. */
function verticalAxis(svg, y, domain, left, right, count) {
  const marks = ticks(...domain, count);
  const step = marks.length > 1 ? marks[1] - marks[0] : 1;
  for (const mark of marks) {
    svg.append(shape('line', { class: 'grid', x1: left, x2: right, y1: y(mark), y2: y(mark) }));
    svg.append(shape('text', { x: left - 6, y: y(mark) + 4, 'text-anchor': 'end' }, tickText(mark, step)));
  }
}

function horizontalAxis(svg, x, domain, top, bottom, count, text = tickText) {
  const marks = ticks(...domain, count);
  const step = marks.length > 1 ? marks[1] - marks[0] : 1;
  for (const mark of marks) {
    svg.append(shape('line', { class: 'grid', x1: x(mark), x2: x(mark), y1: top, y2: bottom }));
    svg.append(shape('text', { x: x(mark), y: bottom + 13, 'text-anchor': 'middle' }, text(mark, step)));
  }
}

/** A figure whose picture is drawn anew when the page's width changes. */
function figure(place, caption, unit, height, draw) {
  const made = element('figure', {}, element('figcaption', {}, caption, ' ',
    element('span', { class: 'unit' }, unit)));
  const svg = shape('svg', { height });
  made.append(svg);
  place.append(made);
  const redraw = () => {
    const width = Math.max(160, Math.round(made.clientWidth || 300));
    svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
    svg.replaceChildren();
    draw(svg, width, height);
  };
  listeners.push(redraw);
  redraw();
  return { element: made, svg, redraw };
}

/** An SVG path through points, broken where a value is missing. */
function pathOf(values, x, y) {
  let path = '';
  let open = false;
  for (let i = 0; i < values.length; ++i) {
    if (!isNumber(values[i])) {
      open = false;
      continue;
    }
    path += `${open ? 'L' : 'M'}${x(i).toFixed(1)} ${y(values[i]).toFixed(1)}`;
    open = true;
  }
  return path;
}
