// What --json prints, as trees of values: the Python package takes them without text in between.
#pragma once

#include <span>
#include <string>

#include "report/control_tree.hpp"
#include "report/report_tools.hpp"
#include "wingbeat/report/endurance_report.hpp"
#include "wingbeat/report/fit_report.hpp"
#include "wingbeat/report/identification_report.hpp"
#include "wingbeat/report/optimise_report.hpp"
#include "wingbeat/report/pareto_report.hpp"
#include "wingbeat/report/tolerance_report.hpp"

namespace wingbeat::detail {

Json endurance_tree(const EnduranceResult& result);
Json tolerance_tree(const ToleranceStudy& study, const ToleranceResult& result);
Json optimum_tree(const OptimiseFile& file, const OptimiseResult& result);
Json motors_tree(const OptimiseFile& file, std::span<const MotorTrial> trials);
Json drive_trains_tree(const OptimiseFile& file, const DriveTrainScreen& screen, std::span<const MotorTrial> trials);
Json front_tree(const OptimiseFile& file, const ParetoStudy& study, const ParetoResult& result);
Json fit_tree(const BenchFit& fit, const FitResult& result, std::span<const FrictionCandidate> candidates);
Json identification_tree(const MotorIdentification& motor, const MotorDatasheet& sheet);

}  // namespace wingbeat::detail
