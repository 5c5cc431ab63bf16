// SPDX-License-Identifier: GPL-3.0-or-later

import { DirectionalLight, Group, HemisphereLight } from 'three';

function lamp(colour, intensity, x, y, z, radius, centre) {
  const light = new DirectionalLight(colour, intensity);
  light.position.set(x, y, z).multiplyScalar(radius).add(centre);
  light.target.position.copy(centre);
  return light;
}

function castShadow(light, radius) {
  light.castShadow = true;
  light.shadow.mapSize.set(2048, 2048);
  light.shadow.radius = 5;
  light.shadow.normalBias = radius * 0.012;
  light.shadow.bias = -0.0004;
  Object.assign(light.shadow.camera, {
    left: -radius, right: radius, top: radius, bottom: -radius, near: radius * 0.5, far: radius * 6,
  });
}

/**
 * Key from the left above the eyes, fill from the right, rim from behind, and a little sky.
 * @param {import('three').Vector3} centre of the face
 * @param {number} radius of the sphere about it, metres
 */
export function studioLights(centre, radius) {
  const group = new Group();
  const key = lamp(0xfff0e2, 2.15, -1.5, 1.5, 2.4, radius, centre);
  castShadow(key, radius);
  const fill = lamp(0xcfdcff, 0.4, 2.2, 0.2, 1.8, radius, centre);
  const rim = lamp(0xdfe8ff, 1.5, 1.4, 1.8, -2.4, radius, centre);
  const back = lamp(0xffe2c8, 0.6, -2.2, 0.6, -1.6, radius, centre);
  const sky = new HemisphereLight(0xe6ecf5, 0x5a4c44, 0.75);
  for (const light of [key, fill, rim, back]) group.add(light, light.target);
  group.add(sky);
  return group;
}
