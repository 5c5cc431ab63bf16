// SPDX-License-Identifier: GPL-3.0-or-later

import { joinWords } from './data.js';
import { smallestAperture } from './measure.js';

const headings = ['#', 'Phoneme', 'Start s', 'End s', 'Node', 'Join', 'Observation', 'Emotion', 'Transition', 'Closure', 'Least aperture mm'];
const cost = (value) => (typeof value === 'number' ? value.toPrecision(5) : '');

function row(cells, tag) {
  const line = document.createElement('tr');
  for (const cell of cells) {
    const box = document.createElement(tag);
    box.append(cell);
    line.append(box);
  }
  return line;
}

function seekButton(text, onClick) {
  const button = document.createElement('button');
  button.type = 'button';
  button.textContent = text;
  button.addEventListener('click', onClick);
  return button;
}

/** The phonemes as a table: all that the timeline shows, readable without it. */
export class PhonemeTable {
  /**
   * @param {HTMLElement} parent
   * @param {import('./data.js').PageData} data
   * @param {{rate: number, values_mm: Float32Array} | null} curve
   * @param {(time: number) => void} seek
   */
  constructor(parent, data, curve, seek) {
    const head = document.createElement('thead');
    head.append(row(headings, 'th'));
    for (const cell of head.querySelectorAll('th')) cell.scope = 'col';
    const body = document.createElement('tbody');
    this.rows = data.phonemes.map((phoneme, index) => row([
      String(phoneme.index ?? index),
      seekButton(phoneme.phoneme, () => seek(phoneme.start)),
      phoneme.start.toFixed(3),
      phoneme.end.toFixed(3),
      phoneme.node ?? '',
      joinWords(data.phonemes, index),
      cost(phoneme.cost?.observation),
      cost(phoneme.cost?.emotion),
      cost(phoneme.cost?.transition),
      phoneme.closure ? 'yes' : '',
      curve ? smallestAperture(curve, phoneme.start, phoneme.end).toFixed(2) : '',
    ], 'td'));
    body.append(...this.rows);
    const table = document.createElement('table');
    table.append(head, body);
    parent.replaceChildren(table);
    this.parent = parent;
    this.current = -1;
  }

  setCurrent(index) {
    if (index === this.current) return;
    this.rows[this.current]?.removeAttribute('aria-current');
    this.rows[index]?.setAttribute('aria-current', 'true');
    if (!this.parent.hidden) this.rows[index]?.scrollIntoView({ block: 'nearest' });
    this.current = index;
  }
}
