// SPDX-License-Identifier: GPL-3.0-or-later
//
// What every part of the page uses: the report, elements, numbers, colours.

const report = JSON.parse(document.getElementById('phonomime-data').textContent);
const byId = (id) => document.getElementById(id);
const measures = new Map(report.measures.map((measure) => [measure.id, measure]));
const mainMethod = report.methods.find((method) => method.id === report.main_method);
const methodIndex = new Map(report.methods.map((method, index) => [method.id, index]));
const methodColor = (id) => `var(--m${(methodIndex.get(id) ?? 7) % 8})`;
const listeners = []; // called when the page's width changes

/** An element with attributes and children; a child may be text. */
function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === 'style') made.style.cssText = value;
    else if (value !== null && value !== false) made.setAttribute(key, value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

function shape(name, attributes = {}, text = null) {
  const made = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === 'style') made.style.cssText = value;
    else made.setAttribute(key, value);
  }
  if (text !== null) made.textContent = text;
  return made;
}

const isNumber = (value) => typeof value === 'number' && Number.isFinite(value);
const prettyUnit = (unit) => unit.replace('^2', '²').replace('^3', '³');
const unitText = (measure) => (measure.unit === '1' ? '' : prettyUnit(measure.unit));

function number(value, decimals) {
  if (!isNumber(value)) return '–';
  const text = value.toFixed(decimals);
  return (Number(text) === 0 ? text.replace('-', '') : text).replace('-', '−');
}

/** How far a value is from what is good: smaller is better; null where nothing is. */
function badness(measure, value) {
  if (!isNumber(value)) return null;
  if (measure.aim === 'small') return value;
  if (measure.aim === 'large') return -value;
  if (measure.aim === 'near 1') return Math.abs(value - 1);
  return measure.aim === 'near 0' ? Math.abs(value) : null;
}

/** The tip that follows the pointer over a shape or an element. */
function tip(target, text) {
  target.addEventListener('pointermove', (event) => {
    const box = byId('tip');
    box.textContent = typeof text === 'function' ? text(event) : text;
    box.hidden = box.textContent === '';
    const right = event.clientX + 340 > window.innerWidth;
    box.style.left = right ? 'auto' : `${event.clientX + 14}px`;
    box.style.right = right ? `${window.innerWidth - event.clientX + 14}px` : 'auto';
    box.style.top = `${event.clientY + 14}px`;
  });
  target.addEventListener('pointerleave', () => { byId('tip').hidden = true; });
}

function fillSelect(select, options, chosen) {
  select.replaceChildren(...options.map(([value, text]) => element('option', { value }, text)));
  if (chosen !== undefined) select.value = chosen;
}

const methodOptions = () => report.methods.map((method) => [method.id, method.id]);

function legend(place, entries) {
  place.replaceChildren(...entries.map(([text, color]) =>
    element('span', {}, element('i', { class: 'dot', style: `color:${color}` }), text)));
}

function show(id) {
  byId(id).hidden = false;
}

/** Head row of a table; a cell is text or a measure. */
function tableHead(cells) {
  const row = element('tr');
  for (const cell of cells) {
    const head = element('th', { scope: 'col' }, typeof cell === 'string' ? cell : cell.text);
    if (cell.measure) {
      head.append(element('span', { class: 'unit' }, unitText(cell.measure) || '\u00a0'));
      tip(head, `${cell.measure.label}\n${cell.measure.formula}\n(${cell.measure.mask})`);
    }
    row.append(head);
  }
  return element('thead', {}, row);
}
