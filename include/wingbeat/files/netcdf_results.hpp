// Variables that several data sets of results have, as the tables of metrics, statuses and limits describe them.
#pragma once

#include <string>
#include <vector>

#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace wingbeat {

/// A metric under its key, with its unit and meaning. `prefix` comes before the key, `role` follows the meaning.
NetcdfFile::Variable define_metric(NetcdfFile& file, Metric metric, const std::vector<NetcdfFile::Dimension>& over,
                                   const std::string& prefix = "", const std::string& role = "");

/// Statuses of vehicles: flags.
NetcdfFile::Variable define_status(NetcdfFile& file, const std::vector<NetcdfFile::Dimension>& over,
                                   const std::string& prefix = "", const std::string& role = "");

/// Limits of the domain of validity that are exceeded: masks.
NetcdfFile::Variable define_domain(NetcdfFile& file, const std::vector<NetcdfFile::Dimension>& over,
                                   const std::string& prefix = "", const std::string& role = "");

}  // namespace wingbeat
