// Step responses of a control model.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/figure.hpp"
#include "wingbeat/report/control_report.hpp"

namespace wingbeat {
namespace {

constexpr std::array response_styles = {style::first_curve, style::second_curve, style::third_curve};

/// The outputs that are drawn, those that the model has.
std::vector<std::size_t> drawn_outputs(const CycleMap& map) {
  std::vector<std::size_t> places;
  for (const char* name : {"lift_mean", "crank_speed_mean", "power_electrical"}) {
    for (std::size_t k = 0; k < map.outputs.size(); ++k) {
      if (map.outputs[k].name == name) places.push_back(k);
    }
  }
  return places;
}

/// Whether every drawn output changes for good after a step of that input.
bool changes_steadily(const LinearModel& model, std::size_t input, const std::vector<std::size_t>& outputs) {
  return std::all_of(outputs.begin(), outputs.end(),
                     [&](std::size_t k) { return model.steady_gain(Eigen::Index(k), Eigen::Index(input)) != 0.0; });
}

/// The drawn outputs after a step of an input, each over its steady change or, where one has none, its largest.
Eigen::MatrixXd drawn_response(const LinearModel& model, std::size_t input, const std::vector<std::size_t>& outputs) {
  const Eigen::MatrixXd& response = model.step_responses[input];
  const bool steadily = changes_steadily(model, input, outputs);
  Eigen::MatrixXd drawn(response.rows(), Eigen::Index(outputs.size()));
  for (Eigen::Index n = 0; n < drawn.cols(); ++n) {
    const auto output = Eigen::Index(outputs[std::size_t(n)]);
    const auto column = response.col(output);
    const double scale = steadily ? model.steady_gain(output, Eigen::Index(input)) : column.lpNorm<Eigen::Infinity>();
    drawn.col(n) = column / (scale == 0.0 ? 1.0 : scale);
  }
  return drawn;
}

/// How many cycles show the responses until they have settled, and a little more; at most those that there are.
Eigen::Index cycles_to_show(const std::vector<Eigen::MatrixXd>& responses) {
  constexpr double settled = 0.02;  // of the change that a response is drawn over
  constexpr Eigen::Index after = 2, fewest = 3;
  Eigen::Index last = 0;
  for (const Eigen::MatrixXd& response : responses) {
    const Eigen::Index rows = response.rows();
    for (Eigen::Index cycle = 0; cycle < rows; ++cycle) {
      if ((response.row(cycle) - response.row(rows - 1)).lpNorm<Eigen::Infinity>() > settled) {
        last = std::max(last, cycle);
      }
    }
  }
  return std::min(std::max(last + 1 + after, fewest), responses.front().rows());
}

std::string in_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

}  // namespace

void plot_step_responses(const ControlModels& models, PlotFormat format, const std::filesystem::path& file) {
  const LinearModel& model = *models.linear.model;
  const CycleMap& map = model.map;
  const std::vector<std::size_t> outputs = drawn_outputs(map);
  std::vector<Eigen::MatrixXd> responses;
  for (std::size_t input = 0; input < map.inputs.size(); ++input) {
    responses.push_back(drawn_response(model, input, outputs));
  }
  // Who asks for a number of cycles gets them.
  const Eigen::Index cycles = models.options.step_cycles > 0 ? responses.front().rows() : cycles_to_show(responses);
  const bool in_seconds = map.period * double(cycles) > 2.0;
  const double period = (in_seconds ? 1.0 : 1e3) * map.period;

  const double head = 0.62, foot = 0.42, each = 0.8, gap = 0.42, left = 0.15, right = 0.97;
  const double inches = head + foot + each * double(map.inputs.size()) + gap * double(map.inputs.size() - 1);
  Figure figure(format, inches);
  for (std::size_t input = 0; input < map.inputs.size(); ++input) {
    // Drawn as the means are: constant over their cycle, from the cycle before the step on.
    figure.add("$r{} << END\n{}", input, -period);
    for (std::size_t k = 0; k < outputs.size(); ++k) figure.add(" 0");
    figure.add("\n");
    for (Eigen::Index cycle = 0; cycle <= cycles; ++cycle) {
      const auto row = responses[input].row(std::min(cycle, cycles - 1));
      figure.add("{}", double(cycle) * period);
      for (const double y : row) figure.add(" {}", y);
      figure.add("\n");
    }
    figure.add("END\n");
  }
  figure.add("set multiplot\nset lmargin at screen {}\nset rmargin at screen {}\n", left, right);
  figure.add("set xrange [{}:{}]\n", -period, double(cycles) * period);
  for (std::size_t input = 0; input < map.inputs.size(); ++input) {
    if (input > 0) figure.next_panel();
    const double top = 1.0 - (head + (each + gap) * double(input)) / inches, bottom = top - each / inches;
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\n", top, bottom);
    const bool steadily = changes_steadily(model, input, outputs);
    const double highest = std::max(1.0, responses[input].topRows(cycles).maxCoeff());
    const double least = std::min(0.0, responses[input].topRows(cycles).minCoeff());
    figure.add("set yrange [{}:{}]\nset ytics {}\n", least - 0.06 * (highest - least),
               highest + 0.1 * (highest - least), highest - least > 2.2 ? 1.0 : 0.5);
    figure.text(fmt::format("step of {}", in_words(map.inputs[input].name)), style::heading_size,
                fmt::format("screen {},{} left", left, top + 0.09 / inches));
    figure.text(steadily ? "per steady change" : "per largest change", style::text_size,
                fmt::format("screen 0.03,{} center rotate by 90", 0.5 * (top + bottom)));
    if (input == 0) {
      figure.text("Change of the means of a cycle after a step", style::title_size,
                  fmt::format("screen 0.5,{} center", 1.0 - 0.12 / inches));
      figure.text(in_seconds ? "time since the step (s)" : "time since the step (ms)", style::text_size,
                  fmt::format("screen {},{} center", 0.5 * (left + right), 0.09 / inches));
      constexpr std::array places = {0.03, 0.29, 0.65};
      for (std::size_t k = 0; k < outputs.size(); ++k) {
        figure.key_entry(places[k], 1.0 - 0.32 / inches, response_styles[k], in_words(map.outputs[outputs[k]].name));
      }
    }
    std::string plots = fmt::format("{} with lines lt 1 dt 1 lw 0.5 lc rgb '#909090'", steadily ? 1 : 0);
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      plots += fmt::format(", $r{} using 1:{} with steps {}", input, k + 2, response_styles[k]);
    }
    figure.add("plot {}\n", plots);
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
}

}  // namespace wingbeat
