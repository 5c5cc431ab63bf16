// SPDX-License-Identifier: GPL-3.0-or-later
//
// For tests/support/browser/drive.mjs: what main_job_test.py measures in a page of `synth`.
// Arguments: the number of times, evenly spaced, at which vertices are looked at.

export default async function ({ evaluate, screenshot, args }) {
  await evaluate(() => window.phonomime.ready);
  const measured = await evaluate((count) => {
    const page = window.phonomime;
    const { rate, values_mm } = page.apertureCurve();
    const { lip_upper_inner: upper, lip_lower_inner: lower } = page.data.landmarks;
    const height = ({ mesh, primitive, vertex }) => page.vertex(mesh, primitive, vertex)[1];
    const looks = Array.from({ length: count }, (_, i) => {
      const frame = Math.round(((i + 0.5) / count) * (values_mm.length - 1));
      page.seek(frame / rate);
      const vertices = Array.from({ length: 40 }, (_, v) => page.vertex(upper.mesh, upper.primitive, 7 * v));
      return { frame, aperture_mm: height(upper) - height(lower), vertices };
    });
    return {
      duration: page.duration, fps: page.fps, rate, aperture_mm: Array.from(values_mm), looks,
      facts: document.getElementById('facts').textContent,
      has_audio: page.hasAudio, audio_duration: page.audioDuration(),
    };
  }, Number(args[0]));
  await screenshot('middle');
  return measured;
}
