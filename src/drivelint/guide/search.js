// The search of the site. It needs no server: the index is a script, which is loaded when the search field gets the focus.
'use strict';
const MOST_HITS = 12;
const form = document.querySelector('header form');
const field = form.querySelector('input');
const list = document.getElementById('hits');
let sections = null; // sections of all pages, in order; null: the index is not loaded

function drivelintPages(pages) {
  sections = pages.flatMap(([page, parts]) => parts.map(([anchor, heading, words], n) => ({
    href: `${page}.html${n ? `#${anchor}` : ''}`, title: parts[0][1], heading, words: ` ${words} `,
    name: ` ${heading.toLowerCase()} `, first: n === 0,
  })));
  show();
}

// Returns how well a section matches a word; 0: the section does not contain it.
function fit(section, word) {
  if (section.name.includes(` ${word} `)) return section.first ? 6 : 5;
  if (section.name.includes(word)) return section.first ? 4 : 3;
  return section.words.includes(` ${word} `) ? 2 : section.words.includes(word) ? 1 : 0;
}

function found() {
  const words = field.value.toLowerCase().match(/[\p{L}\p{N}_]+(?:[.-]+[\p{L}\p{N}_]+)*/gu);
  if (!words) return null;
  const scored = sections.map((section) => [words.map((word) => fit(section, word)), section]);
  const all = scored.filter(([fits]) => !fits.includes(0)).map(([fits, section]) => [fits.reduce((a, b) => a + b), section]);
  return all.sort(([a], [b]) => b - a).slice(0, MOST_HITS).map(([, section]) => section);
}

function show() {
  const hits = sections && found();
  list.hidden = !hits;
  list.replaceChildren(...(hits ?? []).map((section) => {
    const link = Object.assign(document.createElement('a'), { href: section.href, textContent: section.heading });
    if (!section.first) link.append(Object.assign(document.createElement('small'), { textContent: section.title }));
    const item = document.createElement('li');
    item.append(link);
    return item;
  }));
  if (hits && !hits.length) list.append(Object.assign(document.createElement('li'), { textContent: 'Nothing was found.' }));
}

function load() {
  document.head.append(Object.assign(document.createElement('script'), { src: 'search-index.js' }));
}

form.hidden = false;
field.addEventListener('focus', load, { once: true });
field.addEventListener('input', show);
form.addEventListener('submit', (event) => {
  event.preventDefault();
  list.querySelector('a')?.click();
});
// a click on a hit closes the list, also if the hit is on the same page
list.addEventListener('click', () => { list.hidden = true; });
document.addEventListener('click', (event) => { if (!form.contains(event.target)) list.hidden = true; });
document.addEventListener('keydown', (event) => {
  if (event.key === 'Escape') { list.hidden = true; field.blur(); }
  if (event.key === '/' && document.activeElement !== field) { event.preventDefault(); field.focus(); }
  const links = [...list.querySelectorAll('a')];
  const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
  if (!step || list.hidden || !form.contains(document.activeElement)) return;
  event.preventDefault();
  (links[links.indexOf(document.activeElement) + step] ?? field).focus();
});
