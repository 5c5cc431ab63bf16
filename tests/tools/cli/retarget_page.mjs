// SPDX-License-Identifier: GPL-3.0-or-later
//
// For drive.mjs: places of some vertices (mm, world axes) at some times of a page.

export default async function ({ evaluate }) {
  await evaluate(() => window.phonomime.ready);
  return evaluate(() => {
    const found = {};
    for (const time of [0, 0.14, 0.42, 0.7]) {
      window.phonomime.seek(time);
      found[time] = {};
      for (const vertex of [0, 100, 212, 350, 420]) found[time][vertex] = window.phonomime.vertexWorld(0, 0, vertex);
    }
    return found;
  });
}
