// A flight as text and JSON, and drawn.
#pragma once

#include <filesystem>
#include <string>

#include "wingbeat/flight/fly.hpp"
#include "wingbeat/report/plot.hpp"

namespace wingbeat {

struct FlyReport {
  std::string title;
  const FlightVehicle* vehicle = nullptr;
  const FlightPlan* plan = nullptr;
  FlightRecord flight;
};

std::string text_fly(const FlyReport& report);
std::string json_fly(const FlyReport& report);
/// Position beside the path, attitude, controls with their limits, power over the time. Throws like plot_cycle.
void plot_fly(const FlyReport& report, PlotFormat format, const std::filesystem::path& file);

}  // namespace wingbeat
