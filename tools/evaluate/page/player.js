// SPDX-License-Identifier: GPL-3.0-or-later
//
// Two faces of markers side by side, and the clock that drives them and the curves.

const regionColors = {
  lips: '#ff8fa3', jaw: '#f2c57c', cheeks: '#8fb8de', nose: '#b7c4d1', brows: '#9fd8b4', eyelids: '#c9b6f2', forehead: '#93a7b8', rigid: '#66727f',
};
const clock = { time: 0, duration: 1, playing: false, started: 0, from: 0, watchers: [] };

function setTime(time) {
  clock.time = Math.max(0, Math.min(clock.duration, time));
  if (clock.playing) [clock.started, clock.from] = [performance.now(), clock.time];
  for (const watcher of clock.watchers) watcher(clock.time);
}

function setPlaying(playing) {
  clock.playing = playing;
  byId('play').textContent = playing ? 'Pause' : 'Play';
  if (!playing) return;
  if (clock.time >= clock.duration - 1e-3) setTime(0);
  [clock.started, clock.from] = [performance.now(), clock.time];
  requestAnimationFrame(tick);
}

function tick(now) {
  if (!clock.playing) return;
  const time = clock.from + ((now - clock.started) / 1000) * Number(byId('speed').value);
  clock.time = Math.min(time, clock.duration);
  for (const watcher of clock.watchers) watcher(clock.time);
  if (time >= clock.duration) setPlaying(false);
  else requestAnimationFrame(tick);
}

/** The part of the face's plane that is in view: all of it, or the mouth. */
function viewBox() {
  const mouth = byId('zoom').value === 'mouth';
  const groups = face.groups.map((group, index) => ({ group, index }))
    .filter(({ group }) => !mouth || group.region === 'lips' || group.region === 'jaw');
  const points = (groups.length ? groups : face.groups.map((group, index) => ({ group, index })))
    .map(({ index }) => face.pose[index]);
  const [left, right] = range(points.map(([x]) => x), 0.08);
  const [low, high] = range(points.map(([, y]) => y), 0.1);
  return { x: (left + right) / 2, y: (low + high) / 2, width: right - left, height: high - low };
}

function drawFace(canvas, pose, ghost) {
  const density = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (canvas.width !== Math.round(width * density)) canvas.width = Math.round(width * density);
  if (canvas.height !== Math.round(height * density)) canvas.height = Math.round(height * density);
  const box = viewBox();
  const zoom = Math.min(width / box.width, height / box.height);
  const at = (from, group) => [width / 2 + (from(group, 0) - box.x) * zoom, height / 2 - (from(group, 1) - box.y) * zoom];
  const context = canvas.getContext('2d');
  context.setTransform(density, 0, 0, density, 0, 0);
  context.clearRect(0, 0, width, height);
  const lines = (from, color, thickness) => {
    context.strokeStyle = color;
    context.lineWidth = thickness;
    context.beginPath();
    for (const [a, b] of face.edges) {
      context.moveTo(...at(from, a));
      context.lineTo(...at(from, b));
    }
    context.stroke();
  };
  if (ghost) lines(ghost, '#ffffff55', 1);
  for (const [region, color] of Object.entries(regionColors)) {
    context.strokeStyle = `${color}aa`;
    context.fillStyle = color;
    context.lineWidth = 1.4;
    context.beginPath();
    for (const [a, b] of face.edges) {
      if (face.groups[a].region !== region) continue;
      context.moveTo(...at(pose, a));
      context.lineTo(...at(pose, b));
    }
    context.stroke();
    face.groups.forEach((group, index) => {
      if (group.region !== region) return;
      context.beginPath();
      context.arc(...at(pose, index), zoom > 4 ? 3.2 : 2.2, 0, 2 * Math.PI);
      context.fill();
    });
  }
}

function setUpPlayer() {
  const step = (frames) => {
    setPlaying(false);
    setTime(clock.time + frames / report.rate);
  };
  byId('play').addEventListener('click', () => setPlaying(!clock.playing));
  byId('scrubber').addEventListener('input', (event) => {
    setPlaying(false);
    setTime(Number(event.target.value));
  });
  byId('speed').addEventListener('change', () => setTime(clock.time));
  for (const id of ['zoom', 'ghost']) byId(id).addEventListener('change', () => setTime(clock.time));
  document.addEventListener('keydown', (event) => {
    if (/^(INPUT|SELECT|TEXTAREA|BUTTON|SUMMARY)$/.test(event.target.tagName) && event.key === ' ') return;
    if (/^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName)) return;
    if (event.key === ' ') setPlaying(!clock.playing);
    else if (event.key === 'ArrowLeft') step(-1);
    else if (event.key === 'ArrowRight') step(1);
    else return;
    event.preventDefault();
  });
  listeners.push(() => setTime(clock.time));
}
