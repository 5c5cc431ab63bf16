// SPDX-License-Identifier: GPL-3.0-or-later

const byId = (id) => document.getElementById(id);
const rates = [0.25, 0.5, 1];
const views = { 1: 'front', 2: 'quarter', 3: 'side' };

const setPressed = (button, on) => button.setAttribute('aria-pressed', String(on));

/** Buttons under the face, both ways: clicks to the transport, its state back to the buttons. */
export function bindTransport(transport) {
  const clicks = {
    play: () => transport.toggle(),
    'to-start': () => transport.seek(0),
    'to-end': () => transport.seek(transport.duration),
    'step-back': () => transport.step(-1),
    'step-forward': () => transport.step(1),
    loop: () => transport.setLoop(!transport.loop),
    mute: () => transport.setMuted(!transport.muted),
  };
  for (const [id, act] of Object.entries(clicks)) byId(id).addEventListener('click', act);
  byId('mute').disabled = transport.sound === null;
  const rate_buttons = [...document.querySelectorAll('[data-rate]')];
  for (const button of rate_buttons) {
    button.addEventListener('click', () => transport.setRate(Number(button.dataset.rate)));
  }
  const scrubber = byId('scrubber');
  scrubber.max = String(transport.duration);
  scrubber.addEventListener('input', () => transport.jump(Number(scrubber.value)));

  const showState = () => {
    byId('play').classList.toggle('playing', transport.playing);
    byId('play').setAttribute('aria-label', transport.playing ? 'Pause' : 'Play');
    setPressed(byId('loop'), transport.loop);
    setPressed(byId('mute'), transport.muted);
    for (const button of rate_buttons) setPressed(button, Number(button.dataset.rate) === transport.rate);
  };
  const showTime = () => {
    const frame = Math.floor(transport.time * transport.fps + 1e-6);
    scrubber.value = String(transport.time);
    scrubber.style.setProperty('--done', `${(100 * transport.time) / transport.duration}%`);
    scrubber.setAttribute('aria-valuetext', `${transport.time.toFixed(2)} seconds, frame ${frame}`);
    byId('clock').textContent = `${transport.time.toFixed(3)} / ${transport.duration.toFixed(3)} s · frame ${frame}`;
  };
  transport.addEventListener('state', showState);
  transport.addEventListener('time', showTime);
  showState();
  showTime();
}

/** Camera and wireframe buttons. @param {import('./scene/stage.js').Stage} stage */
export function bindStage(stage) {
  for (const button of document.querySelectorAll('[data-view]')) {
    button.addEventListener('click', () => stage.frame(button.dataset.view));
  }
  const wireframe = byId('wireframe');
  wireframe.addEventListener('click', () => {
    const on = wireframe.getAttribute('aria-pressed') !== 'true';
    setPressed(wireframe, on);
    stage.setWireframe(on);
  });
}

/** Zoom buttons. @param {import('./timeline/timeline.js').Timeline} timeline */
export function bindTimeline(timeline) {
  byId('zoom-in').addEventListener('click', () => timeline.zoom(1));
  byId('zoom-out').addEventListener('click', () => timeline.zoom(-1));
  byId('zoom-fit').addEventListener('click', () => timeline.fit());
}

/** @param {'timeline' | 'table'} chosen */
export function showTab(chosen) {
  for (const name of ['timeline', 'table']) {
    byId(name).hidden = name !== chosen;
    byId(`tab-${name}`).setAttribute('aria-selected', String(name === chosen));
    byId(`tab-${name}`).tabIndex = name === chosen ? 0 : -1;
  }
  byId('zoom').hidden = chosen !== 'timeline';
  document.querySelector('.legend').hidden = chosen !== 'timeline';
}

/** What needs no data: tabs and help. */
export function bindPage() {
  for (const name of ['timeline', 'table']) {
    const tab = byId(`tab-${name}`);
    tab.addEventListener('click', () => showTab(name));
    tab.addEventListener('keydown', (event) => {
      if (event.key !== 'ArrowLeft' && event.key !== 'ArrowRight') return;
      event.stopPropagation();
      const other = name === 'timeline' ? 'table' : 'timeline';
      showTab(other);
      byId(`tab-${other}`).focus();
    });
  }
  byId('help-open').addEventListener('click', () => byId('help').showModal());
  // A button that was clicked by pointer must not take the space bar from play and pause.
  document.addEventListener('click', (event) => {
    if (event.detail > 0) event.target.closest('.app button')?.blur();
  });
}

function nextRate(rate, by) {
  return rates[Math.min(Math.max(rates.indexOf(rate) + by, 0), rates.length - 1)];
}

/** The start of the phoneme before or after the one at the playhead. */
function neighbourStart(phonemes, time, by) {
  const starts = phonemes.map(({ start }) => start);
  const found = by > 0 ? starts.find((start) => start > time + 1e-6) : starts.reverse().find((start) => start < time - 1e-6);
  return found ?? time;
}

/** Keys of the whole page, as the help lists them. */
export function bindKeys(transport, timeline, data) {
  const press = (id) => byId(id).click();
  const keys = {
    ' ': () => transport.toggle(),
    ArrowLeft: (event) => transport.step(event.shiftKey ? -10 : -1),
    ArrowRight: (event) => transport.step(event.shiftKey ? 10 : 1),
    PageUp: () => transport.seek(neighbourStart(data.phonemes, transport.time, -1)),
    PageDown: () => transport.seek(neighbourStart(data.phonemes, transport.time, 1)),
    Home: () => transport.seek(0),
    End: () => transport.seek(transport.duration),
    '[': () => transport.setRate(nextRate(transport.rate, -1)),
    ']': () => transport.setRate(nextRate(transport.rate, 1)),
    l: () => press('loop'),
    m: () => press('mute'),
    w: () => press('wireframe'),
    '+': () => timeline.zoom(1),
    '=': () => timeline.zoom(1),
    '-': () => timeline.zoom(-1),
    0: () => timeline.fit(),
    '?': () => press('help-open'),
    ...Object.fromEntries(Object.entries(views).map(([key, view]) => [
      key, () => document.querySelector(`[data-view="${view}"]`).click(),
    ])),
  };
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || byId('help').open) return;
    if (event.key === ' ' && event.target.closest('button')) return;
    const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    act(event);
  });
}
