// SPDX-License-Identifier: GPL-3.0-or-later
//
// For drive.mjs: what the last path of a drawing in motion is at some times.

export default async function ({ evaluate, screenshot, opened, args }) {
  const seen = [];
  for (let k = 0; k < 12; ++k) {
    seen.push(await evaluate(() => [...document.querySelectorAll('path')].at(-1).getAttribute('d')));
    if (args.length > 0) await screenshot(`drawing-${k}`);
    await opened.page.waitForTimeout(90);
  }
  return seen;
}
