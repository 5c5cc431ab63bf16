// SPDX-License-Identifier: GPL-3.0-or-later
//
// Usage: node drive.mjs PAGE SCRIPT.mjs [--screenshot-dir DIR] [--size 1280x800] [--scheme dark|light]
//                       [-- ARGUMENT...]
//
// Opens PAGE (an .html file or a URL) in the machine's own headless Chromium and calls the default
// export of SCRIPT.mjs:
//
//     export default async function ({ evaluate, screenshot, opened, args }) {
//       await evaluate(() => window.phonomime.ready);
//       const gap_mm = await evaluate((t) => { phonomime.seek(t); return phonomime.aperture(); }, 0.5);
//       await screenshot('half-a-second');             // DIR/half-a-second.png, and a Buffer (PNG)
//       return { gap_mm };                             // printed as JSON on stdout
//     }
//
// `opened` is driver.mjs' OpenPage: `console_errors`, `console_lines`, `requests`,
// `network_requests`, and Playwright's `page` for keys and clicks. `args` is what follows `--`.
//
// Exit status: 0 when the script returned, the page wrote no error to the console and asked for
// nothing beyond file:, data: and blob:; 1 otherwise (the reasons on stderr); 2 usage; 77 when
// Chromium or playwright-core is missing (ctest's SKIP_RETURN_CODE). Run `npm ci` in this folder
// (or in a copy of it) first.

import { parseArgs } from 'node:util';
import path from 'node:path';
import process from 'node:process';
import { pathToFileURL } from 'node:url';
import { findChromium, openPage } from './driver.mjs';

const usage = 'usage: node drive.mjs PAGE SCRIPT.mjs [--screenshot-dir DIR] [--size WxH] [--scheme dark|light] [-- ARG...]\n';
const skipped = 77;

function readArguments() {
  try {
    const { values, positionals } = parseArgs({
      allowPositionals: true,
      options: {
        'screenshot-dir': { type: 'string' },
        size: { type: 'string', default: '1280x800' },
        scheme: { type: 'string', default: 'dark' },
      },
    });
    const size = /^(\d+)x(\d+)$/.exec(values.size);
    if (positionals.length < 2 || !size) throw new Error('arguments missing');
    const [page, script, ...args] = positionals;
    const options = {
      width: Number(size[1]), height: Number(size[2]), scheme: values.scheme, screenshot_dir: values['screenshot-dir'],
    };
    return { page, script, args, options };
  } catch (error) {
    process.stderr.write(`${error.message}\n${usage}`);
    process.exit(2);
  }
}

async function missing() {
  if (!findChromium()) return 'Chromium is missing';
  return import('playwright-core').then(() => null, () => 'playwright-core is missing: run npm ci');
}

const { page, script, args, options } = readArguments();
const reason = await missing();
if (reason) {
  process.stderr.write(`skipped: ${reason}\n`);
  process.exit(skipped);
}
const { default: run } = await import(pathToFileURL(path.resolve(script)).href);
const opened = await openPage(page, options);
const complaints = [];
try {
  const result = await run({
    evaluate: (...call) => opened.evaluate(...call),
    screenshot: (...call) => opened.screenshot(...call),
    opened,
    args,
  });
  if (result !== undefined) process.stdout.write(`${JSON.stringify(result, null, 2)}\n`);
} catch (error) {
  complaints.push(error.stack);
} finally {
  await opened.close();
}
complaints.push(...opened.console_errors.map((text) => `console: ${text}`));
complaints.push(...opened.network_requests.map((url) => `network: ${url}`));
for (const complaint of complaints) process.stderr.write(`${complaint}\n`);
process.exit(complaints.length > 0 ? 1 : 0);
