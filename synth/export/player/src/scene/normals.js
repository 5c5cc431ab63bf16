// SPDX-License-Identifier: GPL-3.0-or-later

import { BufferAttribute } from 'three';

/** Above this many (vertices x targets) the file's own normals have to do. */
const work_limit = 4e6;

/** For each vertex the first one at the same place, so that seams shade as one surface. */
export function weldedIndices(position) {
  const first = new Map();
  return Uint32Array.from({ length: position.count }, (_, i) => {
    const key = `${position.getX(i)},${position.getY(i)},${position.getZ(i)}`;
    if (!first.has(key)) first.set(key, i);
    return first.get(key);
  });
}

/** Vertex indices, three a triangle. */
export function trianglesOf({ index, attributes }) {
  return index ? index.array : Uint32Array.from({ length: attributes.position.count }, (_, i) => i);
}

/** Vertex normals of a triangle mesh, weighted by area. `points` is 3 floats a vertex. */
function vertexNormals(points, triangles, welded) {
  const normals = new Float32Array(points.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t];
    const b = 3 * triangles[t + 1];
    const c = 3 * triangles[t + 2];
    const ux = points[b] - points[a], uy = points[b + 1] - points[a + 1], uz = points[b + 2] - points[a + 2];
    const vx = points[c] - points[a], vy = points[c + 1] - points[a + 1], vz = points[c + 2] - points[a + 2];
    const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    for (let corner = 0; corner < 3; ++corner) {
      const i = 3 * welded[triangles[t + corner]];
      normals[i] += nx;
      normals[i + 1] += ny;
      normals[i + 2] += nz;
    }
  }
  for (let v = 0; v < welded.length; ++v) {
    const from = 3 * welded[v];
    const length = Math.hypot(normals[from], normals[from + 1], normals[from + 2]) || 1;
    // A welded vertex comes before the ones that refer to it and has length 1 by then.
    for (let k = 0; k < 3; ++k) normals[3 * v + k] = normals[from + k] / length;
  }
  return normals;
}

function plainArray(attribute) {
  const values = new Float32Array(attribute.count * 3);
  for (let i = 0; i < attribute.count; ++i) {
    for (let k = 0; k < 3; ++k) values[3 * i + k] = attribute.getComponent(i, k);
  }
  return values;
}

/**
 * Gives the geometry what the file leaves out: normals, and the change of the normals with each
 * morph target (the difference between half a step either way), so that lips shade as they move.
 * @param {import('three').BufferGeometry} geometry triangles; changed in place
 */
export function completeNormals(geometry) {
  const { position } = geometry.attributes;
  const targets = geometry.morphAttributes.position ?? [];
  const wants_morphs = targets.length > 0 && !geometry.morphAttributes.normal && geometry.morphTargetsRelative;
  if (geometry.attributes.normal && !wants_morphs) return;

  const triangles = trianglesOf(geometry);
  const welded = weldedIndices(position);
  const rest = plainArray(position);
  if (!geometry.attributes.normal) {
    geometry.setAttribute('normal', new BufferAttribute(vertexNormals(rest, triangles, welded), 3));
  }
  if (!wants_morphs || position.count * targets.length > work_limit) return;
  geometry.morphAttributes.normal = targets.map((target) => {
    const offset = plainArray(target);
    const ahead = vertexNormals(rest.map((x, i) => x + 0.5 * offset[i]), triangles, welded);
    const behind = vertexNormals(rest.map((x, i) => x - 0.5 * offset[i]), triangles, welded);
    return new BufferAttribute(ahead.map((x, i) => x - behind[i]), 3);
  });
}
