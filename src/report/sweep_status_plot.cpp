#include "report/sweep_status_plot.hpp"

#include <fmt/format.h>

#include <iterator>

#include "report/figure.hpp"
#include "report/layout.hpp"
#include "report/read_out.hpp"

namespace wingbeat {

std::string nothing_flaps(const std::vector<std::uint64_t>& designs) {
  std::string text;
  for (std::size_t s = 1; s < designs.size(); ++s) {
    if (designs[s] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", designs[s], name_of(SweepStatus(s)));
  }
  return "nothing flaps: " + text;
}

void plot_statuses(const std::string& title, const std::string& x_label, const std::string& x_range,
                   const std::vector<double>& x, const std::vector<StatusCurve>& curves, PlotFormat format,
                   const std::filesystem::path& file) {
  constexpr const char* colours[] = {"#000000", "#8d68b5", "#707070", "#35125e", "#b79fd0", "#a0a0a0"};
  std::vector<std::uint64_t> designs(sweep_status_count, 0);
  std::vector<int> present, row(sweep_status_count, -1);
  for (const StatusCurve& c : curves) {
    for (const int s : c.status) ++designs[std::size_t(s)];
  }
  for (int s = 0; s < sweep_status_count; ++s) {
    if (designs[std::size_t(s)] == 0) continue;
    row[std::size_t(s)] = int(present.size());
    present.push_back(s);
  }
  std::vector<KeyEntry> named;
  for (std::size_t c = 0; curves.size() > 1 && c < curves.size(); ++c) {
    named.push_back(point_key(curves[c].name, fmt::format("pt 7 ps 0.4 lc rgb '{}'", colours[c % 6])));
  }
  const Key key(std::move(named), 0.93 * format.width);
  const double head = 0.5 + key.height();
  const double panel = 0.35 * double(present.size()) + 0.25, foot = 0.5, inches = head + panel + foot;
  const auto y = [&](double from_top) { return 1.0 - from_top / inches; };
  Figure figure(format, inches);
  for (std::size_t c = 0; c < curves.size(); ++c) {
    figure.add("$statuses_{} << END\n", c);
    // Curves beside each other, so that none hides another.
    const double beside = 0.5 * ((double(c) + 0.5) / double(curves.size()) - 0.5);
    for (std::size_t n = 0; n < x.size(); ++n) {
      figure.add("{} {}\n", x[n], row[std::size_t(curves[c].status[n])] + beside);
    }
    figure.add("END\n");
  }
  figure.add(
      "{}set lmargin at screen 0.2\nset rmargin at screen 0.95\nset tmargin at screen {}\n"
      "set bmargin at screen {}\n",
      x_range, y(head), y(head + panel));
  const double room = format.width - 2.0 * page_margin;
  page_title(figure, title, 0.11);
  fitted_text(figure, nothing_flaps(designs), 7.0, room, 0.5 * format.width, 0.29, "center");
  key.draw(figure, 0.05 * format.width, 0.4);
  figure.text(x_label, 7.5, fmt::format("screen 0.58,{} center", 0.12 / inches));
  std::string tics, plots;
  for (std::size_t r = 0; r < present.size(); ++r) {
    tics += fmt::format("{}{} {}", r == 0 ? "" : ",", quoted(name_of(SweepStatus(present[r]))), r);
  }
  for (std::size_t c = 0; c < curves.size(); ++c) {
    plots += fmt::format("{}$statuses_{} using 1:2 with points pt 7 ps 0.3 lc rgb '{}'", c == 0 ? "" : ", ", c,
                         colours[c % 6]);
  }
  figure.add("set ytics ({})\nset yrange [-0.6:{}]\nplot {}\nunset output\n", tics, double(present.size()) - 0.4,
             plots);
  write_figure(figure, format, title, {}, file);
}

}  // namespace wingbeat
