// SPDX-License-Identifier: GPL-3.0-or-later
//
// A face whose every vertex is known in closed form at every time, as a GLB, and a tone as a WAV.
//
// Mesh 0 under "head", moved by `mesh_offset`: two primitives (the first without material and
// normals), a half sphere of radius 0.1 m each, with two morph targets: 0 drops what is below the
// middle by `drop`, 1 swells by `swell`. Mesh 1, also under "head", is a triangle without targets.
// Over `duration` weight 0 goes linearly 0, 1, 0 and weight 1 goes linearly 0, -1; the head turns
// about y by `turn` and moves along x by `shift`, both linearly.

export const duration = 1.6; // s; half of it falls on a key
export const fps = 30;
export const radius = 0.1; // m
const rows = 13;
const columns = 17;
const drop = 0.02; // m
const swell = 0.1; // of the radius
const turn = 0.5; // rad
const shift = 0.03; // m
const mesh_offset = [0.001, 0.01, -0.002]; // m
const eye_offset = [0.03, 0.02, 0.09]; // m
const eye = [[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0]];

const vertex_count = rows * columns;

/** Rest position of vertex `v` in its mesh, m. The half sphere faces +z. */
function rest(v) {
  const latitude = ((Math.floor(v / columns) / (rows - 1)) - 0.5) * Math.PI * 0.96;
  const longitude = (((v % columns) / (columns - 1)) - 0.5) * Math.PI * 0.96;
  return [
    radius * Math.cos(latitude) * Math.sin(longitude),
    radius * Math.sin(latitude),
    radius * Math.cos(latitude) * Math.cos(longitude),
  ].map(Math.fround);
}

const dropped = (v) => [0, rest(v)[1] < -0.001 ? -drop : 0, 0].map(Math.fround);
const swollen = (v) => rest(v).map((x) => Math.fround(swell * x));

const clamped = (time) => Math.min(Math.max(time, 0), duration);
const weights = (time) => [1 - Math.abs((2 * time) / duration - 1), -time / duration];

/** Where vertex `v` of `mesh` is in the head's axes, mm. */
export function expectedVertex(mesh, v, time) {
  if (mesh === 1) return eye[v].map((x, k) => 1000 * (x + eye_offset[k]));
  const [first, second] = weights(clamped(time));
  const [base, a, b] = [rest(v), dropped(v), swollen(v)];
  return base.map((x, k) => 1000 * (x + first * a[k] + second * b[k] + mesh_offset[k]));
}

/** As expectedVertex, in world axes. */
export function expectedWorld(mesh, v, time) {
  const [x, y, z] = expectedVertex(mesh, v, time);
  const angle = (turn * clamped(time)) / duration;
  return [
    Math.cos(angle) * x + Math.sin(angle) * z + (1000 * shift * clamped(time)) / duration,
    y,
    -Math.sin(angle) * x + Math.cos(angle) * z,
  ];
}

/** Vertices just above and below the middle, at x = 0. */
const middle_column = (columns - 1) / 2;
export const lip_upper = ((rows - 1) / 2) * columns + middle_column;
export const lip_lower = ((rows - 1) / 2 - 1) * columns + middle_column;
export const checked_vertices = [0, 5, lip_lower, lip_upper, vertex_count - 1];

/** Collects arrays into one binary chunk with its views and accessors. */
class Chunk {
  constructor() { Object.assign(this, { parts: [], length: 0, views: [], accessors: [] }); }

  add(values, type, bounded = false) {
    const bytes = Buffer.from(values.buffer);
    const size = { SCALAR: 1, VEC3: 3, VEC4: 4 }[type];
    const component = (pick, k) => pick(...values.filter((_, i) => i % size === k));
    const range = (pick) => Array.from({ length: size }, (_, k) => component(pick, k));
    this.views.push({ buffer: 0, byteOffset: this.length, byteLength: bytes.length });
    this.accessors.push({
      bufferView: this.views.length - 1,
      componentType: values instanceof Uint32Array ? 5125 : 5126,
      count: values.length / size,
      type,
      ...(bounded ? { min: range(Math.min), max: range(Math.max) } : {}),
    });
    this.parts.push(bytes);
    this.length += bytes.length;
    return this.accessors.length - 1;
  }
}

const each = (count, of) => Float32Array.from(Array.from({ length: count }, (_, i) => of(i)).flat());

function triangles() {
  const list = [];
  for (let row = 0; row + 1 < rows; ++row) {
    for (let column = 0; column + 1 < columns; ++column) {
      const corner = row * columns + column;
      list.push(corner, corner + 1, corner + columns + 1, corner, corner + columns + 1, corner + columns);
    }
  }
  return Uint32Array.from(list);
}

function padded(bytes, filler) {
  return Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4, filler)]);
}

function container(json, binary) {
  const chunks = [[0x4e4f534a, padded(Buffer.from(JSON.stringify(json)), ' ')], [0x004e4942, padded(binary, 0)]];
  const body = Buffer.concat(chunks.flatMap(([kind, bytes]) => {
    const head = Buffer.alloc(8);
    head.writeUInt32LE(bytes.length, 0);
    head.writeUInt32LE(kind, 4);
    return [head, bytes];
  }));
  const header = Buffer.alloc(12);
  header.write('glTF');
  header.writeUInt32LE(2, 4);
  header.writeUInt32LE(12 + body.length, 8);
  return Buffer.concat([header, body]);
}

/** @returns {Buffer} GLB */
export function knownGlb() {
  const chunk = new Chunk();
  const position = chunk.add(each(vertex_count, rest), 'VEC3', true);
  const normal = chunk.add(each(vertex_count, (v) => rest(v).map((x) => x / radius)), 'VEC3');
  const targets = [dropped, swollen].map((of) => ({ POSITION: chunk.add(each(vertex_count, of), 'VEC3', true) }));
  const indices = chunk.add(triangles(), 'SCALAR');
  const eye_position = chunk.add(Float32Array.from(eye.flat()), 'VEC3', true);
  const frames = Math.round(duration * fps) + 1;
  const time = (frame) => frame / fps;
  const input = chunk.add(each(frames, (frame) => [time(frame)]), 'SCALAR', true);
  const outputs = {
    weights: chunk.add(each(frames, (frame) => weights(time(frame))), 'SCALAR'),
    rotation: chunk.add(each(frames, (frame) => {
      const half = (turn * time(frame)) / duration / 2;
      return [0, Math.sin(half), 0, Math.cos(half)];
    }), 'VEC4'),
    translation: chunk.add(each(frames, (frame) => [(shift * time(frame)) / duration, 0, 0]), 'VEC3'),
  };
  return container({
    asset: { version: '2.0' },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [
      { name: 'head', children: [2, 1] },
      { name: 'face', mesh: 0, translation: mesh_offset },
      { name: 'eye', mesh: 1, translation: eye_offset },
    ],
    meshes: [
      {
        primitives: [
          { attributes: { POSITION: position }, indices, targets },
          { attributes: { POSITION: position, NORMAL: normal }, indices, targets, material: 0 },
        ],
        weights: [0, 0],
      },
      { primitives: [{ attributes: { POSITION: eye_position }, material: 0 }] },
    ],
    materials: [{ pbrMetallicRoughness: { baseColorFactor: [0.7, 0.5, 0.4, 1], metallicFactor: 0 }, doubleSided: true }],
    animations: [{
      samplers: Object.values(outputs).map((output) => ({ input, output, interpolation: 'LINEAR' })),
      channels: Object.keys(outputs).map((path, sampler) => ({
        sampler, target: { node: path === 'weights' ? 1 : 0, path },
      })),
    }],
    buffers: [{ byteLength: chunk.length }],
    bufferViews: chunk.views,
    accessors: chunk.accessors,
  }, Buffer.concat(chunk.parts));
}

/** A tone of `seconds`, 16 kHz mono, 16 bit. @returns {Buffer} WAV */
export function toneWav(seconds) {
  const rate = 16000;
  const samples = Int16Array.from({ length: Math.round(seconds * rate) }, (_, i) => 8000 * Math.sin(i * 0.17));
  const header = Buffer.alloc(44);
  header.write('RIFF', 0);
  header.writeUInt32LE(36 + samples.byteLength, 4);
  header.write('WAVEfmt ', 8);
  [[16, 4], [1, 2], [1, 2], [rate, 4], [rate * 2, 4], [2, 2], [16, 2]].reduce(
    (at, [value, bytes]) => header.writeUIntLE(value, at, bytes), 16);
  header.write('data', 36);
  header.writeUInt32LE(samples.byteLength, 40);
  return Buffer.concat([header, Buffer.from(samples.buffer)]);
}
