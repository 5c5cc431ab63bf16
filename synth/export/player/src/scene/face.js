// SPDX-License-Identifier: GPL-3.0-or-later

import { AnimationMixer, Box3, DoubleSide, LoopOnce, Matrix4, MeshPhysicalMaterial, Sphere, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { bytesFromBase64 } from '../bytes.js';
import { DataError } from '../data.js';
import { completeNormals } from './normals.js';
import { lineOpenings } from './openings.js';

const mm_per_m = 1000;
const head_name = 'head';
const face_share = 0.12;
const frame_margin = 0.06; // of the size, on every side

function parseGlb(bytes) {
  return new Promise((resolve, reject) => new GLTFLoader().parse(bytes.buffer, '', resolve, reject));
}

async function readGlb(base64) {
  if (typeof base64 !== 'string' || base64 === '') throw new DataError('This page holds no face ("glb" is empty).');
  try {
    return await parseGlb(bytesFromBase64(base64));
  } catch (cause) {
    throw new DataError(`The face in this page cannot be read (${cause?.message ?? cause}).`, { cause });
  }
}

/** Skin for a file that names no material. */
function defaultSkin() {
  return new MeshPhysicalMaterial({
    name: 'default skin',
    color: 0xd9a991,
    roughness: 0.58,
    sheen: 0.2,
    sheenRoughness: 0.55,
    sheenColor: 0xe8a58c,
    side: DoubleSide,
  });
}

/** How far the farthest-moving target takes each vertex. @returns {Float32Array} */
function morphReach(geometry) {
  const reach = new Float32Array(geometry.attributes.position.count);
  for (const target of geometry.morphAttributes.position ?? []) {
    for (let i = 0; i < reach.length; ++i) {
      reach[i] = Math.max(reach[i], Math.hypot(target.getX(i), target.getY(i), target.getZ(i)));
    }
  }
  return reach;
}

const greatest = (values) => values.reduce((most, value) => Math.max(most, value), 0);

/** The face of the page: its meshes, its one animation, and where each vertex is at the set time. */
export class Face {
  /**
   * @param {string} base64 a GLB in metres, y up, facing +z
   * @throws {DataError}
   */
  static async load(base64) { return new Face(await readGlb(base64)); }

  constructor(gltf) {
    this.root = gltf.scene;
    this.head = this.root.getObjectByName(head_name) ?? this.root;
    this.meshes = [];
    this.by_primitive = new Map();
    this.collectMeshes(gltf.parser);
    if (this.meshes.length === 0) throw new DataError('The face in this page has no mesh.');
    if (this.meshes.length === 1) lineOpenings(this.meshes[0]);
    this.clip = gltf.animations[0] ?? null;
    if (this.clip) {
      this.mixer = new AnimationMixer(this.root);
      this.action = this.mixer.clipAction(this.clip);
      this.action.setLoop(LoopOnce, 1);
      this.action.clampWhenFinished = true;
      this.action.play();
    }
    this.setTime(0);
  }

  collectMeshes(parser) {
    const skin = defaultSkin();
    this.root.traverse((object) => {
      if (!object.isMesh) return;
      const { meshes: mesh = -1, primitives: primitive = 0 } = parser.associations.get(object) ?? {};
      const key = `${mesh}/${primitive}`;
      if (!this.by_primitive.has(key)) this.by_primitive.set(key, object);
      if (parser.json.meshes[mesh]?.primitives[primitive]?.material === undefined) object.material = skin;
      if (!object.geometry.attributes.normal) object.material.flatShading = false;
      completeNormals(object.geometry);
      object.frustumCulled = false;
      this.meshes.push(object);
    });
  }

  /** @param {number} time seconds; the last pose holds after the animation's end */
  setTime(time) {
    if (this.action) {
      this.action.paused = false;
      this.action.enabled = true;
      this.action.time = Math.min(Math.max(time, 0), this.clip.duration);
      this.mixer.update(0);
    }
    this.root.updateMatrixWorld(true);
  }

  meshAt(mesh, primitive) {
    const found = this.by_primitive.get(`${mesh}/${primitive}`);
    if (!found) throw new RangeError(`the face has no primitive ${primitive} of mesh ${mesh}`);
    return found;
  }

  /** Vertex in metres in world axes, morphs applied. */
  worldPoint(mesh, primitive, vertex) {
    const object = this.meshAt(mesh, primitive);
    const { count } = object.geometry.attributes.position;
    if (!Number.isInteger(vertex) || vertex < 0 || vertex >= count) {
      throw new RangeError(`vertex ${vertex} is outside 0..${count - 1}`);
    }
    return object.getVertexPosition(vertex, new Vector3()).applyMatrix4(object.matrixWorld);
  }

  /**
   * Vertex at the set time, morphs applied, in the head's own axes (its motion taken out).
   * @returns {[number, number, number]} mm
   */
  vertex(mesh, primitive, vertex) {
    const to_head = new Matrix4().copy(this.head.matrixWorld).invert();
    return this.worldPoint(mesh, primitive, vertex).applyMatrix4(to_head).multiplyScalar(mm_per_m).toArray();
  }

  /** As `vertex`, in world axes. @returns {[number, number, number]} mm */
  vertexWorld(mesh, primitive, vertex) {
    return this.worldPoint(mesh, primitive, vertex).multiplyScalar(mm_per_m).toArray();
  }

  /**
   * What the camera has to show, at the set time, in metres: everything but what is below the lowest
   * vertex that morphs to speak of, so that a bust does not make the face small.
   */
  faceBounds() {
    const reaches = this.meshes.map((mesh) => morphReach(mesh.geometry));
    const least = face_share * Math.max(...reaches.map(greatest));
    const whole = new Box3();
    let chin = Infinity;
    this.eachVertex((point, m, i) => {
      whole.expandByPoint(point);
      if (least > 0 && reaches[m][i] >= least) chin = Math.min(chin, point.y);
    });
    const bottom = chin === Infinity ? whole.min.y : chin;
    const face = new Box3();
    this.eachVertex((point) => {
      if (point.y >= bottom) face.expandByPoint(point);
    });
    return face.expandByVector(face.getSize(new Vector3()).multiplyScalar(frame_margin));
  }

  /** Calls visit(world point in metres, number of the mesh, vertex); the point is reused. */
  eachVertex(visit) {
    const point = new Vector3();
    this.meshes.forEach((mesh, m) => {
      for (let i = 0; i < mesh.geometry.attributes.position.count; ++i) {
        visit(mesh.getVertexPosition(i, point).applyMatrix4(mesh.matrixWorld), m, i);
      }
    });
  }

  /** Sphere about all that is drawn, in metres. */
  wholeSphere() { return new Box3().setFromObject(this.root, true).getBoundingSphere(new Sphere()); }
}
