// How report.html looks and what moves in it: style and script, both in the file itself.
#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "report/page_colours.hpp"
#include "reproduction/html.hpp"

namespace wingbeat::reproduction {
namespace {

constexpr const char* page_rules = R"(
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 2rem 1.25rem 4rem; max-width: 68rem; color: var(--ink); background: var(--page);
  font: 16px/1.55 Georgia, "Times New Roman", serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .4rem; }
h2 { font-size: 1.35rem; margin: 2.8rem 0 .6rem; padding-top: .6rem; border-top: 2px solid var(--accent); }
h3 { font-size: 1.05rem; margin: 1.6rem 0 .4rem; }
p, ul, ol { max-width: 46rem; }
.lead { color: var(--soft); }
.answer { max-width: 46rem; border-left: 4px solid var(--accent); padding: .2rem 0 .2rem 1rem; }
.answer p { margin: .5rem 0; } .answer p:first-child { font-size: 1.15rem; }
nav ol { columns: 2; column-gap: 3rem; padding-left: 1.6rem; }
nav li { break-inside: avoid; }
a { color: var(--accent); }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 26rem), 1fr));
  gap: 1.6rem 2rem; align-items: start; margin: 1rem 0; }
figure { margin: 0; min-width: 0; }
figure.page { grid-column: 1 / -1; }
.drawing { border: 1px solid var(--line); overflow-x: auto; background: var(--paper); }
.drawing svg { width: 100%; height: auto; display: block; }
figure.page .drawing svg { min-width: 44rem; }
.drawing text { font-family: "DejaVu Sans", Verdana, Arial, sans-serif; }
figcaption { font-size: .87rem; line-height: 1.45; margin-top: .45rem; }
figcaption b { display: block; }
.files { color: var(--soft); }
.wide { overflow-x: auto; }
details { margin: .8rem 0; }
summary { cursor: pointer; color: var(--accent); }
table { border-collapse: collapse; font: .82rem/1.4 Arial, Helvetica, sans-serif; margin: .8rem 0 1.2rem; }
th, td { text-align: left; vertical-align: top; padding: .28rem .6rem; border-bottom: 1px solid var(--line); }
thead th { border-bottom: 2px solid var(--ink); }
.sortable thead th[role=button] { cursor: pointer; }
.sortable thead th[aria-sort=ascending]::after { content: " \25B2"; }
.sortable thead th[aria-sort=descending]::after { content: " \25BC"; }
td:first-child { min-width: 13rem; }
table.laws { font-size: .78rem; }
table.laws td.n { white-space: normal; min-width: 5.2rem; }
th.group { background: var(--band); padding-top: .5rem; }
td.n { text-align: right; white-space: nowrap; }
.v { white-space: nowrap; }
.yes::before { content: "\25CF  "; color: var(--good); }
.no::before { content: "\25CB  "; color: var(--bad); }
.part::before { content: "\25D0  "; color: var(--mixed); }
.erratum { color: var(--bad); }
table.claims { font-size: .76rem; }
.filter { font: .85rem Arial, Helvetica, sans-serif; display: flex; flex-wrap: wrap; gap: .4rem 1.2rem; }
.filter[hidden], .scorecard tr[hidden] { display: none !important; }
.filter select, .filter input { font: inherit; color: inherit; background: var(--page); border: 1px solid var(--grey); }
svg[data-panels]:focus-visible { outline: 2px solid var(--accent); outline-offset: -2px; }
.scorecard table { width: 100%; font-size: .78rem; }
.scorecard td:nth-child(5) { min-width: 11rem; }
.strip { position: relative; display: block; height: .9rem; min-width: 10rem; border-left: 1px solid var(--line);
  border-right: 1px solid var(--line); background: linear-gradient(to right, transparent 40%, var(--met) 40%,
  var(--met) 60%, transparent 60%); }
.strip i { position: absolute; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
.strip .dot { width: .5rem; height: .5rem; margin-left: -.25rem; border: 2px solid var(--ink); background: var(--ink); }
.strip .rod { top: .02rem; } .strip .work { top: .42rem; }
.strip .dot.rod { border-radius: 50%; }
.strip .hollow { background: var(--page); }
.strip .beyond { border-style: dotted; background: var(--page); }
.strip .span { height: 2px; min-width: 1px; background: var(--grey); }
.strip .span.rod { top: .22rem; } .strip .span.work { top: .62rem; }
pre { white-space: pre-wrap; background: var(--band); border: 1px solid var(--line); padding: .7rem .9rem;
  overflow-x: auto; font-size: .85rem; line-height: 1.4; }
code { font-size: .9em; }
.tools { position: sticky; top: 0; z-index: 2; background: var(--page); padding: .4rem 0;
  font: .85rem Arial, Helvetica, sans-serif; border-bottom: 1px solid var(--line); }
.tools button { font: inherit; color: inherit; background: none; border: 1px solid var(--line); padding: .15rem .6rem;
  margin-left: .3rem; border-radius: 3px; cursor: pointer; }
.tools button[aria-pressed=true] { background: var(--accent); border-color: var(--accent); color: var(--page); }
body[data-shown=rod-force] [data-formulation=virtual-work],
body[data-shown=virtual-work] [data-formulation=rod-force] { display: none; }
.tip { position: fixed; z-index: 3; pointer-events: none; background: var(--page); border: 1px solid var(--ink);
  padding: .25rem .5rem; font: .78rem/1.4 Arial, Helvetica, sans-serif; max-width: 20rem; display: none; }
@media (max-width: 40rem) { body { padding: 1rem .75rem 3rem; } nav ol { columns: 1; } td:first-child {
  min-width: 9rem; } h1 { font-size: 1.5rem; overflow-wrap: anywhere; }
  .scorecard thead { display: none; } .scorecard tr, .scorecard td { display: block; }
  .scorecard tr { border-bottom: 1px solid var(--line); padding: .3rem 0; }
  .scorecard td { border: 0; padding: .1rem 0; } .scorecard th.group { display: block; }
  .scorecard td:first-child { font-weight: bold; }
  .scorecard td[data-label]::before { content: attr(data-label) ": "; color: var(--soft); }
  .scorecard td.yes[data-label]::before { content: "\25CF  " attr(data-label) ": "; }
  .scorecard td.no[data-label]::before { content: "\25CB  " attr(data-label) ": "; } }
@page { size: A4; margin: 13mm 14mm; }
@media print { html { font-size: 9pt; } body { max-width: none; padding: 0; font-size: 9pt; }
  h2, h3, h2 + p, thead, th.group { break-after: avoid; }
  figure, tr, h2 + p, pre { break-inside: avoid; } p, li { orphans: 3; widows: 3; }
  .figures { display: block; margin: .6rem 0; orphans: 1; widows: 1; }
  figure { display: inline-block; vertical-align: top; width: 48.5%; margin: 0 1% 3mm 0; }
  figure.page { display: block; width: auto; margin: 0 0 3mm; } figure.page .drawing svg { min-width: 0; }
  .drawing svg { max-height: 112mm; } figure.page .drawing svg { max-height: 96mm; }
  p, ul, ol, .answer { max-width: none; } h2 { margin-top: 1.2rem; }
  details:not([open]), .moving { display: none; } .scorecard td:nth-child(5), .strip { min-width: 30mm; }
  nav, .tools, .tip, .filter { display: none !important; } g[data-curve] { opacity: 1 !important; }
  .wide, .drawing { overflow: visible; } table, table.laws, .scorecard table { width: 100%; font-size: 6.6pt; }
  th, td { padding: .2rem .3rem; } td:first-child { min-width: 9rem; }
  .scorecard td:nth-child(3), .scorecard td:nth-child(4) { width: 24%; }
  td.n, table.laws td.n, .v { white-space: normal; min-width: 0; } h3 { margin: .7rem 0 .2rem; }
  pre { white-space: pre-wrap; font-size: 7pt; margin: .3rem 0; padding: .3rem .6rem; } }
)";

constexpr const char* script = R"(
'use strict';
for (const group of document.querySelectorAll('g[data-curve]')) {
  const formulation = group.dataset.curve.split('|')[2];
  if (formulation) group.dataset.formulation = formulation;
}
const tools = document.querySelector('.tools');
tools.hidden = false;
for (const button of tools.querySelectorAll('button')) {
  button.addEventListener('click', () => {
    document.body.dataset.shown = button.value;
    for (const other of tools.querySelectorAll('button')) other.setAttribute('aria-pressed', String(other === button));
  });
}
const tip = document.body.appendChild(document.createElement('div'));
tip.className = 'tip';
tip.setAttribute('role', 'status');
const digits = value => Number(value.toPrecision(4)).toString();
const unit = label => (label.match(/\(([^)]*)\)$/) || ['', ''])[1];
function points(group) {
  if (!group.points) {
    group.points = [];
    for (const path of group.querySelectorAll('path')) {
      for (const at of path.getAttribute('d').matchAll(/(-?[\d.]+),(-?[\d.]+)/g)) group.points.push([+at[1], +at[2]]);
    }
  }
  return group.points;
}
for (const svg of document.querySelectorAll('svg[data-panels]')) {
  const panels = JSON.parse(svg.dataset.panels), groups = [...svg.querySelectorAll('g[data-curve]')];
  const stress = one => { for (const g of groups) g.style.opacity = one && g !== one ? 0.25 : ''; };
  const hide = () => { tip.style.display = 'none'; stress(null); };
  // Of the curves the one within reach of (x, y) stands out; all are read at x.
  const read = (index, x, y) => {
    const size = svg.getBoundingClientRect(), view = svg.viewBox.baseVal;
    let near = null, reach = 20;
    const {box, range, x: along, y: quantity, marks} = panels[index];
    const value = range[0] + (x - box[0]) / (box[1] - box[0]) * (range[1] - range[0]);
    const lines = [`${along.replace(/ \([^)]*\)$/, '')}: ${digits(value)} ${unit(along)}`];
    for (const group of groups) {
      const [panel, name] = group.dataset.curve.split('|');
      if (+panel !== index || getComputedStyle(group).display === 'none') continue;
      let best = null;
      for (const at of points(group)) if (!best || Math.abs(at[0] - x) < Math.abs(best[0] - x)) best = at;
      if (!best || Math.abs(best[0] - x) > 14) continue;
      if (Math.abs(best[1] - y) < reach) { near = group; reach = Math.abs(best[1] - y); }
      const height = range[3] - (best[1] - box[2]) / (box[3] - box[2]) * (range[3] - range[2]);
      lines.push(`${name}: ${digits(height)} ${unit(quantity)}`);
    }
    for (const [at, height, name] of marks) {
      if (Math.abs(box[0] + (at - range[0]) / (range[1] - range[0]) * (box[1] - box[0]) - x) < 14) lines.push(name);
    }
    tip.replaceChildren(...lines.map(text => {
      const line = document.createElement('div');
      line.textContent = text;
      return line;
    }));
    tip.style.display = 'block';
    const left = size.left + x * size.width / view.width, top = size.top + y * size.height / view.height;
    tip.style.left = Math.max(4, Math.min(left + 14, innerWidth - tip.offsetWidth - 6)) + 'px';
    tip.style.top = Math.max(4, Math.min(top + 14, innerHeight - tip.offsetHeight - 6)) + 'px';
    stress(near);
  };
  svg.addEventListener('pointerleave', hide);
  svg.addEventListener('pointermove', event => {
    const size = svg.getBoundingClientRect(), view = svg.viewBox.baseVal;
    const x = (event.clientX - size.left) * view.width / size.width;
    const y = (event.clientY - size.top) * view.height / size.height;
    const index = panels.findIndex(({box: b}) => x >= b[0] - 8 && x <= b[1] + 8 && y >= b[2] - 8 && y <= b[3] + 8);
    if (index < 0) hide(); else read(index, x, y);
  });
  // Left and right along the axis, up and down from panel to panel.
  svg.tabIndex = 0;
  let panel = 0, share = 0.5;
  svg.addEventListener('blur', hide);
  svg.addEventListener('keydown', event => {
    const along = {ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1}[event.key];
    const down = {ArrowUp: -1, ArrowDown: 1}[event.key];
    if (event.key === 'Escape') hide();
    if (along === undefined && (down === undefined || !panels[panel + down])) return;
    event.preventDefault();
    share = Math.max(0, Math.min(1, share + (along || 0)));
    panel += down || 0;
    const b = panels[panel].box;
    read(panel, b[0] + share * (b[1] - b[0]), b[2]);
  });
}
const score = document.querySelector('.scorecard'), wanted = score.querySelector('.filter');
wanted.hidden = false;
const pick = () => {
  const outcome = wanted.querySelector('select').value, text = wanted.querySelector('input').value.toLowerCase();
  let count = 0, group = null;
  for (const row of score.querySelector('tbody').rows) {
    if (row.cells[0].classList.contains('group')) {
      group = row;
      group.hidden = true;
      continue;
    }
    const met = [2, 3].filter(k => row.cells[k].classList.contains('yes')).length;
    row.hidden = outcome !== '' && met !== +outcome || !row.textContent.toLowerCase().includes(text);
    if (row.hidden) continue;
    ++count;
    if (group) group.hidden = false;
  }
  wanted.querySelector('span').textContent = `${count} statements`;
};
wanted.addEventListener('input', pick);
for (const table of document.querySelectorAll('table.sortable')) {
  const heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => {
    head.setAttribute('role', 'button');
    head.tabIndex = 0;
    const sort = () => {
      const up = head.getAttribute('aria-sort') !== 'ascending';
      for (const other of heads) other.removeAttribute('aria-sort');
      head.setAttribute('aria-sort', up ? 'ascending' : 'descending');
      const text = cell => cell ? cell.dataset.value ?? cell.textContent.trim().replace(/^\u2212/, '-') : '';
      const key = row => text(row.cells[column]);
      const order = (p, q) => {
        const a = key(p), b = key(q), m = parseFloat(a), n = parseFloat(b);
        return (up ? 1 : -1) * (isNaN(m) || isNaN(n) ? a.localeCompare(b) : m - n);
      };
      const body = table.tBodies[0], parts = [];
      for (const row of [...body.rows]) {
        if (row.cells[0].classList.contains('group') || !parts.length) parts.push([]);
        parts[parts.length - 1].push(row);
      }
      for (const part of parts) {
        const first = part[0].cells[0].classList.contains('group') ? part.splice(0, 1) : [];
        body.append(...first, ...part.sort(order));
      }
    };
    head.addEventListener('click', sort);
    head.addEventListener('keydown', event => {
      if (event.key !== 'Enter' && event.key !== ' ') return;
      event.preventDefault();
      sort();
    });
  });
}
)";

}  // namespace

std::string page_style() {
  std::string light =
                  "--page: #fff; --soft: #595959; --line: #d4d4d4; --accent: #00507c; --band: #f2f4f6; --good: "
                  "#007a5a; --bad: #b03a00; --mixed: #7a5c00;",
              dark =
                  "--page: #111417; --soft: #a5abb2; --line: #3a4047; --accent: #7cc0ea; --band: #1d2227; --good: "
                  "#41c99a; --bad: #ff9a66; --mixed: #e0bb55; color-scheme: dark;";
  light += colour_variables(false);
  dark += colour_variables(true);
  // Paper is white, whatever the screen is.
  return fmt::format(":root {{ {} }}\n@media screen and (prefers-color-scheme: dark) {{ :root {{ {} }} }}", light,
                     dark) +
         page_rules;
}

std::string with_minus_signs(std::string html) {
  for (std::size_t position = 1; position + 1 < html.size(); ++position) {
    const bool begins = std::string_view(" [(>,").find(html[position - 1]) != std::string_view::npos;
    if (html[position] == '-' && begins && html[position + 1] >= '0' && html[position + 1] <= '9')
      html.replace(position, 1, "−");
  }
  return html;
}

std::string page_script() { return script; }

}  // namespace wingbeat::reproduction
