// SPDX-License-Identifier: GPL-3.0-or-later

import { counts, indexAt } from './data.js';
import { fillFacts, millimetres, phonemeFacts } from './describe.js';
import { closed_mm } from './measure.js';
import { inkOn } from './timeline/lanes.js';

const byId = (id) => document.getElementById(id);
const notice_ms = 6000;

/** Header and footer. @param {import('./data.js').PageData} data */
export function showFacts(data) {
  byId('title').textContent = data.title;
  byId('synthetic').hidden = !data.synthetic;
  const { phonemes, joins, captured } = counts(data.phonemes);
  byId('facts').textContent = [
    `${data.duration.toFixed(2)} s`,
    `${Number(data.fps.toFixed(3))} fps`,
    `${phonemes} sounding phonemes`,
    `${captured} of ${joins} joins between chosen nodes as recorded`,
  ].join(' · ');
  byId('credits').textContent = data.credits.join(' · ');
  byId('credits').title = data.credits.join('\n');
}

/** Says in the viewport what went wrong. */
export function showError(error) {
  const box = byId('error');
  const heading = document.createElement('strong');
  heading.textContent = 'The face cannot be shown';
  const text = document.createElement('p');
  text.textContent = error.message;
  box.replaceChildren(heading, text);
  box.hidden = false;
  byId('busy').hidden = true;
  byId('now').hidden = true;
  byId('view').hidden = true;
  document.querySelector('.views').hidden = true;
}

/** A short word at the bottom of the page, gone after a while. */
export function showNotice(text) {
  const box = byId('notice');
  box.textContent = text;
  box.hidden = false;
  setTimeout(() => { box.hidden = true; }, notice_ms);
}

/** The phoneme under the pointer, beside the pointer. */
export function showTip(detail, data, curve) {
  const tip = byId('tip');
  tip.hidden = detail === null;
  if (detail === null) return;
  const heading = document.createElement('strong');
  heading.textContent = `/${data.phonemes[detail.index].phoneme}/`;
  const list = document.createElement('dl');
  fillFacts(list, phonemeFacts(data, detail.index, curve));
  tip.replaceChildren(heading, list);
  const { width, height } = tip.getBoundingClientRect();
  tip.style.left = `${Math.max(4, Math.min(detail.x + 14, innerWidth - width - 8))}px`;
  tip.style.top = `${Math.max(4, detail.y - height - 14)}px`;
}

/** The card in the viewport: what is said at the playhead, in which emotion, from which node. */
export class NowCard {
  constructor(data, curve) {
    this.data = data;
    this.curve = curve;
    this.index = null;
    byId('now').hidden = data.phonemes.length === 0;
  }

  /** @param {number} time @param {number} index of the phoneme, -1 for none @param {number | null} aperture_mm */
  update(time, index, aperture_mm) {
    if (index !== this.index) {
      this.index = index;
      byId('now-phoneme').textContent = index < 0 ? '–' : this.data.phonemes[index].phoneme;
      this.facts = index < 0 ? [] : phonemeFacts(this.data, index, this.curve);
    }
    const gap = aperture_mm === null ? [] : [
      ['aperture', `${millimetres(aperture_mm)}${aperture_mm < closed_mm ? ' (closed)' : ''}`],
    ];
    fillFacts(byId('now-list'), [...this.facts, ...gap]);
    this.showEmotion(this.data.emotions[indexAt(this.data.emotions, time)]);
  }

  showEmotion(emotion) {
    const chip = byId('now-emotion');
    chip.hidden = emotion === undefined;
    if (emotion === undefined) return;
    chip.textContent = emotion.emotion;
    chip.style.background = emotion.color;
    chip.style.color = inkOn(emotion.color);
  }
}
