// SPDX-License-Identifier: GPL-3.0-or-later
//
// Usage: node validate_glb.mjs FOLDER
//
// Khronos' validator over every .glb of a folder: prints every message and fails on any error or
// warning, and where there is no file.

import { readdir, readFile } from 'node:fs/promises';
import path from 'node:path';
import process from 'node:process';
import validator from 'gltf-validator';

const severities = ['error', 'warning', 'information', 'hint'];
const [folder] = process.argv.slice(2);
if (!folder) {
  process.stderr.write('usage: node validate_glb.mjs FOLDER\n');
  process.exit(2);
}

const files = (await readdir(folder)).filter((name) => name.endsWith('.glb')).sort();
let failed = files.length === 0;
for (const file of files) {
  const bytes = new Uint8Array(await readFile(path.join(folder, file)));
  const { issues } = await validator.validateBytes(bytes, { uri: file, maxIssues: 100 });
  console.log(`${file}: ${issues.numErrors} errors, ${issues.numWarnings} warnings`);
  for (const { severity, code, message, pointer } of issues.messages) {
    console.log(`  ${severities[severity]} ${code} at ${pointer ?? '?'}: ${message}`);
  }
  failed ||= issues.numErrors > 0 || issues.numWarnings > 0 || issues.truncated;
}
console.log(`${files.length} files`);
process.exit(failed ? 1 : 0);
