#include <fmt/format.h>

#include "report/schema_tools.hpp"
#include "wingbeat/study/allocation.hpp"
#include "wingbeat/study/body_derivatives.hpp"

namespace wingbeat::schema {

Json linearise_schema() {
  const Json values = listed(number_if_any), matrix = listed(values);
  const Json signals = listed(object({{"name", any_text}, {"unit", any_text}, {"value", number_if_any}}));
  const Json mode = object({{"multiplier_real", any_number},
                            {"multiplier_imaginary", any_number},
                            {"time_constant_s", number_if_any},
                            {"natural_frequency_rad_per_s", number_if_any},
                            {"damping_ratio", number_if_any},
                            {"settled", yes_or_no}});
  const SchemaKeys matrices = {{"A", matrix}, {"B", matrix}, {"C", matrix}, {"D", matrix}};
  const Json model = object(SchemaKeys{{"period_s", any_number},
                                       {"states", signals},
                                       {"inputs", signals},
                                       {"outputs", signals},
                                       {"steady_gain", matrix},
                                       {"modes", listed(mode)},
                                       {"continuous", object(SchemaKeys{{"states", signals}} + matrices)},
                                       {"step_responses", by_name(by_name(values))}} +
                            matrices);
  SchemaKeys columns, slopes = {{"at", number_if_any}}, derivatives;
  for (const AllocationColumn& column : allocation_columns) {
    columns.push_back({column.name, values});
    slopes.push_back({column.name, number_if_any});
  }
  for (const char* load : body_loads) {
    for (const char* motion : body_motions) derivatives.push_back({fmt::format("{}_{}", load, motion), number_if_any});
  }
  for (const AllocationSlope& slope : allocation_slopes) columns.push_back({slope.name, object(slopes)});
  const Json map =
      object(SchemaKeys{{"input", one_of_names<AllocationInput>()}, {"unit", any_text}, {"values", values}} + columns);
  return object(
      {{"written_by", any_text},
       {"vehicle", any_text},
       {"condition", any_text},
       {"status", statuses()},
       {"status_detail", any_text},
       {"domain", domain},
       {"voltage_v", number_if_any},
       {"frequency_hz", number_if_any},
       {"lift_mean_n", number_if_any},
       {"model", or_null(model)}},
      {{"static_maps", listed(map)}, {"hinge_offset_m", any_number}, {"body_derivatives", object(derivatives)}});
}

}  // namespace wingbeat::schema
