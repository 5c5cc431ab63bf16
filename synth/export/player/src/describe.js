// SPDX-License-Identifier: GPL-3.0-or-later

import { joinWords } from './data.js';
import { closed_mm, smallestAperture } from './measure.js';

const number = (value) => (typeof value === 'number' ? value.toPrecision(4) : '–');

export const seconds = (time) => `${time.toFixed(3)} s`;
export const millimetres = (value) => `${value.toFixed(2)} mm`;

/**
 * What there is to say of one phoneme, in order, as [name, value].
 * @param {import('./data.js').PageData} data
 * @param {number} index
 * @param {{rate: number, values_mm: Float32Array} | null} curve
 * @returns {[string, string][]}
 */
export function phonemeFacts({ phonemes }, index, curve) {
  const phoneme = phonemes[index];
  const facts = [
    ['time', `${phoneme.start.toFixed(3)} – ${seconds(phoneme.end)}`],
    ['node', phoneme.node ?? 'none (silence)'],
  ];
  if (phoneme.node !== null) {
    facts.push(['join', joinWords(phonemes, index)]);
    if (phoneme.cost) {
      facts.push(
        ['observation', number(phoneme.cost.observation)],
        ['emotion', number(phoneme.cost.emotion)],
        ['transition', number(phoneme.cost.transition)],
      );
    }
  }
  if (phoneme.closure && curve) {
    const least = smallestAperture(curve, phoneme.start, phoneme.end);
    facts.push(['closure', `${least < closed_mm ? 'met' : 'missed'}, least ${millimetres(least)}`]);
  }
  return facts;
}

/** Fills a <dl>. @param {HTMLElement} list @param {[string, string][]} facts */
export function fillFacts(list, facts) {
  list.replaceChildren(...facts.flatMap(([name, value]) => {
    const term = document.createElement('dt');
    const detail = document.createElement('dd');
    term.textContent = name;
    detail.textContent = value;
    return [term, detail];
  }));
}
