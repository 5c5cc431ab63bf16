// SPDX-License-Identifier: GPL-3.0-or-later
//
// By phoneme, by place on the face, by emotion and fold, and all sentences.

const phonemeMeasures = ['lip_rmse', 'squared_error', 'lip_vertex_error', 'velocity_error', 'aperture_correlation',
  'aperture_deviation_ratio', 'closure_recall', 'contact_share', 'contact_error', 'minimum_timing_error'];

function drawPhonemePlot() {
  const measure = measures.get(byId('pick-phoneme-measure').value);
  const rows = Object.keys(mainMethod.phonemes)
    .map((phoneme) => ({ phoneme, values: report.methods.map((method) => method.phonemes[phoneme]?.values[measure.id] ?? null) }))
    .filter(({ values }) => values.some(isNumber));
  const main = methodIndex.get(report.main_method);
  rows.sort((a, b) => (badness(measure, b.values[main]) ?? -Infinity) - (badness(measure, a.values[main]) ?? -Infinity));
  const place = byId('phoneme-plot');
  place.replaceChildren();
  if (phonemePlot) listeners.splice(listeners.indexOf(phonemePlot.redraw), 1);
  const line = 19;
  phonemePlot = figure(place, measure.label, unitText(measure), 24 + line * rows.length, (svg, width) => {
    const [left, right, top] = [84, width - 12, 4];
    const domain = range(rows.flatMap(({ values }) => values), 0.03);
    const x = scale(domain, [left, right]);
    horizontalAxis(svg, x, domain, top, top + line * rows.length, 8);
    rows.forEach(({ phoneme, values }, index) => {
      const y = top + line * (index + 0.5);
      svg.append(shape('text', { class: 'name', x: 0, y: y + 4 }, `/${phoneme}/`));
      svg.append(shape('text', { x: left - 8, y: y + 4, 'text-anchor': 'end' }, String(mainMethod.phonemes[phoneme].frames)));
      values.forEach((value, m) => {
        if (!isNumber(value)) return;
        const method = report.methods[m];
        const dot = shape('circle', { cx: x(value), cy: y, r: m === main ? 5 : 3.5, style: `fill:${methodColor(method.id)};fill-opacity:${m === main ? 1 : 0.6}` });
        tip(dot, `/${phoneme}/ ${method.id}: ${number(value, measure.decimals)} ${unitText(measure)}`);
        svg.append(dot);
      });
    });
  });
}
let phonemePlot = null;

function setUpPhonemes() {
  const known = phonemeMeasures.filter((id) => Object.values(mainMethod.phonemes).some(({ values }) => isNumber(values[id])));
  if (known.length === 0) return;
  show('phonemes');
  fillSelect(byId('pick-phoneme-measure'), known.map((id) => [id, measures.get(id).label]), known[0]);
  byId('pick-phoneme-measure').addEventListener('change', drawPhonemePlot);
  legend(byId('phoneme-legend'), report.methods.map(({ id }) => [id, methodColor(id)]));
  drawPhonemePlot();
}

// Each marker of the mean pose, as large and as red as its error.
function drawFaceMap() {
  const method = report.methods.find(({ id }) => id === byId('pick-map-method').value);
  const largest = Math.max(...report.methods.flatMap(({ groups }) => Object.values(groups)).filter(isNumber), 1e-9);
  const place = byId('face-map');
  place.replaceChildren();
  const svg = shape('svg', { viewBox: '0 0 400 440' });
  const [left, right] = range(face.pose.map(([x]) => x), 0.05);
  const [low, high] = range(face.pose.map(([, y]) => y), 0.05);
  const zoom = Math.min(400 / (right - left), 440 / (high - low));
  const at = (group) => [200 + (face.pose[group][0] - (left + right) / 2) * zoom, 220 - (face.pose[group][1] - (low + high) / 2) * zoom];
  for (const [a, b] of face.edges) {
    svg.append(shape('line', { class: 'axis', x1: at(a)[0], y1: at(a)[1], x2: at(b)[0], y2: at(b)[1] }));
  }
  face.groups.forEach((group, index) => {
    const error = method.groups[group.name];
    if (!isNumber(error)) return;
    const share = error / largest;
    const dot = shape('circle', { cx: at(index)[0], cy: at(index)[1], r: 2.5 + 9 * share, style: `fill:hsl(${(1 - share) * 190} 70% 48%);fill-opacity:0.8` });
    tip(dot, `${group.name} (${group.region})\nRMSE ${number(error, 2)} mm`);
    svg.append(dot);
  });
  place.append(svg);
}

function setUpPlaces() {
  const regions = Object.keys(mainMethod.regions).filter((region) => isNumber(mainMethod.regions[region]));
  const body = element('tbody');
  for (const method of report.methods) {
    const row = element('tr', { class: method.sees_recording ? 'bound' : method === mainMethod ? 'main' : null },
      element('td', {}, method.id));
    for (const region of regions) row.append(element('td', {}, number(method.regions[region], 3)));
    body.append(row);
  }
  const unit = unitText(measures.get('rmse'));
  byId('region-table').replaceChildren(tableHead([`RMSE, pooled${unit ? ` (${unit})` : ''}`, ...regions]), body);
  if (face.channels === 3 && report.shown.length > 0) {
    fillSelect(byId('pick-map-method'), methodOptions(), report.main_method);
    byId('pick-map-method').addEventListener('change', drawFaceMap);
    drawFaceMap();
  } else {
    byId('face-map').parentElement.hidden = true;
  }
  show('places');
}

function drawParts() {
  const method = report.methods.find(({ id }) => id === byId('pick-part-method').value);
  const body = element('tbody');
  for (const [what, parts] of [['', method.emotions], ['fold ', method.folds]]) {
    if (Object.keys(parts).length < 2) continue;
    for (const [name, summaries] of Object.entries(parts)) {
      const row = element('tr', {}, element('td', {}, what + name));
      for (const measure of headlineMeasures()) row.append(valueCell(measure, summaries[measure.id], false));
      body.append(row);
    }
  }
  byId('part-table').replaceChildren(headlineHead('part'), body);
}

function setUpParts() {
  if (Object.keys(mainMethod.emotions).length < 2 && Object.keys(mainMethod.folds).length < 2) return;
  fillSelect(byId('pick-part-method'), methodOptions(), report.main_method);
  byId('pick-part-method').addEventListener('change', drawParts);
  drawParts();
  show('parts');
}

const list = { order: 'squared_error', down: true };

function drawSentenceTable() {
  const { keys, columns, values } = report.sentence_values;
  const own = values[byId('pick-list-method').value];
  const column = new Map(columns.map((id, index) => [id, index]));
  const part = byId('find-sentence').value.toLowerCase();
  const found = keys.map((key, index) => ({ key, row: own[index] })).filter(({ key }) => key.toLowerCase().includes(part));
  const measure = measures.get(list.order);
  const bad = ({ row }) => badness(measure, row[column.get(list.order)]) ?? -(row[column.get(list.order)] ?? Infinity);
  found.sort((a, b) => (list.down ? bad(b) - bad(a) : bad(a) - bad(b)) || a.key.localeCompare(b.key));
  const body = element('tbody');
  const limit = 200;
  for (const { key, row } of found.slice(0, limit)) {
    const shown = report.shown.findIndex((sentence) => sentence.key === key);
    const line = element('tr', { class: shown >= 0 ? 'pickable' : null }, element('td', {}, key, shown >= 0 ? ' ▸' : ''));
    for (const { id } of report.headlines) line.append(element('td', {}, number(row[column.get(id)], measures.get(id).decimals)));
    if (shown >= 0) {
      line.addEventListener('click', () => {
        chooseSentence(shown);
        byId('sentence').scrollIntoView();
      });
    }
    body.append(line);
  }
  const head = headlineHead('sentence');
  report.headlines.forEach(({ id }, index) => {
    const cell = head.querySelectorAll('th')[index + 1];
    cell.style.cursor = 'pointer';
    cell.setAttribute('aria-sort', id === list.order ? 'descending' : 'none');
    cell.prepend(id === list.order ? (list.down ? '▾ ' : '▴ ') : '');
    cell.addEventListener('click', () => {
      [list.down, list.order] = [id === list.order ? !list.down : true, id];
      drawSentenceTable();
    });
  });
  byId('sentence-table').replaceChildren(head, body);
  byId('list-count').textContent = `${found.length} sentences${found.length > limit ? `, the first ${limit} are shown` : ''}; ▸ opens the players`;
}

function setUpSentenceTable() {
  fillSelect(byId('pick-list-method'), methodOptions(), report.main_method);
  byId('pick-list-method').addEventListener('change', drawSentenceTable);
  byId('find-sentence').addEventListener('input', drawSentenceTable);
  drawSentenceTable();
  show('all');
}
