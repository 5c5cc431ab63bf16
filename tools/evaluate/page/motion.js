// SPDX-License-Identifier: GPL-3.0-or-later
//
// The motion of the shown sentences, unpacked when it is first asked for.

const { face } = report;

/** Numbers of 16 bits, little-endian, in base64; `step` is the size of one. */
function unpack(text, step) {
  const bytes = atob(text);
  const values = new Float32Array(bytes.length / 2);
  for (let i = 0; i < values.length; ++i) {
    const word = bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8);
    values[i] = (word > 32767 ? word - 65536 : word) * step;
  }
  return values;
}

/**
 * Frames by channels, offsets from the face's mean pose.
 * @param {object} packed {rate, frames, groups (indices), data}
 */
function motionOf(packed) {
  packed.values ??= unpack(packed.data, face.step);
  const width = packed.groups.length * face.channels;
  return {
    ...packed,
    at: (frame, group, axis) => face.pose[packed.groups[group]][axis] + packed.values[frame * width + group * face.channels + axis],
  };
}

/** The frames of a motion at a time, linear between two of them: a function of (group, axis). */
function poseAt(motion, time) {
  const place = Math.max(0, Math.min(motion.frames - 1, time * motion.rate));
  const first = Math.min(Math.floor(place), Math.max(0, motion.frames - 2));
  const share = motion.frames > 1 ? place - first : 0;
  const second = Math.min(first + 1, motion.frames - 1);
  return (group, axis) => (1 - share) * motion.at(first, group, axis) + share * motion.at(second, group, axis);
}

/** One channel of a trace over all frames, and its one-sided velocity. */
function trace(packed, group, axis) {
  const motion = motionOf(packed);
  return Array.from({ length: motion.frames }, (_, frame) => motion.at(frame, group, axis));
}
function velocity(values, rate) {
  return values.map((value, i) => (i === 0 ? null : (value - values[i - 1]) * rate));
}
