// What a sweep of which nothing flaps is drawn as: the status of every design instead of metrics that none has.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "wingbeat/report/plot.hpp"
#include "wingbeat/study/sweep.hpp"

namespace wingbeat {

struct StatusCurve {
  std::string name;         ///< the choices; empty where there are none
  std::vector<int> status;  ///< SweepStatus, one for each x
};

/// "nothing flaps: 12 stalled, 9 locked".
std::string nothing_flaps(const std::vector<std::uint64_t>& designs_by_status);

/// Statuses over one axis. Throws like plot_cycle.
void plot_statuses(const std::string& title, const std::string& x_label, const std::string& x_range,
                   const std::vector<double>& x, const std::vector<StatusCurve>& curves, PlotFormat format,
                   const std::filesystem::path& file);

}  // namespace wingbeat
