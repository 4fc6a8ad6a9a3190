#include "wingbeat/files/netcdf_results.hpp"

#include <fmt/format.h>

#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/study/sweep.hpp"

namespace wingbeat {

using Dimensions = std::vector<NetcdfFile::Dimension>;

NetcdfFile::Variable define_metric(NetcdfFile& file, Metric metric, const Dimensions& over, const std::string& prefix,
                                   const std::string& role) {
  const MetricInfo& info = metric_info(metric);
  return file.define_variable(prefix + info.key, over, info.unit, info.long_name + role);
}

NetcdfFile::Variable define_status(NetcdfFile& file, const Dimensions& over, const std::string& prefix,
                                   const std::string& role) {
  const auto status = file.define_dense(prefix + "status", over, "1", "what the vehicle does from rest" + role,
                                        NetcdfFile::Storage::flag);
  std::vector<std::string> meanings;
  for (int s = 0; s < sweep_status_count; ++s) meanings.push_back(name_of(SweepStatus(s)));
  file.set_flags(status, meanings);
  return status;
}

NetcdfFile::Variable define_domain(NetcdfFile& file, const Dimensions& over, const std::string& prefix,
                                   const std::string& role) {
  const auto domain =
      file.define_dense(prefix + "domain", over, "1", "limits of the model's domain that are exceeded" + role,
                        NetcdfFile::Storage::masks);
  std::vector<std::string> limits;
  std::string meanings;
  for (const DomainLimitInfo& limit : domain_limit_table()) {
    limits.push_back(limit.key);
    meanings += fmt::format("{}{}", meanings.empty() ? "" : "; ", limit.meaning);
  }
  file.set_flag_masks(domain, limits);
  file.set_attribute(domain, "comment", "0: inside, or not flapping. " + meanings);
  return domain;
}

}  // namespace wingbeat
