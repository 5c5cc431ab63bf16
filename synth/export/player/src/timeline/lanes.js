// SPDX-License-Identifier: GPL-3.0-or-later

import { isJoin } from '../data.js';
import { closed_mm } from '../measure.js';

/**
 * What every lane draws with: the 2-D context, the lane's place, seconds to px, theme colours and
 * the visible span.
 * @typedef {{context: CanvasRenderingContext2D, lane: {top: number, height: number},
 *   x: (time: number) => number, width: number, from: number, to: number,
 *   theme: Record<string, string>}} Pen
 */

const font = (size, weight = 400) => `${weight} ${size}px system-ui, "Segoe UI", Roboto, sans-serif`;
const seen = (span, { from, to }) => span.end >= from && span.start <= to;

function label(context, text, left, right, y) {
  const room = right - left - 4;
  if (room < 5 || context.measureText(text).width > room) return;
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.fillText(text, (left + right) / 2, y);
}

/** The first of `texts` that fits, else the last one cut short, from the left edge of what shows. */
function leftLabel(context, texts, left, right, y) {
  const start = Math.max(left, 0) + 5;
  const fits = (text) => context.measureText(text).width <= right - start - 3;
  const last = texts[texts.length - 1];
  let shown = texts.find(fits) ?? last;
  for (let length = last.length - 1; length > 2 && !fits(shown); --length) shown = `${last.slice(0, length)}…`;
  if (!fits(shown)) return;
  context.textAlign = 'left';
  context.textBaseline = 'middle';
  context.fillText(shown, start, y);
}

function tickStep(seconds_per_px) {
  const wanted = 80 * seconds_per_px;
  return [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 30, 60].find((step) => step >= wanted) ?? 120;
}

export function drawRuler({ context, lane, x, width, from, to, theme }) {
  const step = tickStep((to - from) / width);
  const digits = step < 0.1 ? 2 : step < 1 ? 1 : 0;
  context.font = font(10.5);
  context.textAlign = 'left';
  context.textBaseline = 'middle';
  for (let k = Math.floor(from / step); k * step <= to; ++k) {
    const left = Math.round(x(k * step)) + 0.5;
    context.fillStyle = theme.faint;
    context.fillRect(left - 0.5, lane.top, 1, lane.height);
    context.fillStyle = theme.muted;
    context.fillText(`${(k * step).toFixed(digits)} s`, left + 4, lane.top + lane.height / 2);
    context.fillStyle = theme.faint;
    for (let part = 1; part < 5; ++part) {
      context.fillRect(Math.round(x((k + part / 5) * step)), lane.top + lane.height - 4, 1, 4);
    }
  }
}

export function drawAudio({ context, lane, x, width, from, to, theme }, peaks) {
  const middle = lane.top + lane.height / 2;
  const scale = (lane.height / 2 - 1) / peaks.loudest;
  const bins_per_px = ((to - from) / width) * peaks.bins_per_second;
  context.fillStyle = theme.faint;
  context.fillRect(0, Math.round(middle), Math.min(width, x(peaks.high.length / peaks.bins_per_second)), 1);
  context.fillStyle = theme.wave;
  for (let px = 0; px < width; ++px) {
    const first = Math.floor(from * peaks.bins_per_second + px * bins_per_px);
    const last = Math.min(peaks.high.length - 1, Math.floor(first + Math.max(1, bins_per_px)) - 1);
    let low = 0;
    let high = 0;
    for (let bin = Math.max(0, first); bin <= last; ++bin) {
      low = Math.min(low, peaks.low[bin]);
      high = Math.max(high, peaks.high[bin]);
    }
    if (first <= last) context.fillRect(px, middle - high * scale, 1, Math.max(1, (high - low) * scale));
  }
}

function joinMark(context, x, lane, colour) {
  context.fillStyle = colour;
  context.fillRect(x - 1, lane.top, 2, lane.height);
  context.beginPath();
  context.moveTo(x - 4.5, lane.top);
  context.lineTo(x + 4.5, lane.top);
  context.lineTo(x, lane.top + 6);
  context.fill();
}

export function drawPhonemes(pen, phonemes, { hovered, current }) {
  const { context, lane, x, theme } = pen;
  context.font = font(12, 600);
  phonemes.forEach((phoneme, index) => {
    if (!seen(phoneme, pen)) return;
    const left = x(phoneme.start);
    const right = x(phoneme.end);
    const silent = phoneme.node === null;
    context.fillStyle = silent ? theme.silence : phoneme.captured ? theme.captured : theme.joined;
    context.fillRect(left, lane.top, Math.max(1, right - left - 1), lane.height);
    if (phoneme.closure) {
      context.fillStyle = theme.closure;
      context.fillRect(left, lane.top + lane.height - 3, Math.max(1, right - left - 1), 3);
    }
    if (index === hovered || index === current) {
      context.strokeStyle = index === current ? theme.accent : theme.text;
      context.lineWidth = index === current ? 2 : 1;
      context.strokeRect(left + 1, lane.top + 1, Math.max(1, right - left - 3), lane.height - 2);
    }
    context.fillStyle = silent ? theme.muted : theme.text;
    label(context, phoneme.phoneme, left, right, lane.top + lane.height / 2);
  });
  phonemes.forEach((phoneme, index) => {
    if (seen(phoneme, pen) && isJoin(phonemes, index)) joinMark(context, x(phoneme.start), lane, theme.join);
  });
}

/** Where a captured run was recorded, long and short: `s1/neutral/bbaf2n 5–7`, `bbaf2n 5–7`, `bbaf2n`. */
function runNames({ first, last }) {
  const [sentence, from = ''] = first.split('#');
  const to = last.split('#')[1] ?? '';
  const orders = from === to ? from : `${from}–${to}`;
  const short = sentence.split('/').pop();
  return [`${sentence} ${orders}`, `${short} ${orders}`, short];
}

export function drawSources(pen, runs) {
  const { context, lane, x, theme } = pen;
  context.font = font(10.5);
  for (const run of runs) {
    if (!seen(run, pen)) continue;
    const left = x(run.start);
    const right = x(run.end) - 1;
    context.fillStyle = theme.source;
    context.fillRect(left, lane.top, Math.max(1, right - left), lane.height);
    context.fillStyle = theme.muted;
    leftLabel(context, runNames(run), left, right, lane.top + lane.height / 2 + 0.5);
  }
}

/** Black or white, whichever reads better on `colour` (#rrggbb). */
export function inkOn(colour) {
  const [red, green, blue] = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
  return 0.299 * red + 0.587 * green + 0.114 * blue > 140 ? '#111' : '#fff';
}

export function drawEmotions(pen, emotions) {
  const { context, lane, x } = pen;
  context.font = font(11, 600);
  for (const emotion of emotions) {
    if (!seen(emotion, pen)) continue;
    const left = x(emotion.start);
    const right = x(emotion.end) - 1;
    context.fillStyle = emotion.color;
    context.fillRect(left, lane.top, Math.max(1, right - left), lane.height);
    context.fillStyle = inkOn(emotion.color);
    leftLabel(context, [emotion.emotion], left, right, lane.top + lane.height / 2 + 0.5);
  }
}

export function drawAperture(pen, { rate, values_mm }, phonemes) {
  const { context, lane, x, width, from, to, theme } = pen;
  const top_mm = values_mm.reduce((most, value) => Math.max(most, value), 2 * closed_mm) * 1.08;
  const bottom_mm = Math.min(0, values_mm.reduce((least, value) => Math.min(least, value), 0)) - 0.02 * top_mm;
  const y = (mm) => lane.top + lane.height * (1 - (mm - bottom_mm) / (top_mm - bottom_mm));
  context.fillStyle = theme.lane;
  context.fillRect(0, lane.top, Math.min(width, x(values_mm.length / rate)), lane.height);
  context.fillStyle = theme.closureBand;
  for (const phoneme of phonemes) {
    if (phoneme.closure && seen(phoneme, pen)) {
      context.fillRect(x(phoneme.start), lane.top, x(phoneme.end) - x(phoneme.start), lane.height);
    }
  }
  context.fillStyle = theme.limit;
  for (let px = 0; px < width; px += 7) context.fillRect(px, Math.round(y(closed_mm)), 4, 1);
  context.beginPath();
  const last = Math.min(values_mm.length - 1, Math.ceil(to * rate) + 1);
  for (let frame = Math.max(0, Math.floor(from * rate) - 1); frame <= last; ++frame) {
    context.lineTo(x(frame / rate), y(values_mm[frame]));
  }
  context.strokeStyle = theme.curve;
  context.lineWidth = 1.6;
  context.lineJoin = 'round';
  context.stroke();
  context.font = font(10);
  context.textAlign = 'left';
  context.textBaseline = 'bottom';
  context.fillStyle = theme.limit;
  context.fillText(`${closed_mm} mm`, 4, y(closed_mm) - 1);
  context.textBaseline = 'top';
  context.fillStyle = theme.muted;
  context.fillText(`${top_mm.toFixed(0)} mm`, 4, lane.top + 2);
}
