// SPDX-License-Identifier: GPL-3.0-or-later
//
// The methods' table and one plot a measure.

// The method whose value is best, among those that do not see the recording.
function bestMethod(measure) {
  let best = null;
  for (const method of report.methods) {
    const bad = badness(measure, method.measures[measure.id].mean);
    if (bad !== null && !method.sees_recording && (best === null || bad < best.bad)) {
      best = { id: method.id, bad };
    }
  }
  return best && best.id;
}

function valueCell(measure, summary, isBest) {
  if (!isNumber(summary.mean)) return element('td', { class: 'none' }, '–');
  const cell = element('td', { class: isBest ? 'best' : null }, number(summary.mean, measure.decimals));
  if (isNumber(summary.standard_error)) {
    cell.append(element('span', { class: 'se' }, `±${number(summary.standard_error, measure.decimals)}`));
  }
  tip(cell, `${measure.label}\n${summary.sentences} sentences\npooled over all: ${number(summary.pooled, measure.decimals)}`);
  return cell;
}

function methodName(method) {
  return element('td', {}, element('i', { class: 'dot', style: `color:${methodColor(method.id)}` }), method.id,
    element('span', { class: 'what' }, method.description));
}

function methodRow(method, name, shown) {
  const row = element('tr', {
    class: method.sees_recording ? 'bound' : method === mainMethod ? 'main' : null,
  }, name);
  for (const measure of shown) row.append(valueCell(measure, method.measures[measure.id], bestMethod(measure) === method.id));
  return row;
}

const headlineMeasures = () => report.headlines.map(({ id }) => measures.get(id));

function headlineHead(first) {
  return tableHead([first, ...report.headlines.map(({ id, label }) => ({ text: label, measure: measures.get(id) }))]);
}

function drawMethodTable() {
  const body = element('tbody');
  for (const method of report.methods) body.append(methodRow(method, methodName(method), headlineMeasures()));
  byId('method-table').replaceChildren(headlineHead('method'), body);
}

function drawMeasureTable() {
  const body = element('tbody');
  for (const measure of report.measures) {
    const label = element('td', {}, measure.label, ' ', element('span', { class: 'none' }, unitText(measure)));
    tip(label, `${measure.formula}\n(${measure.mask})`);
    const row = element('tr', {}, label);
    const best = bestMethod(measure);
    for (const method of report.methods) row.append(valueCell(measure, method.measures[measure.id], best === method.id));
    body.append(row);
  }
  const total = element('tr', {}, element('td', {}, 'total error (E12)'));
  for (const method of report.methods) total.append(element('td', {}, number(method.total_error, 1)));
  body.append(total);
  byId('measure-table').replaceChildren(tableHead(['measure', ...report.methods.map((method) => method.id)]), body);
}

// Where a measure has a value to be held against: 1 for a ratio, the recording for closures.
function target(measure) {
  if (measure.aim === 'near 1') return { value: 1, text: 'as recorded' };
  if (measure.id === 'closure_recall') return { value: mainMethod.measures.closure_recall_recorded.mean, text: 'recording' };
  return null;
}

function drawDots(svg, width, measure) {
  const [left, right, top, line] = [116, width - 12, 6, 21];
  const bottom = top + line * report.methods.length;
  const wanted = target(measure);
  const spread = report.methods.flatMap(({ measures: own }) => {
    const { mean, standard_error: error } = own[measure.id];
    return isNumber(mean) ? [mean - 2 * (error ?? 0), mean + 2 * (error ?? 0)] : [];
  });
  const domain = range(wanted && isNumber(wanted.value) ? [...spread, wanted.value] : spread);
  const x = scale(domain, [left, right]);
  horizontalAxis(svg, x, domain, top, bottom, 4);
  if (wanted && isNumber(wanted.value)) {
    const mark = shape('line', { class: 'target', x1: x(wanted.value), x2: x(wanted.value), y1: top, y2: bottom });
    tip(mark, `${wanted.text}: ${number(wanted.value, measure.decimals)}`);
    svg.append(mark);
  }
  report.methods.forEach((method, index) => {
    const y = top + line * (index + 0.5);
    const { mean, standard_error: error } = method.measures[measure.id];
    svg.append(shape('text', { class: 'name', x: 0, y: y + 4 }, shortName(method.id, 17)));
    if (!isNumber(mean)) {
      svg.append(shape('text', { x: left + 4, y: y + 4 }, 'no value'));
      return;
    }
    const style = `stroke:${methodColor(method.id)};fill:${method.sees_recording ? 'var(--surface)' : methodColor(method.id)}`;
    const whisker = 2 * (error ?? 0);
    svg.append(shape('line', { x1: x(mean - whisker), x2: x(mean + whisker), y1: y, y2: y, style: `${style};stroke-width:2;stroke-opacity:0.5` }));
    const dot = shape('circle', { cx: x(mean), cy: y, r: 4.5, style: `${style};stroke-width:2` });
    tip(dot, `${method.id}: ${number(mean, measure.decimals)} ± ${number(error, measure.decimals)} ${unitText(measure)}`);
    svg.append(dot);
  });
}

const shortName = (text, length) => (text.length > length ? `${text.slice(0, length - 1)}…` : text);

function drawMethods() {
  show('methods');
  drawMethodTable();
  drawMeasureTable();
  for (const measure of headlineMeasures()) {
    if (!report.methods.some((method) => isNumber(method.measures[measure.id].mean))) continue;
    const aim = { small: 'less is better', large: 'more is better', 'near 1': '1 is best', 'near 0': '0 is best' }[measure.aim];
    const unit = [unitText(measure), aim].filter(Boolean).join(', ');
    figure(byId('method-plots'), measure.label, unit, 26 + 21 * report.methods.length,
      (svg, width) => drawDots(svg, width, measure));
  }
  byId('methods-hint').textContent = 'Small figures and whiskers: one and two standard errors of the mean.';
}
