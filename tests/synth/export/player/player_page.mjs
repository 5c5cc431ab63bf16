// SPDX-License-Identifier: GPL-3.0-or-later
//
// Usage: node player_page.mjs PLAYER_HTML BROWSER_DIR WORK_DIR
//
// Fills the built page (PLAYER_HTML) with a known face, opens it in headless Chromium through the
// driver in BROWSER_DIR, and checks what the page promises. Exit status 77: Chromium is missing.

import assert from 'node:assert/strict';
import { mkdir, readFile, writeFile } from 'node:fs/promises';
import path from 'node:path';
import process from 'node:process';
import test from 'node:test';
import { setTimeout as wait } from 'node:timers/promises';
import { pathToFileURL } from 'node:url';
import {
  checked_vertices, duration, expectedVertex, expectedWorld, fps, knownGlb, lip_lower, lip_upper, toneWav,
} from './known_face.mjs';

const [player_html, browser_dir, work_dir] = process.argv.slice(2).map((name) => path.resolve(name));
const { findChromium, openPage } = await import(pathToFileURL(path.join(browser_dir, 'driver.mjs')).href);
if (!findChromium()) {
  process.stderr.write('skipped: Chromium is missing\n');
  process.exit(77);
}

const tolerance_mm = 1e-3;
const audio_s = 1.2;
const times = [0, 1 / fps, 0.4321, duration / 2, 1.0999, duration, duration + 1];
const title = 'Fish & "chips" </script><b>';

const phonemes = [
  { phoneme: 'pau', start: 0, end: 0.3, node: null, captured: false },
  { phoneme: 'b', start: 0.3, end: 0.5, node: 's1/neutral/x#1', captured: false, closure: true },
  { phoneme: 'aa', start: 0.5, end: 0.9, node: 's1/neutral/x#2', captured: true },
  { phoneme: 'm', start: 0.9, end: 1.2, node: 's1/anger/y#4', captured: false, closure: true },
  { phoneme: 'pau', start: 1.2, end: 1.6, node: null, captured: false },
].map((phoneme, index) => ({
  index, closure: false, cost: { observation: 0.5, emotion: 0, transition: 12.25 }, ...phoneme,
}));

const whole = {
  title,
  duration,
  fps,
  glb: knownGlb().toString('base64'),
  audio: toneWav(audio_s).toString('base64'),
  audio_type: 'audio/wav',
  phonemes,
  emotions: [
    { start: 0, end: 0.7, emotion: 'neutral', color: '#8c96a3' },
    { start: 0.7, end: 1.6, emotion: 'anger', color: '#c0392b' },
  ],
  landmarks: {
    lip_upper_inner: { mesh: 0, primitive: 0, vertex: lip_upper },
    lip_lower_inner: { mesh: 0, primitive: 1, vertex: lip_lower },
  },
  credits: ['A known face'],
  synthetic: true,
};

const escaped = (text) => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('"', '&quot;');
let pages = 0;

/** The page as the exporter writes it; `json` is the text of its data. */
async function filled(json) {
  const template = await readFile(player_html, 'utf8');
  const parts = { TITLE: escaped(title), DATA: json.replaceAll('<', '\\u003c') };
  return template.replace(/@PHONOMIME_(TITLE|DATA)@/g, (_, name) => parts[name]);
}

async function open(t, json, options = {}) {
  const file = path.join(work_dir, `page${++pages}.html`);
  await writeFile(file, await filled(json));
  const opened = await openPage(file, { width: 900, height: 600, screenshot_dir: work_dir, ...options });
  t.after(() => opened.close());
  return opened;
}

async function openReady(t, data, options) {
  const opened = await open(t, JSON.stringify(data), options);
  await opened.evaluate(() => window.phonomime.ready);
  return opened;
}

function assertQuiet(opened) {
  assert.deepEqual(opened.console_errors, []);
  assert.deepEqual(opened.network_requests, []);
}

function assertNear(got, expected, what) {
  const distance = Math.hypot(...got.map((x, k) => x - expected[k]));
  assert.ok(distance <= tolerance_mm, `${what}: expected ${expected}, got ${got}, ${distance} mm apart`);
}

await mkdir(work_dir, { recursive: true });

test('vertices are where the closed form has them, at and between keys and past the end', async (t) => {
  const opened = await openReady(t, whole);
  const places = checked_vertices.flatMap((v) => [[0, 0, v], [0, 1, v]]).concat([[1, 0, 0], [1, 0, 2]]);
  for (const time of times) {
    const got = await opened.evaluate(([at_s, at]) => {
      window.phonomime.seek(at_s);
      return at.map((place) => [window.phonomime.vertex(...place), window.phonomime.vertexWorld(...place)]);
    }, [time, places]);
    places.forEach(([mesh, primitive, v], i) => {
      const what = `mesh ${mesh}, primitive ${primitive}, vertex ${v}, ${time} s`;
      assertNear(got[i][0], expectedVertex(mesh, v, time), what);
      assertNear(got[i][1], expectedWorld(mesh, v, time), `${what}, world`);
    });
  }
  await assert.rejects(opened.evaluate(() => window.phonomime.vertex(0, 0, 100000)), /100000/);
  await assert.rejects(opened.evaluate(() => window.phonomime.vertex(7, 0, 0)), /mesh 7/);
  assertQuiet(opened);
});

test('the aperture is the height between the lips, and none without landmarks', async (t) => {
  const opened = await openReady(t, whole);
  for (const time of times) {
    const got = await opened.evaluate((at_s) => { window.phonomime.seek(at_s); return window.phonomime.aperture(); }, time);
    assertNear([got], [expectedVertex(0, lip_upper, time)[1] - expectedVertex(0, lip_lower, time)[1]], `${time} s`);
  }
  const { rate, values_mm } = await opened.evaluate(() => window.phonomime.apertureCurve());
  assert.equal(rate, fps);
  assert.equal(values_mm.length, duration * fps + 1);
  values_mm.forEach((got, k) => {
    assertNear([got], [expectedVertex(0, lip_upper, k / fps)[1] - expectedVertex(0, lip_lower, k / fps)[1]], `frame ${k}`);
  });
  const bare = await openReady(t, { ...whole, landmarks: {} });
  assert.equal(await bare.evaluate(() => window.phonomime.aperture()), null);
  assertQuiet(bare);
});

test('the header counts what sounds and what joins, as the program does', async (t) => {
  const pause = { ...phonemes[3], index: 3, phoneme: 'pau', end: 1.0, node: 's1/anger/y#3', closure: false };
  const said = [...phonemes.slice(0, 3), pause, { ...phonemes[3], index: 4, start: 1.0 }, { ...phonemes[4], index: 5 }];
  const opened = await openReady(t, { ...whole, phonemes: said });
  const facts = await opened.evaluate(() => document.getElementById('facts').textContent);
  assert.match(facts, / 3 sounding phonemes · 1 of 3 joins between chosen nodes as recorded$/);
  const silent = await openReady(t, { ...whole, phonemes: [phonemes[0]] });
  assert.match(await silent.evaluate(() => document.getElementById('facts').textContent), / 0 sounding phonemes · 0 of 0 joins /);
});

/** The drawn pixels at a time, read in the task that sets the time: RGBA bytes. */
async function pixelsAt(opened, time) {
  const list = await opened.evaluate((at_s) => {
    window.phonomime.seek(at_s);
    const gl = document.getElementById('view').getContext('webgl2');
    const bytes = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
    gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(''));
  }, time);
  return Buffer.from(list, 'base64');
}

/** Share of the pixels that differ visibly. */
function shareChanged(a, b) {
  let changed = 0;
  for (let i = 0; i < a.length; i += 4) {
    if ([0, 1, 2, 3].some((k) => Math.abs(a[i + k] - b[i + k]) > 8)) ++changed;
  }
  return changed / (a.length / 4);
}

test('the picture moves with the time', async (t) => {
  const opened = await openReady(t, whole);
  const first = await pixelsAt(opened, 0);
  const middle = await pixelsAt(opened, duration / 2);
  await opened.screenshot('middle');
  const again = await pixelsAt(opened, 0);
  assert.ok(shareChanged(first, again) < 1e-3, 'the same time gives another picture');
  assert.ok(shareChanged(first, middle) > 0.02, 'another time gives the same picture');
});

test('it opens paused, plays past the end of the audio, and stops at the end of the motion', async (t) => {
  const opened = await openReady(t, whole);
  const state = () => opened.evaluate(() => [
    window.phonomime.time(), document.getElementById('play').getAttribute('aria-label'),
  ]);
  assert.equal(await opened.evaluate(() => window.phonomime.hasAudio), true);
  assert.ok(Math.abs(await opened.evaluate(() => window.phonomime.audioDuration()) - audio_s) < 1e-3);
  await wait(300);
  assert.deepEqual(await state(), [0, 'Play']);
  assert.equal(await opened.evaluate(() => {
    window.phonomime.play();
    return document.getElementById('play').getAttribute('aria-label');
  }), 'Pause');
  await opened.page.waitForFunction(() => window.phonomime.time() > 0.1);
  await opened.evaluate(() => window.phonomime.pause());
  const [paused_at] = await state();
  await wait(200);
  assert.deepEqual(await state(), [paused_at, 'Play']);
  await opened.evaluate(() => window.phonomime.play());
  await opened.page.waitForFunction((end) => window.phonomime.time() === end, duration, { timeout: 20000 });
  assert.deepEqual(await state(), [duration, 'Play']);
  assertQuiet(opened);
});

test('the time is that of the audio while it plays', async (t) => {
  const opened = await openReady(t, { ...whole, audio: null });
  await opened.page.addInitScript((stopped_at) => {
    const Plain = window.Audio;
    window.Audio = function Audio() {
      window.heard = new Plain();
      Object.defineProperty(window.heard, 'currentTime', { get: () => stopped_at, set: () => {} });
      return window.heard;
    };
  }, 0.625);
  await writeFile(new URL(opened.page.url()), await filled(JSON.stringify(whole)));
  await opened.page.reload();
  await opened.evaluate(() => window.phonomime.ready);
  await opened.evaluate(() => {
    document.querySelector('[data-rate="0.5"]').click();
    window.phonomime.play();
  });
  await opened.page.waitForFunction(() => window.phonomime.time() === 0.625);
  assert.equal(await opened.evaluate(() => window.heard.playbackRate), 0.5);
});

test('without audio it plays by the clock, and loops', async (t) => {
  const opened = await openReady(t, { ...whole, audio: null });
  assert.deepEqual(
    await opened.evaluate(() => [window.phonomime.hasAudio, window.phonomime.audioDuration()]), [false, null]);
  await opened.evaluate(() => {
    document.getElementById('loop').click();
    window.phonomime.seek(1.2);
    window.phonomime.play();
  });
  await opened.page.waitForFunction(() => window.phonomime.time() < 1);
  await opened.page.waitForFunction(() => window.phonomime.time() > 0.2);
  assertQuiet(opened);
});

test('keys and clicks move the time', async (t) => {
  const opened = await openReady(t, whole);
  const time = () => opened.evaluate(() => window.phonomime.time());
  const after = async (key) => { await opened.page.keyboard.press(key); return time(); };
  assert.equal(await after('End'), duration);
  assert.equal(await after('Home'), 0);
  assert.equal(await after('ArrowRight'), 1 / fps);
  assert.equal(await after('Shift+ArrowRight'), 11 / fps);
  assert.equal(await after('ArrowLeft'), 10 / fps);
  assert.equal(await after('PageDown'), phonemes[2].start);
  assert.equal(await after('PageUp'), phonemes[1].start);
  await opened.page.keyboard.press('l'); // looping, a slow machine does not meet the end between two keys
  await opened.page.keyboard.press(' ');
  assert.equal(await opened.page.locator('#play').getAttribute('aria-label'), 'Pause');
  const stopped = await after(' ');
  assert.equal(await opened.page.locator('#play').getAttribute('aria-label'), 'Play');
  await wait(150);
  assert.equal(await time(), stopped);
  const box = await opened.page.locator('#sheet').boundingBox();
  const lane = await opened.evaluate(() => {
    const name = [...document.querySelectorAll('#lane-names span')].find((span) => span.textContent === 'Phonemes');
    return name.offsetTop + name.offsetHeight / 2;
  });
  await opened.page.keyboard.press('0');
  await opened.page.mouse.click(box.x + (box.width * 1.0) / duration, box.y + lane);
  assert.equal(await time(), phonemes[3].start);
  const tip = await opened.page.locator('#tip').innerText();
  assert.match(tip, /s1\/anger\/y#4/);
  assert.match(tip, /12\.25/);
  await opened.page.locator('#tab-table').click();
  assert.equal(await opened.page.locator('tbody tr').count(), phonemes.length);
  assert.equal(await opened.page.locator('tr[aria-current] td:nth-child(6)').innerText(), 'made here');
  assertQuiet(opened);
});

test('it says what it shows, whatever stands in the title', async (t) => {
  const opened = await openReady(t, whole, { scheme: 'light' });
  assert.equal(await opened.page.title(), title);
  assert.equal(await opened.page.locator('#title').innerText(), title);
  assert.ok(await opened.page.locator('#synthetic').isVisible());
  assert.equal(await opened.page.locator('#credits').innerText(), 'A known face');
  assert.ok(await opened.evaluate(() => document.documentElement.scrollWidth <= innerWidth
    && document.documentElement.scrollHeight <= innerHeight), 'the page does not fit 900 x 600');
  const real = await openReady(t, { ...whole, synthetic: false });
  assert.ok(!await real.page.locator('#synthetic').isVisible());
});

test('what cannot be shown is said, and the rest stays', async (t) => {
  const cut = knownGlb().subarray(0, 2000).toString('base64');
  const broken = {
    'a GLB cut short': [JSON.stringify({ ...whole, glb: cut }), {}, phonemes.length],
    'no GLB': [JSON.stringify({ ...whole, glb: null }), {}, phonemes.length],
    'base64 that is none': [JSON.stringify({ ...whole, glb: '*' }), {}, phonemes.length],
    'a landmark outside the mesh': [
      JSON.stringify({ ...whole, landmarks: { ...whole.landmarks, lip_upper_inner: { mesh: 9, primitive: 0, vertex: 0 } } }),
      {}, phonemes.length,
    ],
    'no WebGL': [JSON.stringify(whole), { webgl: false }, phonemes.length],
    'JSON cut short': [JSON.stringify(whole).slice(0, 300), {}, 0],
    'no duration': [JSON.stringify({ ...whole, duration: null }), {}, 0],
    'phonemes of another kind': [JSON.stringify({ ...whole, phonemes: [{ start: 'x' }] }), {}, 0],
  };
  for (const [name, [json, options, rows]] of Object.entries(broken)) {
    const opened = await open(t, json, options);
    const failure = await opened.evaluate(() => window.phonomime.ready.then(() => null, (error) => error.message));
    assert.ok(failure, `${name}: ready is not rejected`);
    assert.ok(await opened.page.locator('#error').isVisible(), `${name}: no message`);
    assert.ok((await opened.page.locator('#error').innerText()).includes(failure), `${name}: another message`);
    assert.equal(await opened.page.locator('tbody tr').count(), rows, `${name}: rows of the table`);
    assert.equal(opened.console_errors.filter((text) => text.startsWith('uncaught')).length, 0, name);
    await opened.screenshot(`broken ${name}`);
    await opened.close();
  }
});

test('audio that does not decode is told, and the face still plays', async (t) => {
  const opened = await openReady(t, { ...whole, audio: Buffer.from('no sound').toString('base64') });
  assert.equal(await opened.evaluate(() => window.phonomime.hasAudio), false);
  assert.match(await opened.page.locator('#notice').innerText(), /audio cannot be played/);
  await opened.evaluate(() => window.phonomime.play());
  await opened.page.waitForFunction(() => window.phonomime.time() > 0.1);
});
