// SPDX-License-Identifier: GPL-3.0-or-later

import { bindKeys, bindPage, bindStage, bindTimeline, bindTransport, showTab } from './controls.js';
import { indexAt, readPageData } from './data.js';
import { installHooks } from './hooks.js';
import { aperture, apertureCurve } from './measure.js';
import { NowCard, showError, showFacts, showNotice, showTip } from './page.js';
import { Face } from './scene/face.js';
import { Stage } from './scene/stage.js';
import { Sound } from './sound.js';
import { PhonemeTable } from './table.js';
import { Timeline } from './timeline/timeline.js';
import { Transport } from './transport.js';

const byId = (id) => document.getElementById(id);

async function loadSound({ audio, audio_type: type }) {
  if (audio === null) return null;
  try {
    return await Sound.load(audio, type);
  } catch (error) {
    showNotice(`The audio cannot be played (${error.message}).`);
    return null;
  }
}

/** The face and its aperture curve. @throws where the file cannot be read or names no such vertex */
async function loadFace(data) {
  const face = await Face.load(data.glb);
  return { face, curve: apertureCurve(face, data) };
}

/** Joins the parts: the transport's time moves all of them. */
function connect({ data, transport, timeline, table, card, face, stage }) {
  const showTime = () => {
    const { time } = transport;
    const index = indexAt(data.phonemes, time);
    face?.setTime(time);
    stage?.draw();
    timeline.setTime(time, index);
    table.setCurrent(index);
    card.update(time, index, face ? aperture(face, data.landmarks) : null);
  };
  transport.addEventListener('time', showTime);
  transport.addEventListener('refused', () => showNotice('The browser does not start the audio: the motion plays in silence.'));
  let scheduled = false;
  const schedule = () => {
    if (scheduled || !transport.playing) return;
    scheduled = true;
    requestAnimationFrame((now_ms) => {
      scheduled = false;
      transport.tick(now_ms);
      schedule();
    });
  };
  transport.addEventListener('state', schedule);
  timeline.addEventListener('scrub', ({ detail }) => transport.jump(detail));
  showTime();
}

/** Everything but the data's own errors: those have no parts to show. */
async function start(hooks, data) {
  showFacts(data);
  hooks.add({ data, duration: data.duration, fps: data.fps });
  const sound = await loadSound(data);
  const loaded = await loadFace(data).catch((failure) => ({ face: null, curve: null, failure }));
  let { failure } = loaded;
  const { face, curve } = loaded;
  let stage = null;
  if (face) {
    try {
      stage = new Stage(byId('view'), face);
      bindStage(stage);
    } catch (error) {
      failure = error;
    }
  }

  const transport = new Transport(data.duration, data.fps, sound);
  const timeline = new Timeline(data, sound, curve);
  const table = new PhonemeTable(byId('table'), data, curve, (time) => transport.seek(time));
  timeline.addEventListener('hover', ({ detail }) => showTip(detail, data, curve));
  bindTransport(transport);
  bindTimeline(timeline);
  bindKeys(transport, timeline, data);
  connect({ data, transport, timeline, table, card: new NowCard(data, curve), face, stage });
  hooks.add({
    hasAudio: sound !== null,
    audioDuration: () => sound?.duration ?? null,
    seek: (time) => transport.seek(time),
    play: () => transport.play(),
    pause: () => transport.pause(),
    time: () => transport.time,
  });
  if (face) {
    hooks.add({
      vertex: (...at) => face.vertex(...at),
      vertexWorld: (...at) => face.vertexWorld(...at),
      aperture: () => aperture(face, data.landmarks),
      apertureCurve: () => curve && { rate: curve.rate, values_mm: [...curve.values_mm] },
    });
  }
  if (failure) throw failure;
  byId('busy').hidden = true;
}

const hooks = installHooks();
bindPage();
byId('title').textContent = document.title;
try {
  const data = readPageData(byId('phonomime-data').textContent);
  start(hooks, data).then(hooks.resolve, (error) => {
    showError(error);
    showTab('table');
    hooks.reject(error);
  });
} catch (error) {
  byId('app').classList.add('without-data');
  showError(error);
  hooks.reject(error);
}
