// SPDX-License-Identifier: GPL-3.0-or-later

import {
  Mesh, MeshBasicMaterial, NeutralToneMapping, PCFShadowMap, PerspectiveCamera, Scene,
  Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { studioLights } from './lights.js';

const view_angle_deg = 26;
const directions = { front: [0, 0.02, 1], quarter: [0.72, 0.08, 1], side: [1, 0.03, 0.04] };

function makeRenderer(canvas) {
  try {
    return new WebGLRenderer({ canvas, antialias: true, alpha: true });
  } catch (cause) {
    throw new Error('This browser shows no 3-D graphics (WebGL 2 is not available).', { cause });
  }
}

/** Canvas, camera, light and face. Draws when told to, or when the camera moves. */
export class Stage {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {import('./face.js').Face} face
   * @throws {Error} where the browser has no WebGL
   */
  constructor(canvas, face) {
    this.canvas = canvas;
    this.face = face;
    this.renderer = makeRenderer(canvas);
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.toneMappingExposure = 1;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.box = face.faceBounds();
    this.centre = this.box.getCenter(new Vector3());
    this.sphere = face.wholeSphere();
    this.camera = new PerspectiveCamera(view_angle_deg, 1, this.sphere.radius / 50, this.sphere.radius * 60);
    this.buildScene();
    this.view = 'front';
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.minDistance = this.sphere.radius * 0.4;
    this.controls.maxDistance = this.sphere.radius * 20;
    this.controls.addEventListener('change', () => this.draw());
    this.controls.addEventListener('start', () => { this.view = null; });
    canvas.addEventListener('webglcontextrestored', () => this.draw());
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  buildScene() {
    this.scene = new Scene();
    this.scene.add(this.face.root, studioLights(this.sphere.center, this.sphere.radius));
    for (const mesh of this.face.meshes) {
      mesh.castShadow = true;
      mesh.receiveShadow = true;
    }
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.view) this.frame(this.view);
    this.draw();
  }

  /**
   * Puts the whole face into the picture.
   * @param {'front' | 'quarter' | 'side'} view
   */
  frame(view) {
    this.view = view;
    const size = this.box.getSize(new Vector3());
    const direction = new Vector3(...directions[view]).normalize();
    const wide = Math.abs(direction.z) * size.x + Math.abs(direction.x) * size.z;
    const deep = Math.abs(direction.z) * size.z + Math.abs(direction.x) * size.x;
    const tangent = Math.tan((view_angle_deg * Math.PI) / 360);
    const distance = Math.max(size.y, wide / this.camera.aspect) / (2 * tangent) + deep / 4;
    this.controls.target.copy(this.centre);
    this.camera.position.copy(this.centre).addScaledVector(direction, distance);
    this.controls.update();
    this.draw();
  }

  /** Lays the mesh's edges over the skin, or takes them away. */
  setWireframe(on) {
    if (on && !this.wires) {
      const material = new MeshBasicMaterial({ wireframe: true, color: 0x9fe0ff, transparent: true, opacity: 0.32 });
      this.wires = this.face.meshes.map((mesh) => {
        const wire = new Mesh(mesh.geometry, material);
        wire.morphTargetInfluences = mesh.morphTargetInfluences;
        wire.frustumCulled = false;
        mesh.add(wire);
        return wire;
      });
    }
    this.wires?.forEach((wire) => { wire.visible = on; });
    for (const { material } of this.face.meshes) {
      Object.assign(material, { polygonOffset: on, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    }
    this.draw();
  }

  draw() { this.renderer.render(this.scene, this.camera); }
}
