// SPDX-License-Identifier: GPL-3.0-or-later

import { capturedRuns } from '../data.js';
import { placeLanes } from './layout.js';
import {
  drawAperture, drawAudio, drawEmotions, drawPhonemes, drawRuler, drawSources,
} from './lanes.js';

const theme_names = [
  'text', 'muted', 'faint', 'lane', 'wave', 'silence', 'captured', 'joined', 'join', 'closure', 'source', 'curve',
  'limit', 'accent', 'playhead',
];
const zoom_step = 1.5;
const readable_px_per_s = 130;
const most_px_per_s = 4000;

const byId = (id) => document.getElementById(id);

/**
 * The lanes under the face. The native scroll bar moves the window; the sheets stay put inside it.
 * Events: `scrub` (detail: seconds), `hover` (detail: {index, x, y} or null).
 */
export class Timeline extends EventTarget {
  /**
   * @param {import('../data.js').PageData} data
   * @param {import('../sound.js').Sound | null} sound
   * @param {{rate: number, values_mm: Float32Array} | null} curve of the aperture
   */
  constructor(data, sound, curve) {
    super();
    Object.assign(this, { data, sound, curve, time: 0, current: -1, hovered: -1, runs: capturedRuns(data.phonemes) });
    this.scroller = byId('scroller');
    this.spacer = byId('spacer');
    this.sheet = byId('sheet');
    this.cursor = byId('cursor');
    const lane_has = {
      ruler: true,
      audio: sound !== null,
      phonemes: data.phonemes.length > 0,
      sources: this.runs.length > 0,
      emotions: data.emotions.length > 0,
      aperture: curve !== null,
    };
    this.lane_names = Object.keys(lane_has).filter((name) => lane_has[name]);
    this.px_per_s = null;
    this.listen();
    new ResizeObserver(() => this.resize()).observe(this.scroller);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.draw());
    this.resize();
  }

  get fit_px_per_s() { return (this.width - 2) / this.data.duration; }
  get from() { return this.scroller.scrollLeft / this.px_per_s; }
  get to() { return this.from + this.width / this.px_per_s; }
  x(time) { return (time - this.from) * this.px_per_s; }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.scroller;
    if (width === 0 || height === 0) return;
    const fitted = this.px_per_s === null || this.px_per_s === this.fit_px_per_s;
    this.width = width;
    this.lanes = placeLanes(height, this.lane_names);
    const ratio = Math.min(window.devicePixelRatio, 2);
    for (const canvas of [this.sheet, this.cursor]) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
      canvas.style.width = `${width}px`;
      canvas.style.height = `${height}px`;
      canvas.getContext('2d').setTransform(ratio, 0, 0, ratio, 0, 0);
    }
    this.height = height;
    this.nameLanes();
    this.setScale(fitted && this.px_per_s !== null ? this.fit_px_per_s : this.px_per_s ?? readable_px_per_s, 0);
  }

  nameLanes() {
    byId('lane-names').replaceChildren(...Object.values(this.lanes).map(({ top, height, label }) => {
      const name = document.createElement('span');
      name.textContent = label;
      name.style.top = `${top}px`;
      name.style.height = `${height}px`;
      return name;
    }));
  }

  /** Changes the scale and keeps the time under `anchor_px` where it is. */
  setScale(px_per_s, anchor_px) {
    const anchor_s = this.px_per_s ? this.from + anchor_px / this.px_per_s : 0;
    this.px_per_s = Math.min(Math.max(px_per_s, this.fit_px_per_s), most_px_per_s);
    this.spacer.style.width = `${Math.max(this.width, this.data.duration * this.px_per_s)}px`;
    this.scroller.scrollLeft = anchor_s * this.px_per_s - anchor_px;
    this.draw();
  }

  /** @param {number} steps in (positive) or out, about the playhead where it shows */
  zoom(steps, anchor_px = this.time >= this.from && this.time <= this.to ? this.x(this.time) : this.width / 2) {
    this.setScale(this.px_per_s * zoom_step ** steps, anchor_px);
  }

  fit() { this.setScale(0, 0); }

  /** Moves the playhead; turns the page when it leaves the window. */
  setTime(time, current) {
    this.time = time;
    const out = time < this.from || time > this.to;
    if (out) this.scroller.scrollLeft = (time * this.px_per_s) - 0.1 * this.width;
    if (out || current !== this.current) {
      this.current = current;
      this.draw();
    } else {
      this.drawCursor();
    }
  }

  listen() {
    this.scroller.addEventListener('scroll', () => this.draw());
    this.scroller.addEventListener('wheel', (event) => {
      if (!event.ctrlKey) return;
      event.preventDefault();
      this.zoom(-Math.sign(event.deltaY), event.clientX - this.sheet.getBoundingClientRect().left);
    }, { passive: false });
    this.cursor.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      this.cursor.setPointerCapture(event.pointerId);
      const index = this.phonemeAt(event);
      this.scrub(index < 0 ? this.timeAt(event) : this.data.phonemes[index].start);
    });
    this.cursor.addEventListener('pointermove', (event) => {
      if (event.buttons & 1) this.scrub(this.timeAt(event));
      this.hover(this.phonemeAt(event), event);
    });
    this.cursor.addEventListener('pointerleave', (event) => this.hover(-1, event));
  }

  timeAt(event) {
    const time = this.from + (event.clientX - this.sheet.getBoundingClientRect().left) / this.px_per_s;
    return Math.min(Math.max(time, 0), this.data.duration);
  }

  phonemeAt(event) {
    const y = event.clientY - this.sheet.getBoundingClientRect().top;
    const on = ['phonemes', 'sources'].some((name) => {
      const lane = this.lanes[name];
      return lane && y >= lane.top && y < lane.top + lane.height;
    });
    const time = this.timeAt(event);
    return on ? this.data.phonemes.findIndex(({ start, end }) => start <= time && time < end) : -1;
  }

  scrub(time) { this.dispatchEvent(new CustomEvent('scrub', { detail: time })); }

  hover(index, { clientX: x, clientY: y }) {
    this.dispatchEvent(new CustomEvent('hover', { detail: index < 0 ? null : { index, x, y } }));
    if (index === this.hovered) return;
    this.hovered = index;
    this.draw();
  }

  theme() {
    const style = getComputedStyle(document.documentElement);
    const theme = Object.fromEntries(theme_names.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
    return { ...theme, closureBand: style.getPropertyValue('--closure-band').trim() };
  }

  draw() {
    if (!this.lanes) return;
    const context = this.sheet.getContext('2d');
    const { data, width, from, to } = this;
    const theme = this.theme();
    this.playhead_colour = theme.playhead;
    context.clearRect(0, 0, width, this.height);
    const pen = (name) => ({ context, lane: this.lanes[name], x: (time) => this.x(time), width, from, to, theme });
    const draw_lane = {
      ruler: () => drawRuler(pen('ruler')),
      audio: () => drawAudio(pen('audio'), this.sound.peaks),
      phonemes: () => drawPhonemes(pen('phonemes'), data.phonemes, this),
      sources: () => drawSources(pen('sources'), this.runs),
      emotions: () => drawEmotions(pen('emotions'), data.emotions),
      aperture: () => drawAperture(pen('aperture'), this.curve, data.phonemes),
    };
    for (const name of this.lane_names) draw_lane[name]();
    this.drawCursor();
  }

  drawCursor() {
    if (!this.lanes) return;
    const context = this.cursor.getContext('2d');
    context.clearRect(0, 0, this.width, this.height);
    const x = Math.round(this.x(this.time));
    context.fillStyle = this.playhead_colour;
    context.fillRect(x - 1, 0, 2, this.height);
    context.beginPath();
    context.moveTo(x - 6, 0);
    context.lineTo(x + 6, 0);
    context.lineTo(x, 9);
    context.fill();
  }
}
