// SPDX-License-Identifier: GPL-3.0-or-later

import { bytesFromBase64 } from './bytes.js';

const bins_per_second = 1000;
const metadata_timeout_ms = 10000;

/** Smallest and largest sample of every millisecond: what the waveform is drawn from. */
function envelope(buffer) {
  const count = Math.max(1, Math.ceil(buffer.duration * bins_per_second));
  const low = new Float32Array(count);
  const high = new Float32Array(count);
  for (let channel = 0; channel < buffer.numberOfChannels; ++channel) {
    const samples = buffer.getChannelData(channel);
    for (let i = 0; i < samples.length; ++i) {
      const bin = Math.min(count - 1, Math.floor((i / buffer.sampleRate) * bins_per_second));
      if (samples[i] < low[bin]) low[bin] = samples[i];
      if (samples[i] > high[bin]) high[bin] = samples[i];
    }
  }
  const loudest = high.reduce((most, value, bin) => Math.max(most, value, -low[bin]), 1e-3);
  return { low, high, loudest, bins_per_second };
}

function metadata(element) {
  return new Promise((resolve, reject) => {
    const late = setTimeout(() => reject(new Error('the browser did not load it')), metadata_timeout_ms);
    element.addEventListener('loadedmetadata', () => { clearTimeout(late); resolve(); }, { once: true });
    element.addEventListener('error', () => {
      clearTimeout(late);
      reject(new Error(element.error?.message || 'the browser cannot decode it'));
    }, { once: true });
  });
}

/** The audio of the page: an element that plays, and the envelope of its samples. */
export class Sound {
  /**
   * @param {string} base64
   * @param {string} type MIME type
   * @returns {Promise<Sound>} rejected where the browser cannot decode the bytes
   */
  static async load(base64, type) {
    const bytes = bytesFromBase64(base64);
    const element = new Audio();
    element.preload = 'auto';
    element.preservesPitch = true;
    const loaded = metadata(element);
    element.src = URL.createObjectURL(new Blob([bytes], { type }));
    await loaded;
    const decoder = new OfflineAudioContext(1, 1, 44100);
    return new Sound(element, envelope(await decoder.decodeAudioData(bytes.buffer)));
  }

  constructor(element, peaks) {
    this.element = element;
    this.peaks = peaks;
  }

  get duration() { return this.element.duration; }
  get time() { return this.element.currentTime; }
  get running() { return !this.element.paused && !this.element.ended; }

  /** Starts at `time`; silent where the audio has ended by then. Rejected where the browser refuses. */
  async play(time, rate) {
    if (time >= this.duration) return;
    this.element.currentTime = time;
    this.element.playbackRate = rate;
    await this.element.play();
  }

  pause() { this.element.pause(); }
  set rate(rate) { this.element.playbackRate = rate; }
  set muted(muted) { this.element.muted = muted; }
}
