// SPDX-License-Identifier: GPL-3.0-or-later

/**
 * What the exporter writes into the page. Times are in seconds.
 * @typedef {{observation: number, emotion: number, transition: number}} Cost
 * @typedef {{index: number, phoneme: string, start: number, end: number, node: string | null,
 *   captured: boolean, cost: Cost | null, closure: boolean}} Phoneme
 * @typedef {{start: number, end: number, emotion: string, color: string}} Emotion
 * @typedef {{mesh: number, primitive: number, vertex: number}} Landmark indices into the glTF file
 * @typedef {{title: string, duration: number, fps: number, glb: string, audio: string | null,
 *   audio_type: string, phonemes: Phoneme[], emotions: Emotion[],
 *   landmarks: Record<string, Landmark>, credits: string[], synthetic: boolean}} PageData
 */

const silence = 'pau';

/** What is wrong with the page's data, in words for its reader. */
export class DataError extends Error {}

const isTime = (value) => typeof value === 'number' && Number.isFinite(value) && value >= 0;
const isSpan = (item) => item !== null && typeof item === 'object' && isTime(item.start) && isTime(item.end);

function parse(text) {
  try {
    return JSON.parse(text);
  } catch (cause) {
    throw new DataError(`The data in this page is not valid JSON (${cause.message}).`, { cause });
  }
}

function listOf(value, field, isItem) {
  if (value === undefined || value === null) return [];
  if (!Array.isArray(value)) throw new DataError(`"${field}" must be a list.`);
  const wrong = value.findIndex((item) => !isItem(item));
  if (wrong >= 0) throw new DataError(`Entry ${wrong} of "${field}" is not as expected.`);
  return value;
}

const landmarksOf = (value) => (value && typeof value === 'object' ? value : {});

/**
 * The page's data with every list present.
 * @param {string} text
 * @returns {PageData}
 * @throws {DataError} where the player cannot go on without the field
 */
export function readPageData(text) {
  const raw = parse(text);
  if (raw === null || typeof raw !== 'object') throw new DataError('The data in this page is not an object.');
  if (!isTime(raw.duration) || raw.duration === 0) throw new DataError('"duration" must be a positive number of seconds.');
  if (!isTime(raw.fps) || raw.fps === 0) throw new DataError('"fps" must be a positive number.');
  return {
    ...raw,
    title: String(raw.title ?? ''),
    glb: raw.glb ?? null,
    audio: raw.audio ?? null,
    audio_type: raw.audio_type ?? 'audio/wav',
    phonemes: listOf(raw.phonemes, 'phonemes', (item) => isSpan(item) && typeof item.phoneme === 'string'),
    emotions: listOf(raw.emotions, 'emotions', (item) => isSpan(item) && typeof item.emotion === 'string'),
    landmarks: landmarksOf(raw.landmarks),
    credits: listOf(raw.credits, 'credits', (item) => typeof item === 'string'),
    synthetic: raw.synthetic === true,
  };
}

/**
 * Index of the span that holds `time`, half-open; the last one holds its own end too. -1 for none.
 * @param {{start: number, end: number}[]} spans in order of time
 * @param {number} time seconds
 * @returns {number}
 */
export function indexAt(spans, time) {
  const last = spans.length - 1;
  if (last >= 0 && time === spans[last].end) return last;
  return spans.findIndex((span) => span.start <= time && time < span.end);
}

/** True where phoneme `index` was put behind one that did not precede it in the recording. */
export function isJoin(phonemes, index) {
  const here = phonemes[index];
  return index > 0 && here.node !== null && phonemes[index - 1].node !== null && !here.captured;
}

/**
 * What the program's own summary counts: phonemes without silence, the joins between chosen nodes
 * (an inner silence has one too), and those of them that are as recorded.
 * @param {Phoneme[]} phonemes
 */
export function counts(phonemes) {
  const chosen = phonemes.filter(({ node }) => node !== null);
  return {
    phonemes: phonemes.filter(({ phoneme }) => phoneme !== silence).length,
    joins: Math.max(0, chosen.length - 1),
    captured: chosen.filter(({ captured }) => captured).length,
  };
}

/** How phoneme `index` came to stand where it is, in words. */
export function joinWords(phonemes, index) {
  const here = phonemes[index];
  if (here.node === null) return 'silence';
  if (here.captured) return 'as recorded';
  return isJoin(phonemes, index) ? 'made here' : 'after silence';
}

/**
 * Stretches of phonemes that follow one another as recorded.
 * @param {Phoneme[]} phonemes
 * @returns {{start: number, end: number, first: string, last: string}[]} node keys first and last
 */
export function capturedRuns(phonemes) {
  const runs = [];
  phonemes.forEach((phoneme, index) => {
    if (phoneme.node === null) return;
    const run = runs[runs.length - 1];
    if (run && phoneme.captured && phonemes[index - 1]?.node === run.last) {
      run.end = phoneme.end;
      run.last = phoneme.node;
    } else {
      runs.push({ start: phoneme.start, end: phoneme.end, first: phoneme.node, last: phoneme.node });
    }
  });
  return runs;
}
