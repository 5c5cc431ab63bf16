// SPDX-License-Identifier: GPL-3.0-or-later
//
// Usage: node report_page.mjs REPORT_FOLDER BROWSER_DIR WORK_DIR
//
// Opens the page that report_test leaves in headless Chromium and holds it against report.json.
// Exit status 77: Chromium is missing.

import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import path from 'node:path';
import process from 'node:process';
import test from 'node:test';
import { pathToFileURL } from 'node:url';

const [report_dir, browser_dir, work_dir] = process.argv.slice(2).map((name) => path.resolve(name));
const { findChromium, openPage } = await import(pathToFileURL(path.join(browser_dir, 'driver.mjs')).href);
if (!findChromium()) {
  process.stderr.write('skipped: Chromium is missing\n');
  process.exit(77);
}

const report = JSON.parse(await readFile(path.join(report_dir, 'report.json'), 'utf8'));
const motion = JSON.parse(await readFile(path.join(report_dir, 'motion.json'), 'utf8'));
const main = report.methods.find(({ id }) => id === report.main_method);
const measure = (id) => report.measures.find((one) => one.id === id);
const shown = (value, decimals) => (value === null ? '–' : value.toFixed(decimals).replace('-', '−'));
const open = (options) => openPage(path.join(report_dir, 'report.html'), {
  width: 1280, height: 900, scheme: 'light', webgl: false, screenshot_dir: work_dir, ...options,
});
const rowsOf = (page, id) => page.evaluate((table) =>
  [...document.querySelectorAll(`#${table} tbody tr`)].map((row) => [...row.cells].map((cell) => {
    const copy = cell.cloneNode(true);
    for (const extra of copy.querySelectorAll('.se, .what')) extra.remove();
    return copy.textContent;
  })), id);

test('the page opens without complaint and without a network', async () => {
  for (const scheme of ['light', 'dark']) {
    const page = await open({ scheme });
    assert.equal(await page.evaluate(() => document.title), `Evaluation of ${report.corpus}`);
    await page.screenshot(`top_${scheme}`);
    assert.deepEqual(page.console_errors, []);
    assert.deepEqual(page.network_requests, []);
    await page.close();
  }
});

test('tables show the figures of the JSON report', async () => {
  const page = await open();
  const rows = await rowsOf(page, 'method-table');
  assert.deepEqual(rows.map(([name]) => name), report.methods.map(({ id }) => id));
  report.methods.forEach((method, index) => {
    assert.equal(rows[index][1], shown(method.measures.squared_error.mean, measure('squared_error').decimals));
    assert.equal(rows[index][2], shown(method.measures.lip_rmse.mean, measure('lip_rmse').decimals));
  });
  const every = await rowsOf(page, 'measure-table');
  assert.equal(every.length, report.measures.length + 1); // and E12
  report.measures.forEach(({ id, decimals }, index) =>
    assert.equal(every[index][1], shown(main.measures[id].mean, decimals), id));
  const definitions = await rowsOf(page, 'definition-table');
  assert.deepEqual(definitions.map(([, , formula]) => formula), report.measures.map(({ formula }) => formula));
  const list = await rowsOf(page, 'sentence-table');
  const worst = [...main.sentences].sort((a, b) => b.values.squared_error - a.values.squared_error);
  assert.deepEqual(list.map(([key]) => key.replace(' ▸', '')), worst.map(({ key }) => key));
  const verdicts = await page.evaluate(() => [...document.querySelectorAll('#comparison .verdict')].map((v) => v.textContent));
  const expected = report.comparison.methods.flatMap(({ measures }) => Object.values(measures).map(({ verdict }) => verdict ?? ''));
  assert.deepEqual(verdicts, expected);
  await page.close();
});

test('packed motion is the motion, and the clock moves it', async () => {
  const page = await open();
  const read = await page.evaluate(() => {
    const { report: data, trace } = window.phonomime_report;
    const [sentence] = data.shown;
    const groups = sentence.recorded.trace.groups;
    return {
      key: sentence.key, groups, step: data.face.step,
      curves: groups.map((_, group) => [0, 1, 2].map((axis) => trace(sentence.recorded.trace, group, axis))),
      made: groups.map((_, group) => [0, 1, 2].map((axis) => trace(sentence.methods[0].trace, group, axis))),
    };
  });
  const { recorded, methods } = motion.sentences[read.key];
  for (const [curves, frames] of [[read.curves, recorded], [read.made, methods[report.main_method].channels]]) {
    read.groups.forEach((group, index) => [0, 1, 2].forEach((axis) => {
      assert.equal(curves[index][axis].length, frames.length);
      curves[index][axis].forEach((value, frame) =>
        assert.ok(Math.abs(value - frames[frame][3 * group + axis]) <= read.step, `${group} ${axis} ${frame}`));
    }));
  }
  // The players' motion is thinned to 50 Hz; between its frames it is linear.
  const times = [0, 0.14, 0.5, 0.51];
  const poses = await page.evaluate((moments) => {
    const { report: data, motionOf, poseAt } = window.phonomime_report;
    const packed = data.shown[0].recorded.motion;
    return moments.map((time) => packed.groups.map((_, group) => [0, 1, 2].map(poseAt(motionOf(packed), time).bind(null, group))));
  }, times);
  times.forEach((time, index) => {
    const frame = Math.floor(time * 50) * 2;
    const share = (time * motion.rate - frame) / 2;
    poses[index].forEach((channels, group) => channels.forEach((value, axis) => {
      const [from, to] = [recorded[frame][3 * group + axis], recorded[frame + 2][3 * group + axis]];
      assert.ok(Math.abs(value - (from + share * (to - from))) <= read.step, `${time} ${group} ${axis}`);
    }));
  });
  const inkAt = (time) => page.evaluate((t) => {
    window.phonomime_report.setTime(t);
    return ['view-recorded', 'view-made'].map((id) => document.getElementById(id).toDataURL());
  }, time);
  const early = await inkAt(0.3);
  const late = await inkAt(0.8);
  assert.notEqual(early[0], late[0]);
  assert.notEqual(early[1], late[1]);
  assert.deepEqual(await inkAt(0.3), early);
  await page.page.locator('#play').click();
  await page.page.waitForFunction(() => window.phonomime_report.clock.time > 0.5);
  await page.page.locator('#play').click();
  assert.equal(await page.evaluate(() => window.phonomime_report.clock.playing), false);
  assert.deepEqual(page.console_errors, []);
  await page.close();
});

test('every choice can be made', async () => {
  const page = await open();
  const choices = await page.evaluate(() => [...document.querySelectorAll('select')].map(({ id, options }) => [id, options.length]));
  for (const [id, count] of choices) {
    for (let option = 0; option < count; ++option) await page.page.locator(`#${id}`).selectOption({ index: option });
  }
  await page.page.locator('#all-methods').check();
  await page.page.locator('#ghost').uncheck();
  await page.page.locator('#find-sentence').fill('MADE13');
  assert.equal((await rowsOf(page, 'sentence-table')).length, 1);
  await page.page.setViewportSize({ width: 700, height: 900 });
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), 'nothing sticks out');
  assert.deepEqual(page.console_errors, []);
  await page.close();
});
