#include "wingbeat/files/sweep_data_set.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "wingbeat/core/text.hpp"
#include "wingbeat/files/file_record.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/netcdf.hpp"
#include "wingbeat/files/netcdf_results.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat {
namespace {

namespace fs = std::filesystem;
constexpr const char* fingerprint_attribute = "wingbeat_fingerprint";

std::vector<Metric> kept_metrics(const Sweep& sweep) {
  std::vector<Metric> kept;
  for (int m = 0; m < metric_count; ++m) {
    if (sweep.options.metrics[std::size_t(m)]) kept.push_back(Metric(m));
  }
  return kept;
}

/// Counts designs and keeps the best, in the order of their indices.
class Digester {
 public:
  explicit Digester(const Sweep& sweep) : allow_extrapolation_(sweep.allow_extrapolation) {
    const auto kept = kept_metrics(sweep);
    for (std::size_t m = 0; m < kept.size(); ++m) {
      if (kept[m] == Metric::lift_mean) lift_ = int(m);
      if (kept[m] == Metric::power_electrical) power_ = int(m);
      if (kept[m] == Metric::efficiency_system) efficiency_ = int(m);
      if (kept[m] == Metric::lift_to_weight) weight_ = int(m);
    }
    if (sweep.hold && sweep.hold->held == Held::lift_to_weight) weight_ = -1;  // all have the same
    const bool lifts_alike = sweep.hold && (sweep.hold->held == Held::lift || sweep.hold->held == Held::lift_to_weight);
    if (lifts_alike) lift_ = -1;
    else power_ = -1;
  }

  void add(const SweepColumns& columns) {
    for (std::size_t row = 0; row < columns.status.size(); ++row) {
      ++digest_.designs[static_cast<unsigned char>(columns.status[row])];
      digest_.recomputed += columns.recomputed[row] != 0;
      digest_.outside += columns.domain[row] != 0;
      for (std::size_t k = 0; k < digest_.beyond.size(); ++k) digest_.beyond[k] += columns.domain[row] >> k & 1;
    }
    if (lift_ >= 0) best(digest_.lift, columns, lift_);
    if (power_ >= 0) best(digest_.power, columns, power_);
    if (efficiency_ >= 0) best(digest_.efficiency, columns, efficiency_);
  }

  const SweepDigest& digest() const { return digest_; }

 private:
  void best(SweepBest& best, const SweepColumns& columns, int metric) const {
    const auto& values = columns.metrics[std::size_t(metric)];
    for (std::size_t row = 0; row < values.size(); ++row) {
      if (!columns.counts(row, allow_extrapolation_)) continue;
      best.offer(columns.first + row, values[row], weight_ < 0 ? absent : columns.metrics[std::size_t(weight_)][row]);
    }
  }

  SweepDigest digest_;
  bool allow_extrapolation_;
  int lift_ = -1, power_ = -1, efficiency_ = -1, weight_ = -1;
};

struct CloseHdf5 {
  herr_t (*close)(hid_t);
  hid_t id;
  ~CloseHdf5() {
    if (id >= 0) close(id);
  }
};

/// Where the values of contiguous variables begin in a NetCDF-4 file [bytes].
std::vector<std::uint64_t> places_in_file(const fs::path& path, const std::vector<std::string>& names) {
  const auto failed = [&](const std::string& name) {
    throw NetcdfError(fmt::format("{}: cannot find the place of {}", path.string(), name));
  };
  const CloseHdf5 file{H5Fclose, H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)};
  std::vector<std::uint64_t> places;
  for (const std::string& name : names) {
    const CloseHdf5 variable{H5Dclose, H5Dopen2(file.id, name.c_str(), H5P_DEFAULT)};
    const haddr_t place = variable.id >= 0 ? H5Dget_offset(variable.id) : HADDR_UNDEF;
    if (place == HADDR_UNDEF) failed(name);
    places.push_back(place);
  }
  return places;
}

std::string title_of(const Study& study) { return study.title.empty() ? "Sweep of a flapping vehicle" : study.title; }

/// Texts longer than an attribute should be go into a variable of characters.
void write_input(NetcdfFile& file, const Study& study, std::string_view version) {
  const Sweep& sweep = study.sweep;
  write_provenance(file, {.title = title_of(study),
                          .command = "sweep",
                          .version = std::string(version),
                          .vehicle = study.input.vehicle,
                          .study = study.input.study,
                          .tolerance = sweep.options.tolerance});
  const auto name_in = [](const std::string& path) { return detail::printable(written_name(path)); };
  file.set_attribute("study_name", name_in(study.input.study_name));
  if (!study.input.table.empty()) file.set_attribute("samples_name", name_in(study.input.table_name));
  for (const auto& [name, isa] : instruction_sets) {
    if (isa == sweep.options.isa) file.set_attribute("instruction_set", name);
  }
  file.set_attribute("comment",
                     "wingbeat sweep FILE.nc -o NEW.nc computes this data set again: `study` is the study file, "
                     "`vehicle` the vehicle with [set] applied. Metrics are NaN where status is not flapping, or where "
                     "the vehicle lacks what they need.");
}

}  // namespace

std::uint64_t fingerprint(const Study& study, std::string_view version) {
  std::uint64_t sum = 1;
  const auto add = [&](std::string_view text) { sum = checksum(std::as_bytes(std::span(text)), sum); };
  add("7");
  add(version);
  add(study.input.study);
  add(study.input.vehicle);
  add(study.input.table);
  add(fmt::format("{} {} {} {}", study.sweep.options.tolerance, int(study.sweep.options.isa),
                  study.sweep.options.scalar_only, study.sweep.options.metrics.to_string()));
  // Where hover ends depends on it, and nothing else that is stored.
  if (study.sweep.options.metrics[std::size_t(Metric::hover)]) add(study.sweep.allow_extrapolation ? "1" : "0");
  return sum;
}

std::vector<std::uint64_t> prepare_data_set(const fs::path& path, const Study& study, std::string_view version) {
  const Sweep& sweep = study.sweep;
  using Storage = NetcdfFile::Storage;
  // Its room is reserved.
  NetcdfFile file(path, NetcdfFile::Place::disk);
  write_input(file, study, version);
  file.set_attribute(fingerprint_attribute, fmt::format("{:016x}", fingerprint(study, version)));

  std::vector<NetcdfFile::Dimension> dimensions;
  for (const SweepAxis& axis : sweep.axes) {
    dimensions.push_back(file.define_dimension(axis.name, std::size_t(axis.count)));
  }
  // All definitions first: a change of what is defined rewrites the beginning of the file.
  std::string auxiliary;
  std::vector<std::vector<NetcdfFile::Variable>> coordinates(sweep.axes.size());
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    const SweepAxis& axis = sweep.axes[a];
    for (const SweptQuantity& q : axis.quantities) {
      const std::string meaning = fmt::format("{} ({})", q.meaning, q.key);
      NetcdfFile::Variable variable{};
      if (q.kind == SweptQuantity::Kind::choice) {
        variable = file.define_texts(q.name, dimensions[a], q.labels, meaning);
      } else {
        variable = file.define_dense(q.name, {dimensions[a]}, q.unit, meaning);
      }
      file.set_key(variable, q.key);
      if (q.name != axis.name) auxiliary += (auxiliary.empty() ? "" : " ") + q.name;
      coordinates[a].push_back(variable);
    }
  }
  std::optional<NetcdfFile::Variable> sample;
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    if (!sweep.axes[a].samples) continue;
    sample =
        file.define_dense(sweep.axes[a].name, {dimensions[a]}, "1", "number of the sample, from 0", Storage::whole);
  }
  const auto with_coordinates = [&](NetcdfFile::Variable variable) {
    if (!auxiliary.empty()) file.set_attribute(variable, "coordinates", auxiliary);
    return variable;
  };
  const auto define = [&](const char* name, const char* unit, const char* meaning, Storage storage) {
    return with_coordinates(file.define_dense(name, dimensions, unit, meaning, storage));
  };
  std::vector<NetcdfFile::Variable> columns;
  columns.push_back(with_coordinates(define_status(file, dimensions)));
  columns.push_back(define("recomputed", "1", "solver that gave the result", Storage::flag));
  file.set_flags(columns.back(), std::vector<std::string>{"batch", "scalar"});
  columns.push_back(with_coordinates(define_domain(file, dimensions)));
  columns.push_back(define("error_estimate", "1", "estimated relative error of the metrics", Storage::real));
  for (const Metric m : kept_metrics(sweep)) {
    columns.push_back(define(metric_info(m).key, metric_info(m).unit, metric_info(m).long_name, Storage::real));
  }
  if (!study.input.table.empty()) {
    const std::string texts[] = {study.input.table};
    file.define_texts("samples_file", file.define_dimension("samples_file_count", 1), texts,
                      "the CSV file of the designs");
  }

  std::vector<double> block;
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    const SweepAxis& axis = sweep.axes[a];
    for (std::size_t q = 0; q < axis.quantities.size(); ++q) {
      if (axis.quantities[q].kind == SweptQuantity::Kind::choice) continue;
      for (std::uint64_t first = 0; first < axis.count; first += 8192) {
        block.clear();
        const std::uint64_t end = std::min<std::uint64_t>(axis.count, first + 8192);
        for (std::uint64_t n = first; n < end; ++n) block.push_back(axis.value(q, n));
        file.write_run(coordinates[a][q], std::size_t(first), block);
      }
    }
  }

  for (std::uint64_t first = 0; sample && first < sample->dimensions.front().length; first += 8192) {
    block.clear();
    const std::uint64_t end = std::min<std::uint64_t>(sample->dimensions.front().length, first + 8192);
    for (std::uint64_t n = first; n < end; ++n) block.push_back(double(n));
    file.write_run(*sample, std::size_t(first), block);
  }

  // A value at the end makes room for all before it.
  const std::size_t last = std::size_t(sweep.size() - 1);
  const double nothing = 0.0;
  const std::int8_t no_flag = 0;
  const std::int16_t no_masks = 0;
  const ChunkLayout layout = layout_of(sweep);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    switch (layout.bytes_of_value(c)) {
      case 1: file.write_run(columns[c], last, std::span(&no_flag, 1)); break;
      case 2: file.write_run(columns[c], last, std::span(&no_masks, 1)); break;
      default: file.write_run(columns[c], last, std::span(&nothing, 1));
    }
  }
  file.close();
  std::vector<std::string> names = {"status", "recomputed", "domain", "error_estimate"};
  for (const Metric m : kept_metrics(sweep)) names.push_back(metric_info(m).key);
  return places_in_file(path, names);
}

SweepDigest digest_of(const fs::path& path, const Study& study) {
  const NetcdfReader file(path);
  const ChunkLayout layout = layout_of(study.sweep);
  const std::vector<Metric> kept = kept_metrics(study.sweep);
  Digester digester(study.sweep);
  SweepColumns columns;
  std::vector<double> values;
  for (std::uint64_t c = 0; c < layout.chunks(); ++c) {
    columns.first = layout.first(c);
    columns.resize(std::size_t(layout.size(c)), kept.size());
    file.read_run("status", columns.first, columns.status);
    file.read_run("recomputed", columns.first, columns.recomputed);
    file.read_run("domain", columns.first, columns.domain);
    for (std::size_t m = 0; m < kept.size(); ++m) {
      const bool wanted = kept[m] == Metric::lift_mean || kept[m] == Metric::power_electrical ||
                          kept[m] == Metric::efficiency_system || kept[m] == Metric::lift_to_weight;
      if (wanted) file.read_run(metric_info(kept[m]).key, columns.first, columns.metrics[m]);
    }
    digester.add(columns);
  }
  return digester.digest();
}

Study read_study_in_data_set(const fs::path& path) {
  const auto refuse = [&](const std::string& reason) { throw InputError(path.string(), 0, 0, "", reason); };
  std::error_code error;
  if (!fs::exists(path, error)) refuse("no such file");
  try {
    const NetcdfReader file(path);
    FileRecord::of_this_program().add_read(path);
    StudyInput input;
    const auto study = file.attribute("study"), vehicle = file.attribute("vehicle"),
               tolerance = file.attribute("tolerance");
    const bool swept = file.attribute(fingerprint_attribute).has_value();
    if (!study || !vehicle || !tolerance || !swept) refuse("holds no study: it was not written by wingbeat sweep");
    input.study_name = path.string() + " (study)";
    if (const auto name = file.attribute("study_name")) input.study_name = *name;
    input.study = *study;
    input.vehicle = *vehicle;
    if (file.has("samples_file")) input.table = file.text("samples_file");
    if (const auto name = file.attribute("samples_name")) input.table_name = *name;
    Study result = parse_study(input);
    result.sweep.options.tolerance = std::strtod(tolerance->c_str(), nullptr);
    return result;
  } catch (const NetcdfError& e) {
    refuse("cannot be read as a data set");
    throw;
  }
}

Standing standing_of(const fs::path& path, std::uint64_t fingerprint, const std::string& option, bool force) {
  const auto refuse = [&](const std::string& reason) {
    throw InputError(fmt::format("{} {}", option, path.string()), 0, 0, "",
                     reason + "; it is left as it is: give another name, or --force to replace it");
  };
  std::error_code error;
  const auto status = fs::status(path, error);
  if (!fs::exists(status)) return Standing::nothing;
  if (fs::is_directory(status)) throw InputError(fmt::format("{} {}", option, path.string()), 0, 0, "", "is a folder");
  if (!fs::is_regular_file(status)) {
    throw InputError(fmt::format("{} {}", option, path.string()), 0, 0, "", "is not a regular file");
  }
  std::optional<std::string> found;
  try {
    found = NetcdfReader(path).attribute(fingerprint_attribute);
  } catch (const NetcdfError&) {
    if (force) return Standing::nothing;
    refuse("exists and cannot be read as a data set (foreign, damaged or cut off)");
  }
  if (force && (!found || *found != fmt::format("{:016x}", fingerprint))) return Standing::nothing;
  if (!found) refuse("exists and is no data set of wingbeat sweep");
  if (*found != fmt::format("{:016x}", fingerprint)) {
    refuse("holds another sweep (another study, vehicle, option or version of the program)");
  }
  return Standing::same_sweep;
}

std::uint64_t data_set_size(const Study& study) {
  const Sweep& sweep = study.sweep;
  std::uint64_t bytes = 100000 + study.input.study.size() + study.input.vehicle.size() + study.input.table.size();
  for (const SweepAxis& axis : sweep.axes) bytes += 8 * axis.count * axis.quantities.size();
  return bytes + sweep.size() * (ChunkLayout::bytes_of_flags + 8 * (1 + sweep.options.metrics.count()));
}

}  // namespace wingbeat
