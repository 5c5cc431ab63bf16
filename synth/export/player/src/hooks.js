// SPDX-License-Identifier: GPL-3.0-or-later

/**
 * `window.phonomime`: the page for scripts and tests.
 *
 * ready              Promise: the first frame is drawn; rejected with the error that the page shows
 * data               the page's data, as read
 * duration, fps      seconds, frames per second
 * hasAudio           true where the audio plays and decodes
 * audioDuration()    seconds, null without audio
 * seek(t)            sets the time (seconds), pauses, draws before it returns
 * play(), pause(), time()
 * vertex(mesh, primitive, vertex)       [x, y, z] mm in the head's axes at the set time
 * vertexWorld(mesh, primitive, vertex)  [x, y, z] mm in world axes
 * aperture()         mm, null without lip landmarks; negative where the lips overlap
 * apertureCurve()    {rate, values_mm}: the aperture at k / rate seconds (rate is fps unless the motion is
 *                    very long), without drawing; null without lip landmarks
 *
 * Mesh, primitive and vertex are indices into the glTF file.
 * @returns {{resolve: () => void, reject: (error: Error) => void, add: (members: object) => void}}
 */
export function installHooks() {
  const hooks = {};
  const settle = {};
  hooks.ready = new Promise((resolve, reject) => Object.assign(settle, { resolve, reject }));
  hooks.ready.catch(() => {}); // shown in the page: no "uncaught" beside it in the console
  window.phonomime = hooks;
  return { ...settle, add: (members) => Object.defineProperties(hooks, Object.getOwnPropertyDescriptors(members)) };
}
