// SPDX-License-Identifier: GPL-3.0-or-later
//
// This run against an earlier one, and against databases of other sizes.

function verdictCell(verdict) {
  const kind = { better: 'better', worse: 'worse' }[verdict] ?? 'same';
  return element('td', {}, element('span', { class: `verdict ${kind}` }, verdict ?? ''));
}

function comparedTable(method) {
  const body = element('tbody');
  for (const [id, one] of Object.entries(method.measures)) {
    const measure = measures.get(id);
    const label = element('td', {}, measure.label, ' ', element('span', { class: 'none' }, unitText(measure)));
    tip(label, `${measure.formula}\n(${measure.mask})`);
    body.append(element('tr', {}, label,
      element('td', {}, number(one.mean, measure.decimals)),
      element('td', {}, number(one.earlier_mean, measure.decimals)),
      element('td', {}, number(one.difference, measure.decimals + 1)),
      element('td', {}, one.verdict ? `${one.better} / ${one.worse}` : '–'),
      element('td', {}, one.verdict ? one.adjusted_p.toPrecision(2) : '–'),
      verdictCell(one.verdict)));
  }
  return element('table', {}, tableHead(['measure', 'now', 'earlier', 'difference', 'better / worse', 'p (Holm)', '']), body);
}

function drawComparison() {
  const { comparison } = report;
  if (!comparison) return;
  byId('comparison-lead').textContent = [
    `Paired by sentence with ${comparison.against} (${comparison.held_out_by}).`,
    "A verdict needs p < 0.05 in Wilcoxon's signed-rank test, two-sided, after Holm over the measures.",
    ...comparison.notes,
  ].join(' ');
  for (const method of comparison.methods) {
    const isMain = method.method === report.main_method;
    const title = `${method.method} against ${method.earlier_method}: ${method.sentences} sentences`;
    byId('comparison-tables').append(element('details', { open: isMain ? '' : null },
      element('summary', {}, title), element('div', { class: 'scroll' }, comparedTable(method))));
  }
  show('comparison');
}

// One curve over the size of the database, with whiskers of two standard errors.
function sizePlot(caption, unit, decimals, points, color) {
  const known = points.filter(({ y }) => isNumber(y));
  if (known.length === 0) return;
  figure(byId('size-plots'), caption, unit, 170, (svg, width) => {
    const [left, right, top, bottom] = [46, width - 14, 8, 138];
    const xs = range(known.map(({ x }) => x), 0.04);
    const ys = range(known.flatMap(({ y, error }) => [y - 2 * (error ?? 0), y + 2 * (error ?? 0)]));
    const x = scale(xs, [left, right]);
    const y = scale(ys, [bottom, top]);
    verticalAxis(svg, y, ys, left, right, 4);
    horizontalAxis(svg, x, xs, top, bottom, 4);
    svg.append(shape('text', { x: right, y: bottom + 27, 'text-anchor': 'end' }, 'motion nodes'));
    const path = known.map((point, i) => `${i ? 'L' : 'M'}${x(point.x)} ${y(point.y)}`).join('');
    svg.append(shape('path', { class: 'line', d: path, style: `stroke:${color}` }));
    for (const point of known) {
      const whisker = 2 * (point.error ?? 0);
      svg.append(shape('line', { x1: x(point.x), x2: x(point.x), y1: y(point.y - whisker), y2: y(point.y + whisker), style: `stroke:${color};stroke-opacity:0.5;stroke-width:2` }));
      const dot = shape('circle', { cx: x(point.x), cy: y(point.y), r: 4, style: `fill:${color}` });
      tip(dot, `${point.sentences} sentences, ${point.x} nodes\n${caption}: ${number(point.y, decimals)}`);
      svg.append(dot);
    }
  });
}

function drawSizes() {
  if (report.sizes.length === 0) return;
  show('sizes');
  const of = (value, error = () => null) => report.sizes.map((size) =>
    ({ x: size.nodes, sentences: size.sentences, y: value(size), error: error(size) }));
  for (const measure of headlineMeasures()) {
    sizePlot(measure.label, unitText(measure), measure.decimals,
      of((size) => size.measures[measure.id].mean, (size) => size.measures[measure.id].standard_error), 'var(--m0)');
  }
  sizePlot('search time', 's, mean of a sentence', 3, of((size) => size.search_seconds), 'var(--m1)');
  sizePlot('diphones', 'share of those asked for', 3, of((size) => size.diphone_coverage), 'var(--m2)');
  sizePlot('triphones', 'share of those asked for', 3, of((size) => size.triphone_coverage), 'var(--m2)');
}

function drawEmotions() {
  const found = report.emotion_recognition;
  if (!found) return;
  show('emotions');
  const emotions = [...new Set(found.trials.flatMap((trial) => Object.keys(trial.taken_for)))].sort();
  const body = element('tbody');
  for (const trial of found.trials) {
    const row = element('tr', {}, element('td', { title: trial.description }, trial.id), element('td', {}, String(trial.sentences)),
      element('td', {}, number(trial.share, 3)),
      element('td', {}, number(trial.share_by_movement_too, 3)), element('td', {}, number(trial.closure_recall, 3)));
    for (const emotion of emotions) {
      const heard = trial.taken_for[emotion] ?? {};
      const all = Object.values(heard).reduce((sum, count) => sum + count, 0);
      const cell = element('td', {}, all ? number((heard[emotion] ?? 0) / all, 3) : '-');
      cell.title = `asked for ${emotion}: ${Object.entries(heard).map(([name, count]) => `${name} ${count}`).join(', ')}`;
      row.append(cell);
    }
    body.append(row);
  }
  byId('emotion-table').replaceChildren(tableHead(['spoken', 'sentences', 'recognised', 'by movement too', 'closures', ...emotions]), body);
  const { change, standard_error: error, p, pairs } = found.closures;
  byId('emotion-closures').textContent = `Closure recall where another emotion is asked for, less that where it is not: ${number(change, 4)} (standard error ${number(error, 4)}, p = ${number(p, 2)}, ${pairs} pairs).`;
}
