// SPDX-License-Identifier: GPL-3.0-or-later

/** Lanes from top to bottom: least height in px, share of what is left over, label. */
const lanes = {
  ruler: { least: 18, share: 0, label: '' },
  audio: { least: 28, share: 1, label: 'Audio' },
  phonemes: { least: 26, share: 0.15, label: 'Phonemes' },
  sources: { least: 17, share: 0, label: 'Source' },
  emotions: { least: 18, share: 0, label: 'Emotion' },
  aperture: { least: 42, share: 1.3, label: 'Aperture' },
};
const gap = 4;

/**
 * Places the lanes that the data has.
 * @param {number} height px
 * @param {string[]} names of lanes, in order
 * @returns {Record<string, {top: number, height: number, label: string}>}
 */
export function placeLanes(height, names) {
  const least = names.reduce((sum, name) => sum + lanes[name].least + gap, 0);
  const shares = names.reduce((sum, name) => sum + lanes[name].share, 0) || 1;
  const spare = Math.max(0, height - least);
  const placed = {};
  let top = 0;
  for (const name of names) {
    const lane = lanes[name];
    const tall = Math.floor(lane.least + (spare * lane.share) / shares);
    placed[name] = { top, height: tall, label: lane.label };
    top += tall + gap;
  }
  return placed;
}
