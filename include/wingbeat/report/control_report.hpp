// Control models as text, JSON and TOML, and drawn.
#pragma once

#include <filesystem>
#include <string>

#include "wingbeat/report/plot.hpp"
#include "wingbeat/study/control_models.hpp"

namespace wingbeat {

/// `models.linear.model` may be absent: then why.
std::string text_control(const ControlModels& models);
std::string json_control(const ControlModels& models, const std::string& version);
/// The keys of json_control(); what is null there is nan.
std::string toml_control(const ControlModels& models, const std::string& version);

/// Step responses, one panel for each input: mean lift and, of a crank, speed, electrical power, each as a part of its
/// steady change; of a model that is there. Throws like plot_cycle.
void plot_step_responses(const ControlModels& models, PlotFormat format, const std::filesystem::path& file);

}  // namespace wingbeat
