// A tolerance study as text, JSON and a plot.
#pragma once

#include <filesystem>
#include <string>

#include "wingbeat/report/plot.hpp"
#include "wingbeat/study/flight_tolerance.hpp"
#include "wingbeat/study/tolerance.hpp"

namespace wingbeat {

/// A readable report of at most 100 columns.
std::string text_tolerance(const ToleranceStudy& study, const ToleranceResult& result);

/// One JSON object: probabilities, and for each output its distribution, linear prediction and Sobol indices.
std::string json_tolerance(const ToleranceStudy& study, const ToleranceResult& result);

/// Steady flight of the vehicles drawn, as text of at most 100 columns and as JSON.
std::string text_flight_tolerance(const ToleranceStudy& study, const FlightCondition& condition,
                                  const FlightToleranceResult& result);
std::string json_flight_tolerance(const ToleranceStudy& study, const FlightCondition& condition,
                                  const FlightToleranceResult& result);

/// The output that a figure shows unless another is asked for: lift to weight where the mass is known, else mean lift,
/// else the first one that varies; null where nothing varies.
const ToleranceOutput* main_output(const ToleranceResult& result);

/// The distribution of a metric with the linear prediction, and what it comes from, factor by factor. Throws like
/// plot_cycle.
void plot_tolerance(const ToleranceStudy& study, const SweepColumns& columns, const ToleranceOutput& output,
                    PlotFormat format, const std::filesystem::path& file);

}  // namespace wingbeat
