// SPDX-License-Identifier: GPL-3.0-or-later
//
// One sentence against its recording: the players, and curves over time with one cursor.

const chosen = { sentence: null, plots: [] };
const made = (sentence, id) => sentence.methods.find((method) => method.id === id);
const shownMethods = () => (byId('all-methods').checked ? chosen.sentence.methods : [made(chosen.sentence, byId('pick-method').value)]);

// The curves of the plots, each of a recording or of a method.
function curvePlots() {
  const { sentence } = chosen;
  const group = Number(byId('pick-group').value);
  const axis = face.channels === 1 ? 0 : Number(byId('pick-axis').value);
  const plots = [];
  if (sentence.recorded.aperture) plots.push({ caption: 'aperture', unit: 'mm', of: (motion) => motion.aperture, line: report.closed_aperture });
  if (sentence.recorded.width) plots.push({ caption: 'width', unit: 'mm', of: (motion) => motion.width });
  const position = (motion) => trace(motion.trace, group, axis);
  const name = face.groups[sentence.recorded.trace.groups[group]].name;
  const unit = face.channels === 3 ? 'mm' : '';
  plots.push({ caption: `trajectory of ${name}`, unit, of: position });
  plots.push({ caption: `velocity of ${name}`, unit: unit ? 'mm/s' : '1/s', of: (motion) => velocity(position(motion), motion.trace.rate) });
  plots.push({ caption: 'squared error of each frame (E13)', unit: prettyUnit(measures.get('squared_error').unit), of: (motion) => motion.error ?? null, fromZero: true });
  return plots;
}

function phonemeLane(svg, width, left) {
  const x = scale([0, clock.duration], [left, width - 8]);
  for (const [phoneme, start, end, demand] of chosen.sentence.rows) {
    const kind = phoneme === 'pau' ? 'silence' : demand;
    const box = shape('rect', { class: `phoneme ${kind}`, x: x(start), y: 1, width: Math.max(0, x(end) - x(start)), height: 20 });
    tip(box, `/${phoneme}/ ${start.toFixed(2)} to ${end.toFixed(2)} s${demand === 'none' ? '' : `\nasks for ${demand}`}`);
    svg.append(box);
    if (phoneme !== 'pau' && x(end) - x(start) > 7 * phoneme.length) {
      svg.append(shape('text', { class: 'label', x: x((start + end) / 2), y: 15 }, phoneme));
    }
  }
}

function curveFrame(svg, width, height, left, curves, plot) {
  const { sentence } = chosen;
  const domain = range([...curves.flatMap(({ values }) => values), ...(plot.fromZero ? [0] : []), ...(plot.line === undefined ? [] : [plot.line])], plot.fromZero ? 0.03 : 0.06);
  if (plot.fromZero) domain[0] = 0;
  const x = scale([0, clock.duration], [left, width - 8]);
  const y = scale(domain, [height - 16, 4]);
  const [first, end] = sentence.speech.map((frame) => frame / report.rate);
  for (const [from, to] of [[0, first], [end, clock.duration]]) {
    svg.append(shape('rect', { class: 'band', x: x(from), y: 4, width: Math.max(0, x(to) - x(from)), height: height - 20 }));
  }
  verticalAxis(svg, y, domain, left, width - 8, 4);
  horizontalAxis(svg, x, [0, clock.duration], 4, height - 16, Math.max(3, Math.round(width / 110)), (value, step) => `${tickText(value, step)} s`);
  if (plot.line !== undefined) svg.append(shape('line', { class: 'target', x1: left, x2: width - 8, y1: y(plot.line), y2: y(plot.line) }));
  return { x, y };
}

function drawCurves(svg, width, height, plot) {
  const left = 46;
  const { sentence } = chosen;
  const recorded = plot.of(sentence.recorded);
  const curves = [];
  if (recorded) curves.push({ id: 'recording', values: recorded, color: 'var(--recorded)', dash: '5 3' });
  for (const method of shownMethods()) {
    const values = plot.of(method);
    if (values) curves.push({ id: method.id, values, color: methodColor(method.id), dash: '' });
  }
  const { x, y } = curveFrame(svg, width, height, left, curves, plot);
  const only = shownMethods();
  for (const [frame, captured] of only.length === 1 ? only[0].joins : []) {
    const time = (frame - 0.5) / report.rate;
    if (!captured) svg.append(shape('line', { class: 'join', x1: x(time), x2: x(time), y1: height - 21, y2: height - 16 }));
  }
  for (const { values, color, dash } of curves) {
    svg.append(shape('path', { class: 'line', d: pathOf(values, (i) => x(i / report.rate), y), style: `stroke:${color}`, 'stroke-dasharray': dash }));
  }
  const cursor = shape('line', { class: 'cursor', y1: 4, y2: height - 16 });
  svg.append(cursor);
  const catcher = shape('rect', { x: left, y: 0, width: width - 8 - left, height: height - 12, fill: 'transparent' });
  const timeOf = (event) => {
    const box = svg.getBoundingClientRect();
    return (((event.clientX - box.left) * (width / box.width) - left) / (width - 8 - left)) * clock.duration;
  };
  const seek = (event) => {
    setPlaying(false);
    setTime(timeOf(event));
  };
  catcher.addEventListener('pointerdown', (event) => {
    catcher.setPointerCapture(event.pointerId);
    seek(event);
  });
  catcher.addEventListener('pointermove', (event) => { if (event.buttons) seek(event); });
  tip(catcher, (event) => {
    const frame = Math.round(timeOf(event) * report.rate);
    return [`${(frame / report.rate).toFixed(2)} s`, ...curves.map(({ id, values }) => `${id}: ${number(values[frame], 2)} ${plot.unit}`)].join('\n');
  });
  svg.append(catcher);
  return (time) => {
    cursor.setAttribute('x1', x(time));
    cursor.setAttribute('x2', x(time));
  };
}

function drawSentencePlots() {
  const place = byId('curves');
  const forget = new Set(chosen.plots.map(({ redraw }) => redraw));
  listeners.splice(0, listeners.length, ...listeners.filter((listener) => !forget.has(listener)));
  place.replaceChildren();
  chosen.cursors = [];
  chosen.plots = [figure(place, 'phonemes', 'closures and contacts tinted', 24, (svg, width) => phonemeLane(svg, width, 46))];
  curvePlots().forEach((plot, index) => {
    chosen.plots.push(figure(place, plot.caption, plot.unit, 128, (svg, width, height) => {
      chosen.cursors[index] = drawCurves(svg, width, height, plot);
      chosen.cursors[index](clock.time);
    }));
  });
  legend(byId('curve-legend'), [['recording (dashed)', 'var(--recorded)'],
    ...shownMethods().map(({ id }) => [id, methodColor(id)]), ['join', 'var(--m1)']]);
}

function drawPlayers(time) {
  if (face.channels !== 3) return;
  const { sentence } = chosen;
  const recorded = poseAt(motionOf(sentence.recorded.motion), time);
  const method = made(sentence, byId('pick-method').value);
  drawFace(byId('view-recorded'), recorded, null);
  drawFace(byId('view-made'), poseAt(motionOf(method.motion), time), byId('ghost').checked ? recorded : null);
}

function chooseSentence(index) {
  chosen.sentence = report.shown[index];
  byId('pick-sentence').value = String(index);
  setPlaying(false);
  const { sentence } = chosen;
  const last = (sentence.frames - 1) / report.rate;
  clock.duration = Math.max(last, 1e-3);
  byId('scrubber').max = String(clock.duration);
  byId('sentence-text').textContent = sentence.text ? `“${sentence.text}”` : '';
  const wanted = byId('pick-method').value || report.main_method;
  fillSelect(byId('pick-method'), sentence.methods.map(({ id }) => [id, id]));
  byId('pick-method').value = made(sentence, wanted) ? wanted : sentence.methods[0].id;
  refreshSentence();
}

function refreshSentence() {
  byId('caption-made').textContent = byId('pick-method').value;
  drawSentencePlots();
  setTime(clock.time);
}

function setUpSentence() {
  if (report.shown.length === 0) return;
  show('sentence');
  const label = ({ key, worst, error }) => `${key}  (${worst ? 'among the worst' : 'by lot'}, E13 ${number(error, 2)})`;
  fillSelect(byId('pick-sentence'), report.shown.map((sentence, index) => [String(index), label(sentence)]));
  const { groups } = report.shown[0].recorded.trace;
  fillSelect(byId('pick-group'), groups.map((group, index) => [String(index), face.groups[group].name + (face.groups[group].landmark ? ` (${face.groups[group].landmark.replaceAll('_', ' ')})` : '')]), '0');
  byId('axis-label').hidden = face.channels === 1;
  byId('player').hidden = face.channels !== 3;
  clock.watchers.push((time) => {
    byId('scrubber').value = String(time);
    byId('clock').textContent = `${time.toFixed(2)} / ${clock.duration.toFixed(2)} s`;
    chosen.cursors?.forEach((move) => move(time));
    drawPlayers(time);
  });
  byId('pick-sentence').addEventListener('change', (event) => chooseSentence(Number(event.target.value)));
  byId('pick-method').addEventListener('change', refreshSentence);
  for (const id of ['pick-group', 'pick-axis', 'all-methods']) byId(id).addEventListener('change', refreshSentence);
  setUpPlayer();
  chooseSentence(0);
  const { speech } = chosen.sentence;
  setTime((speech[0] + speech[1]) / 2 / report.rate);
}
