// SPDX-License-Identifier: GPL-3.0-or-later
//
// Usage: node build.mjs OUTFILE
//
// Bundles src/ and three.js into the one page that the HTML exporter fills in. The page keeps two
// slots, each exactly once: @PHONOMIME_TITLE@ (escaped text) and @PHONOMIME_DATA@ (JSON with `<`
// written as \u003c). Nothing but OUTFILE (and a temporary file beside it) is written.

import { readFile, rename, writeFile } from 'node:fs/promises';
import path from 'node:path';
import process from 'node:process';
import { fileURLToPath } from 'node:url';
import * as esbuild from 'esbuild';

const here = path.dirname(fileURLToPath(import.meta.url));
const slots = ['@PHONOMIME_TITLE@', '@PHONOMIME_DATA@'];
const browsers = ['chrome92', 'firefox92', 'safari15.4'];

const occurrences = (text, part) => text.split(part).length - 1;

async function bundle() {
  const result = await esbuild.build({
    absWorkingDir: here,
    entryPoints: ['src/main.js'],
    bundle: true,
    write: false,
    minify: true,
    format: 'iife',
    target: browsers,
    legalComments: 'inline',
    logLevel: 'warning',
  });
  // An HTML parser ends an inline script at "</script" and changes its mode at "<!--".
  return result.outputFiles[0].text.replace(/<\/(script)/gi, '<\\/$1').replaceAll('<!--', '<\\!--');
}

async function stylesheet() {
  const css = await readFile(path.join(here, 'src/player.css'), 'utf8');
  const result = await esbuild.transform(css, { loader: 'css', minify: true, target: browsers });
  return result.code;
}

/** Third-party licence, whole, as the MIT licence asks. */
async function notice() {
  const licence = await readFile(path.join(here, 'node_modules/three/LICENSE'), 'utf8');
  if (licence.includes('*/')) throw new Error('the licence of three cannot stand in a comment');
  return `/*!\nPhonomime player, GPL-3.0-or-later. It contains three.js:\n\n${licence.trim()}\n*/\n`;
}

async function build(outFile) {
  const [template, script, style, licence] = await Promise.all([
    readFile(path.join(here, 'src/template.html'), 'utf8'),
    bundle(),
    stylesheet(),
    notice(),
  ]);
  const parts = { '@@STYLE@@': style, '@@SCRIPT@@': licence + script };
  const page = template.replace(/@@(STYLE|SCRIPT)@@/g, (name) => parts[name]);
  for (const slot of slots) {
    if (occurrences(page, slot) !== 1) throw new Error(`the page must hold ${slot} exactly once`);
  }
  if (occurrences(page, '@PHONOMIME_') !== slots.length) throw new Error('the page has an unknown slot');
  const temporary = `${outFile}.${process.pid}.tmp`;
  await writeFile(temporary, page);
  await rename(temporary, outFile);
}

if (process.argv.length !== 3) {
  process.stderr.write('usage: node build.mjs OUTFILE\n');
  process.exit(2);
}
await build(path.resolve(process.argv[2]));
