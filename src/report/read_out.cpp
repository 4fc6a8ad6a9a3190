#include "report/read_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "report/page_colours.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/files/stored_file.hpp"

namespace wingbeat {
namespace {

constexpr const char* read_out_rules = R"(
body { margin: 0 auto; padding: 1.2rem; max-width: 60rem; color: var(--ink); background: var(--page);
  font: 15px/1.5 "DejaVu Sans", Verdana, Arial, sans-serif; }
h1 { font-size: 1.15rem; } p { color: var(--soft); font-size: .87rem; }
svg { width: 100%; height: auto; max-height: 88vh; display: block; }
.area { fill: transparent; cursor: crosshair; outline: none; }
.area:focus-visible { stroke: var(--accent); stroke-width: 3; }
.mark { fill: none; stroke: var(--ink); stroke-width: 2.5; paint-order: stroke; pointer-events: none; }
.halo { fill: none; stroke: var(--paper); stroke-width: 6; pointer-events: none; }
.tip { position: fixed; z-index: 3; pointer-events: none; background: var(--page); border: 1px solid var(--ink);
  padding: .3rem .55rem; font-size: .8rem; max-width: 22rem; }
.tip:empty { display: none; } .tip .note { color: var(--soft); }
@media print { body { max-width: none; padding: 0; } p, .tip, .mark, .halo { display: none; } })";

constexpr const char* read_out_script = R"(
'use strict';
const panels = JSON.parse(document.getElementById('points').textContent);
const svg = document.querySelector('svg'), tip = document.querySelector('.tip'), view = svg.viewBox.baseVal;
const made = (name, attributes) => {
  const node = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  return svg.appendChild(node);
};
const halo = made('path', {class: 'halo', d: ''}), mark = made('path', {class: 'mark', d: ''});
const hide = () => { tip.replaceChildren(); mark.setAttribute('d', ''); halo.setAttribute('d', ''); };
const shown = (value, unit) => value === null ? 'none' : `${value} ${unit}`.trim().replace(/^-/, '\u2212');
panels.forEach(panel => {
  const [left, right, top, bottom] = panel.box, flat = !panel.y;
  const x = panel.x.map(share => left + share * (right - left));
  const y = flat ? x.map(() => 0.5 * (top + bottom)) : panel.y.map(share => bottom - share * (bottom - top));
  const show = index => {
    const radius = 9, circle = `M${x[index] - radius},${y[index]}a${radius},${radius} 0 1 0 ${2 * radius},0` +
      `a${radius},${radius} 0 1 0 ${-2 * radius},0`, line = `M${x[index]},${top}V${bottom}`;
    for (const path of [mark, halo]) path.setAttribute('d', flat ? line : circle);
    const lines = panel.columns.map(([name, unit], k) => `${name}: ${shown(panel.rows[index][k], unit)}`);
    const note = panel.texts[panel.notes[index]];
    tip.replaceChildren(...[...lines, ...(note ? [note] : [])].map((text, k) => {
      const line = document.createElement('div');
      line.textContent = text;
      if (k === lines.length) line.className = 'note';
      return line;
    }));
    const matrix = svg.getScreenCTM(), px = matrix.a * x[index] + matrix.e, py = matrix.d * y[index] + matrix.f;
    const beside = px + 18 + tip.offsetWidth < innerWidth ? px + 18 : px - 18 - tip.offsetWidth;
    tip.style.left = Math.max(4, beside) + 'px';
    tip.style.top = Math.max(4, Math.min(py + 14, innerHeight - tip.offsetHeight - 6)) + 'px';
    panel.now = index;
  };
  const nearest = distance => {
    let best = -1, least = Infinity;
    for (let n = 0; n < x.length; ++n) {
      const d = distance(n);
      if (d < least) { least = d; best = n; }
    }
    return best;
  };
  const area = made('rect', {class: 'area', x: left, y: top, width: right - left, height: bottom - top, tabindex: 0,
                             role: 'application', 'aria-label': panel.name + ': arrow keys go from design to design'});
  if (!x.length) return;
  area.addEventListener('pointermove', event => {
    const matrix = svg.getScreenCTM();
    const px = (event.clientX - matrix.e) / matrix.a, py = (event.clientY - matrix.f) / matrix.d;
    show(nearest(n => Math.abs(x[n] - px) ** 2 + (flat ? 0 : Math.abs(y[n] - py) ** 2)));
  });
  area.addEventListener('pointerleave', hide);
  area.addEventListener('blur', hide);
  area.addEventListener('focus', () => {
    if (area.matches(':focus-visible'))
      show(panel.now ?? nearest(n => Math.hypot(x[n] - 0.5 * (left + right), flat ? 0 : y[n] - 0.5 * (top + bottom))));
  });
  const ways = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
  area.addEventListener('keydown', event => {
    if (event.key === 'Escape') return hide();
    const way = ways[event.key], now = panel.now ?? 0;
    let next = -1;
    if (way) {
      next = nearest(n => {
        const along = way[0] * (x[n] - x[now]) + way[1] * (y[n] - y[now]);
        const across = Math.abs(way[1] * (x[n] - x[now])) + Math.abs(way[0] * (y[n] - y[now]));
        return along > 0.01 ? along + 4 * across : Infinity;
      });
    } else if (event.key === 'Home' || event.key === 'End') {
      next = nearest(n => event.key === 'Home' ? x[n] : -x[n]);
    } else {
      return;
    }
    event.preventDefault();
    if (next >= 0) show(next);
  });
});
)";

/// To five digits of the point's place, four of its numbers: what can be distinguished, and no more in the file.
double read_out_digits(double value, int digits) {
  return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);
}

nlohmann::ordered_json places_json(const std::vector<double>& shares) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const double share : shares) list.push_back(std::round(1e5 * share) / 1e5);
  return list;
}

nlohmann::ordered_json panel_json(const ReadOutPanel& panel, double width, double height) {
  nlohmann::ordered_json json;
  const auto pixel = [](double v) { return std::round(100.0 * v) / 100.0; };
  json["name"] = panel.name;
  json["box"] = {pixel(width * panel.left), pixel(width * panel.right), pixel(height * panel.top),
                 pixel(height * panel.bottom)};
  json["x"] = places_json(panel.x);
  if (!panel.y.empty()) json["y"] = places_json(panel.y);
  json["columns"] = nlohmann::ordered_json::array();
  for (const ReadOutColumn& column : panel.columns) json["columns"].push_back({column.name, column.unit});
  json["rows"] = nlohmann::ordered_json::array();
  json["notes"] = nlohmann::ordered_json::array();
  json["texts"] = nlohmann::ordered_json::array({""});
  std::map<std::string, std::size_t> texts = {{"", 0}};
  for (std::size_t n = 0; n < panel.x.size(); ++n) {
    nlohmann::ordered_json row = nlohmann::ordered_json::array();
    for (const ReadOutColumn& column : panel.columns) {
      const double value = column.values[n];
      row.push_back(std::isfinite(value) ? nlohmann::ordered_json(read_out_digits(value, 4)) : nullptr);
    }
    json["rows"].push_back(std::move(row));
    const std::string note = n < panel.notes.size() ? panel.notes[n] : "";
    const auto [known, added] = texts.emplace(note, texts.size());
    if (added) json["texts"].push_back(note);
    json["notes"].push_back(known->second);
  }
  return json;
}

std::string read_out_page(std::string svg, const Figure& figure, const std::string& title,
                          const std::vector<ReadOutPanel>& panels) {
  const auto begin = svg.find("<svg");
  if (begin != std::string::npos) svg.erase(0, begin);
  const std::string name = detail::markup_escaped(detail::printable(title));
  svg.insert(svg.find("<svg ") + 5, fmt::format("role=\"group\" aria-label=\"{}\" ", name));
  use_page_colours(svg);
  // As large as Figure makes its SVG.
  constexpr double pixels = 192.0;
  nlohmann::ordered_json points = nlohmann::ordered_json::array();
  for (const ReadOutPanel& panel : panels) {
    points.push_back(panel_json(panel, std::round(pixels * figure.width()), std::round(pixels * figure.height())));
  }
  // Within a script "</" would end it.
  std::string data = points.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  for (std::size_t position = 0; (position = data.find("</", position)) != std::string::npos; position += 3)
    data.replace(position, 2, "<\\/");
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>{0}</title>\n<link rel=\"icon\" href=\"data:,\">\n"
      "<style>:root {{ --page: #fff; --soft: #595959; --accent: #00507c;{1} }}\n"
      "@media screen and (prefers-color-scheme: dark) {{ :root {{ --page: #111417; --soft: #a5abb2; --accent: #7cc0ea; "
      "color-scheme: dark;{2} }} }}{3}</style></head>\n<body>\n<main>{4}</main>\n"
      "<p>Point at a design to read its numbers; with the keyboard, go to a panel with Tab and from design to design "
      "with the arrow keys.</p>\n<div class=\"tip\" role=\"status\"></div>\n"
      "<script type=\"application/json\" id=\"points\">{5}</script>\n<script>{6}</script>\n</body></html>\n",
      name, colour_variables(false), colour_variables(true), read_out_rules, svg, data, read_out_script);
}

}  // namespace

double share_of_axis(double value, double low, double high, bool logarithmic) {
  if (!(high != low)) return 0.5;
  return logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

void write_figure(const Figure& figure, PlotFormat format, const std::string& title,
                  const std::vector<ReadOutPanel>& panels, const std::filesystem::path& output) {
  if (format == PlotFormat::html) {
    store(output, read_out_page(drawing_of(figure.script()), figure, title, panels));
  } else {
    run_gnuplot(figure.script(), output);
  }
}

}  // namespace wingbeat
