// SPDX-License-Identifier: GPL-3.0-or-later

/** Lips less than this far apart count as closed (mm). */
export const closed_mm = 1.5;

const most_samples = 20000;

/**
 * The distance of the inner lips at the face's set time, along the head's vertical axis: negative
 * where the lips overlap.
 * @param {import('./scene/face.js').Face} face
 * @param {Record<string, import('./data.js').Landmark>} landmarks
 * @returns {number | null} mm; null where the landmarks are not named
 */
export function aperture(face, landmarks) {
  const { lip_upper_inner: upper, lip_lower_inner: lower } = landmarks;
  if (!upper || !lower) return null;
  const height = ({ mesh, primitive, vertex }) => face.vertex(mesh, primitive, vertex)[1];
  return height(upper) - height(lower);
}

/**
 * The aperture at every frame. Leaves the face at time 0.
 * @returns {{rate: number, values_mm: Float32Array} | null}
 */
export function apertureCurve(face, { landmarks, duration, fps }) {
  if (aperture(face, landmarks) === null) return null;
  const rate = Math.min(fps, most_samples / duration);
  const values_mm = Float32Array.from({ length: Math.floor(duration * rate + 1e-6) + 1 }, (_, frame) => {
    face.setTime(frame / rate);
    return aperture(face, landmarks);
  });
  face.setTime(0);
  return { rate, values_mm };
}

/** The smallest aperture of the frames in [start, end), or of the nearest one where there is none. */
export function smallestAperture({ rate, values_mm }, start, end) {
  const nearest = Math.min(values_mm.length - 1, Math.round(((start + end) / 2) * rate));
  const inside = values_mm.subarray(Math.ceil(start * rate - 1e-6), Math.ceil(end * rate - 1e-6));
  return inside.length > 0 ? Math.min(...inside) : values_mm[nearest];
}
