// SPDX-License-Identifier: GPL-3.0-or-later

import { BufferAttribute, BufferGeometry, DoubleSide, Mesh, MeshBasicMaterial } from 'three';
import { trianglesOf, weldedIndices } from './normals.js';

const depth_share = 0.45; // of the opening's largest extent

/** Closed loops of edges that only one triangle has, as vertex indices in order. */
function boundaryLoops(geometry) {
  const welded = weldedIndices(geometry.attributes.position);
  const triangles = trianglesOf(geometry);
  const edges = new Map();
  for (let t = 0; t < triangles.length; t += 3) {
    for (let corner = 0; corner < 3; ++corner) {
      const from = welded[triangles[t + corner]];
      const to = welded[triangles[t + ((corner + 1) % 3)]];
      if (!edges.delete(`${to},${from}`)) edges.set(`${from},${to}`, [from, to]);
    }
  }
  const next = new Map(edges.values());
  const loops = [];
  while (next.size > 0) {
    const [start] = next.keys();
    const loop = [];
    let at = start;
    while (next.has(at)) {
      const following = next.get(at);
      loop.push(at);
      next.delete(at);
      at = following;
    }
    if (at === start && loop.length > 2) loops.push(loop);
  }
  return loops;
}

const extent = (position, loop) => Math.max(...[0, 1, 2].map((k) => {
  const values = loop.map((v) => position.getComponent(v, k));
  return Math.max(...values) - Math.min(...values);
}));

/**
 * Values of an attribute for a bag: the rim, the rim once more moved by `behind` along z, and the
 * middle of that.
 */
function bagValues(attribute, loop, behind) {
  const rim = loop.map((v) => [0, 1, 2].map((k) => attribute.getComponent(v, k)));
  const floor = rim.map(([x, y, z]) => [x, y, z - behind]);
  const middle = [0, 1, 2].map((k) => floor.reduce((sum, point) => sum + point[k], 0) / floor.length);
  return new BufferAttribute(Float32Array.from([...rim, ...floor, middle].flat()), 3);
}

function bagIndex(count) {
  const index = [];
  for (let i = 0; i < count; ++i) {
    const j = (i + 1) % count;
    index.push(i, j, count + j, i, count + j, count + i, count + i, count + j, 2 * count);
  }
  return index;
}

/**
 * Dark bags behind a mask's mouth and eyes, so that one does not look through it: one for every hole
 * but the outline. They move with their rims (all is linear, so the same weights drive them).
 * @param {Mesh} mask changed: the bags become its children
 */
export function lineOpenings(mask) {
  const { position } = mask.geometry.attributes;
  const loops = boundaryLoops(mask.geometry);
  const outline = Math.max(0, ...loops.map((loop) => extent(position, loop)));
  const material = new MeshBasicMaterial({ color: 0x1d0d0c, side: DoubleSide });
  for (const loop of loops) {
    const size = extent(position, loop);
    if (size === outline) continue;
    const geometry = new BufferGeometry();
    geometry.setIndex(bagIndex(loop.length));
    geometry.setAttribute('position', bagValues(position, loop, depth_share * size));
    const targets = mask.geometry.morphAttributes.position;
    if (targets) geometry.morphAttributes.position = targets.map((target) => bagValues(target, loop, 0));
    geometry.morphTargetsRelative = true;
    const bag = new Mesh(geometry, material);
    bag.morphTargetInfluences = mask.morphTargetInfluences;
    bag.frustumCulled = false;
    mask.add(bag);
  }
}
