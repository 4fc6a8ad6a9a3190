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

std::string in_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

}  // namespace

void plot_step_responses(const ControlModels& models, PlotFormat format, const std::filesystem::path& file) {
  const LinearModel& model = *models.linear.model;
  const CycleMap& map = model.map;
  const std::vector<std::size_t> outputs = drawn_outputs(map);
  const double head = 0.42, foot = 0.42, each = 1.05, gap = 0.48, left = 0.13, right = 0.96;
  const double inches = head + foot + (each + gap) * double(map.inputs.size());
  Figure figure(format, inches);
  for (std::size_t input = 0; input < map.inputs.size(); ++input) {
    const Eigen::MatrixXd& response = model.step_responses[input];
    figure.add("$r{} << END\n", input);
    for (Eigen::Index cycle = 0; cycle < response.rows(); ++cycle) {
      // Drawn as the means are: constant over their cycle.
      figure.add("{}", double(cycle) * map.period * 1e3);
      for (const std::size_t k : outputs) {
        const auto column = response.col(Eigen::Index(k));
        const double scale = changes_steadily(model, input, outputs)
                                 ? model.steady_gain(Eigen::Index(k), Eigen::Index(input))
                                 : column.lpNorm<Eigen::Infinity>();
        figure.add(" {}", column[cycle] / (scale == 0.0 ? 1.0 : scale));
      }
      figure.add("\n");
    }
    figure.add("END\n");
  }
  figure.add("set multiplot\nset lmargin at screen {}\nset rmargin at screen {}\n", left, right);
  figure.add("set yrange [*<-0.05:1.15<*]\nset ytics autofreq\nset xrange [0:*]\n");
  for (std::size_t input = 0; input < map.inputs.size(); ++input) {
    if (input > 0) figure.next_panel();
    const double top = 1.0 - (head + gap + (each + gap) * double(input)) / inches;
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\n", top, top - each / inches);
    const char* const scale = changes_steadily(model, input, outputs) ? "" : ", as parts of their largest change";
    figure.text(fmt::format("step of {}{}", in_words(map.inputs[input].name), scale), 7.5,
                fmt::format("screen {},{} left", left, top + 0.09 / inches));
    if (input == 0) {
      figure.text("Means of a cycle after a step, as parts of their steady change", 8.0,
                  fmt::format("screen 0.5,{} center", 1.0 - 0.12 / inches));
      figure.text("time since the step (ms)", 7.5,
                  fmt::format("screen {},{} center", 0.5 * (left + right), 0.09 / inches));
      constexpr std::array places = {0.0, 0.22, 0.56};
      for (std::size_t k = 0; k < outputs.size(); ++k) {
        figure.key_entry(left + places[k], 1.0 - 0.32 / inches, response_styles[k],
                         in_words(map.outputs[outputs[k]].name));
      }
    }
    std::string plots = "1 with lines lt 1 dt 1 lw 0.5 lc rgb '#909090'";
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      plots += fmt::format(", $r{} using 1:{} with steps {}", input, k + 2, response_styles[k]);
    }
    figure.add("plot {}\n", plots);
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
}

}  // namespace wingbeat
