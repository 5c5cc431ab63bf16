// SPDX-License-Identifier: GPL-3.0-or-later
//
// A headless Chromium with one page in it, for tests. Chromium is the machine's own: CHROMIUM in the
// environment, else the first of the usual names on PATH; nothing is downloaded.

import { accessSync, constants } from 'node:fs';
import { mkdir } from 'node:fs/promises';
import path from 'node:path';
import process from 'node:process';
import { pathToFileURL } from 'node:url';

const names = ['chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable'];
const local_schemes = ['file:', 'data:', 'blob:', 'about:'];
const flags = [
  '--no-sandbox', '--disable-gpu', '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync',
  '--autoplay-policy=no-user-gesture-required',
];

function isProgram(file) {
  try {
    accessSync(file, constants.X_OK);
    return true;
  } catch {
    return false;
  }
}

/** @returns {string | null} path of the machine's Chromium */
export function findChromium() {
  if (process.env.CHROMIUM) return isProgram(process.env.CHROMIUM) ? process.env.CHROMIUM : null;
  const folders = (process.env.PATH ?? '').split(path.delimiter);
  return names.flatMap((name) => folders.map((folder) => path.join(folder, name))).find(isProgram) ?? null;
}

/** True where a request stays on this machine's disk or in the page. */
export const isLocal = (url) => local_schemes.includes(new URL(url).protocol);

/** An open page and all that it said and asked for. */
export class OpenPage {
  constructor(browser, page, screenshot_dir) {
    Object.assign(this, { browser, page, screenshot_dir });
    this.console_errors = []; // text of console.error and of uncaught errors, in order
    this.console_lines = []; // "type: text" of everything, in order
    this.requests = []; // URLs, in order, that of the page first
    page.on('console', (message) => {
      this.console_lines.push(`${message.type()}: ${message.text()}`);
      if (message.type() === 'error') this.console_errors.push(message.text());
    });
    page.on('pageerror', (error) => this.console_errors.push(`uncaught: ${error.message}`));
    page.on('request', (request) => this.requests.push(request.url()));
  }

  /** Requests that would leave the machine. @returns {string[]} */
  get network_requests() { return this.requests.filter((url) => !isLocal(url)); }

  /** Runs a function (or an expression) in the page; awaits its result, which has to be JSON. */
  evaluate(code, argument) { return this.page.evaluate(code, argument); }

  /**
   * @param {string} name without suffix; written to the screenshot folder where one is given
   * @param {string} [selector] an element instead of the window
   * @returns {Promise<Buffer>} PNG
   */
  async screenshot(name, selector) {
    const file = this.screenshot_dir && path.join(this.screenshot_dir, `${name}.png`);
    if (file) await mkdir(this.screenshot_dir, { recursive: true });
    const target = selector ? this.page.locator(selector) : this.page;
    return target.screenshot(file ? { path: file } : {});
  }

  close() { return this.browser.close(); }
}

/**
 * Opens a page in a browser of its own, with a profile that goes when it is closed.
 * @param {string} target a file's path or a URL
 * @param {{width?: number, height?: number, scheme?: 'light' | 'dark', webgl?: boolean,
 *   screenshot_dir?: string}} [options]
 * @returns {Promise<OpenPage>}
 * @throws where Chromium is missing (ask findChromium() first) or the page does not load
 */
export async function openPage(target, options = {}) {
  const { width = 1280, height = 800, scheme = 'dark', webgl = true, screenshot_dir = null } = options;
  const executablePath = findChromium();
  if (!executablePath) throw new Error('Chromium is missing: install it, or set CHROMIUM to its path');
  const { chromium } = await import('playwright-core');
  const args = webgl ? flags : [...flags.filter((flag) => !flag.includes('swiftshader')), '--disable-3d-apis'];
  const browser = await chromium.launch({ executablePath, headless: true, args });
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme });
  const opened = new OpenPage(browser, await context.newPage(), screenshot_dir);
  const address = /^\w+:\/\//.test(target) ? target : pathToFileURL(path.resolve(target)).href;
  await opened.page.goto(address, { timeout: 120_000 });
  return opened;
}
