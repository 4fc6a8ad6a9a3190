#include "report/layout.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "report/text_width.hpp"

namespace wingbeat {

double round_step(double rough) {
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double nice : {1.0, 2.0, 2.5, 5.0}) {
    if (nice * decade >= 0.9999 * rough) return nice * decade;
  }
  return 10.0 * decade;
}

namespace {

constexpr double key_gap = 0.16, line_sample = 0.2, point_sample = 0.08, sample_gap = 0.03;
/// Size of the labels of axes in gnuplot's drawings [pt].
constexpr double mark_size = 7.5;

double sample_width(const KeyEntry& e) { return (e.line.empty() ? point_sample : line_sample) + sample_gap; }

std::string mark_label(double value, double step) {
  if (std::abs(value) < 1e-6 * step) return "0";
  std::string text = fmt::format("{:.6g}", value);
  const auto minus = text.find('-');
  if (minus == 0) text.replace(0, 1, "−");
  return text;
}

}  // namespace

void fitted_text(Figure& figure, const std::string& text, double size, double room, double x, double y,
                 const char* anchor) {
  figure.text(text, fitting_size(text, size, room), figure.at(x, y) + " " + anchor);
}

void page_title(Figure& figure, const std::string& text, double y) {
  fitted_text(figure, text, style::title_size, figure.width() - 2.0 * page_margin, 0.5 * figure.width(), y, "center");
}

void axis_title(Figure& figure, const std::string& text, double size, double room, double x, double y) {
  figure.text(text, fitting_size(text, size, room), fmt::format("screen {},{} center rotate by 90", x, y));
}

std::vector<std::string> remark_lines(const std::string& all, double page_width) {
  const double room = page_width - 3.0 * page_margin;
  std::vector<std::string> lines;
  for (std::size_t position = 0; position < all.size();) {
    const std::size_t end = std::min(all.find("; ", position), all.size());
    const std::string remark = all.substr(position, end - position);
    position = std::min(all.size(), end + 2);
    const std::string joined = lines.empty() ? remark : lines.back() + "; " + remark;
    if (!lines.empty() && text_width(joined, style::text_size) <= room) {
      lines.back() = joined;
      continue;
    }
    for (std::string& line : broken_lines(remark, style::text_size, room)) lines.push_back(std::move(line));
  }
  return lines;
}

double remarks_height(const std::vector<std::string>& lines) {
  return double(lines.size()) * line_pitch * style::text_size / points_per_inch;
}

void draw_remarks(Figure& figure, const std::vector<std::string>& lines) {
  const double pitch = line_pitch * style::text_size / points_per_inch;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    const double y = figure.height() - page_margin - (double(lines.size() - n) - 0.5) * pitch;
    figure.text(lines[n], style::text_size, figure.at(figure.width() - 2.0 * page_margin, y) + " right");
  }
}

Key::Key(std::vector<KeyEntry> entries, double room) : entries_(std::move(entries)) {
  if (entries_.empty()) return;
  std::vector<double> widths;
  double sum = -key_gap;
  for (const KeyEntry& e : entries_) {
    widths.push_back(sample_width(e) + text_width(e.name, size_));
    sum += widths.back() + key_gap;
  }
  const double widest = *std::max_element(widths.begin(), widths.end());
  if (widest > room) size_ *= (room - line_sample - sample_gap) / (widest - line_sample - sample_gap);
  const double column = std::min(widest, room) + key_gap;
  const std::size_t columns = std::max<std::size_t>(1, std::size_t((room + key_gap) / column));
  double x = 0.0;
  for (std::size_t n = 0; n < entries_.size(); ++n) {
    if (sum <= room) places_.push_back({std::exchange(x, x + widths[n] + key_gap), 0});
    else places_.push_back({double(n % columns) * column, n / columns});
  }
  lines_ = places_.back().line + 1;
}

double Key::height() const { return double(lines_) * key_pitch; }

void Key::draw(Figure& figure, double left, double top) const {
  for (std::size_t n = 0; n < entries_.size(); ++n) {
    const KeyEntry& e = entries_[n];
    const double x = left + places_[n].x, y = top + (double(places_[n].line) + 0.5) * key_pitch;
    if (!e.line.empty()) figure.sample(figure.at(x, y), figure.at(x + line_sample, y), e.line);
    if (!e.point.empty()) figure.mark(figure.at(x + 0.5 * point_sample, y), e.point);
    if (!e.fill.empty()) {
      figure.box(fmt::format("from {} to {}", figure.at(x, y + 0.04), figure.at(x + point_sample, y - 0.04)),
                 e.fill.c_str());
    }
    figure.text(e.name, size_, figure.at(x + sample_width(e), y) + " left");
  }
}

AxisMarks::AxisMarks(double lowest, double highest, double length, bool upright, bool rounded)
    : low(lowest), high(highest) {
  if (!(high > low)) {
    const double margin = low == 0.0 ? 1.0 : 0.05 * std::abs(low);
    low -= margin;
    high += margin;
  }
  constexpr double upright_pitch = 0.15, gap = 0.12;
  const double first_low = low, first_high = high;
  double step = round_step((high - low) / std::max(1.0, std::floor(length / upright_pitch)));
  for (int attempt = 0; attempt < 20; ++attempt) {
    low = rounded ? step * std::floor(first_low / step + 1e-9) : first_low;
    high = rounded ? step * std::ceil(first_high / step - 1e-9) : first_high;
    positions.clear();
    labels.clear();
    for (double k = std::ceil(low / step - 1e-6); k * step <= high + 1e-6 * step; ++k) {
      positions.push_back(k * step);
      labels.push_back(mark_label(k * step, step));
    }
    const double pitch = length * step / (high - low);
    if (pitch >= (upright ? 0.8 * upright_pitch : widest() + gap) || positions.size() < 3) break;
    step = round_step(1.01 * step);
  }
}

double AxisMarks::widest() const {
  double width = 0.0;
  for (const std::string& label : labels) width = std::max(width, text_width(label, mark_size));
  return width;
}

std::string AxisMarks::commands(const char* axis, bool labelled) const {
  std::string marks;
  for (std::size_t n = 0; n < positions.size(); ++n) {
    marks += fmt::format("{}'{}' {}", n == 0 ? "" : ",", labelled ? labels[n] : "", positions[n]);
  }
  return fmt::format("set {0}range [{1}:{2}]\nset {0}tics ({3})\n", axis, low, high, marks);
}

}  // namespace wingbeat
