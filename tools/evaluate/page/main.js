// SPDX-License-Identifier: GPL-3.0-or-later
//
// The page from top to bottom.

function drawHead() {
  byId('title').textContent = `Evaluation of ${report.corpus}`;
  const options = Object.entries(report.options).map(([name, value]) => `${name}: ${value}`);
  byId('facts').textContent = [
    `${report.sentences} sentences`, report.held_out_by, `compared at ${report.rate} Hz`,
    report.left_out ? `${report.left_out} left out` : '', ...options, ...report.notes,
  ].filter(Boolean).join(' · ');
}

function drawDefinitions() {
  const body = element('tbody');
  const aims = { small: 'less', large: 'more', 'near 1': '1', 'near 0': '0', none: '' };
  for (const measure of report.measures) {
    body.append(element('tr', {}, element('td', {}, measure.label), element('td', {}, unitText(measure)),
      element('td', { class: 'text' }, measure.formula), element('td', { class: 'text' }, measure.mask), element('td', {}, aims[measure.aim])));
  }
  const head = tableHead(['measure', 'unit', 'formula', 'over', 'best']);
  for (const index of [2, 3]) head.querySelectorAll('th')[index].style.textAlign = 'left';
  byId('definition-table').replaceChildren(head, body);
  const ranges = Object.entries(report.contact_ranges).map(([phoneme, { low, high, rows }]) =>
    `/${phoneme}/ ${number(low, 2)} to ${number(high, 2)} mm (${rows} rows)`);
  if (ranges.length) byId('contact-ranges').textContent = `Contact: least aperture of the recordings, 10th to 90th percentile: ${ranges.join('; ')}.`;
}

function drawSections() {
  for (const section of document.querySelectorAll('main > section:not([hidden])')) {
    byId('sections').append(element('a', { href: `#${section.id}` }, section.querySelector('h2').textContent));
  }
}

drawHead();
drawMethods();
drawComparison();
drawSizes();
drawEmotions();
setUpSentence();
setUpPhonemes();
setUpPlaces();
setUpParts();
setUpSentenceTable();
drawDefinitions();
drawSections();
let width = window.innerWidth;
window.addEventListener('resize', () => {
  if (window.innerWidth === width) return;
  width = window.innerWidth;
  for (const listener of [...listeners]) listener();
});
window.phonomime_report = { report, setTime, chooseSentence, clock, trace, motionOf, poseAt };
