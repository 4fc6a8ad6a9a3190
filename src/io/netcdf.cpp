#include "wingbeat/io/netcdf.hpp"

#include <fmt/format.h>
#include <netcdf.h>

#include <limits>

namespace wingbeat {

NetcdfFile::NetcdfFile(const std::filesystem::path& file) : file_(file.string()) {
  check(nc_create(file_.c_str(), NC_NETCDF4 | NC_CLOBBER, &id_), "create the file");
}

NetcdfFile::~NetcdfFile() {
  if (id_ >= 0) nc_close(id_);
}

NetcdfFile::Dimension NetcdfFile::define_dimension(const std::string& name, std::size_t length) {
  Dimension dimension{0, length};
  check(nc_def_dim(id_, name.c_str(), length, &dimension.id), "define dimension " + name);
  return dimension;
}

NetcdfFile::Variable NetcdfFile::define_variable(const std::string& name, const std::vector<Dimension>& dimensions,
                                                 const std::string& unit, const std::string& long_name) {
  Variable variable{0, dimensions};
  std::vector<int> ids;
  for (const Dimension& d : dimensions) ids.push_back(d.id);
  check(nc_def_var(id_, name.c_str(), NC_DOUBLE, int(ids.size()), ids.data(), &variable.id),
        "define variable " + name);
  const double fill = std::numeric_limits<double>::quiet_NaN();
  check(nc_def_var_fill(id_, variable.id, NC_FILL, &fill), "set the fill value of " + name);
  set_attribute(variable, "units", unit);
  set_attribute(variable, "long_name", long_name);
  return variable;
}

void NetcdfFile::set_attribute(const std::string& name, std::string_view text) {
  check(nc_put_att_text(id_, NC_GLOBAL, name.c_str(), text.size(), text.data()), "set attribute " + name);
}

void NetcdfFile::set_attribute(const Variable& variable, const std::string& name, std::string_view text) {
  check(nc_put_att_text(id_, variable.id, name.c_str(), text.size(), text.data()), "set attribute " + name);
}

void NetcdfFile::write(const Variable& variable, std::span<const double> values) {
  std::vector<std::size_t> start(variable.dimensions.size(), 0), count;
  for (const Dimension& d : variable.dimensions) count.push_back(d.length);
  write(variable, start, count, values);
}

void NetcdfFile::write(const Variable& variable, std::span<const std::size_t> start,
                       std::span<const std::size_t> count, std::span<const double> values) {
  std::size_t expected = 1;
  for (const std::size_t n : count) expected *= n;
  const std::size_t rank = variable.dimensions.size();
  if (start.size() != rank || count.size() != rank || values.size() != expected) {
    throw NetcdfError(fmt::format("{}: cannot write: {} values for a block of {}", file_, values.size(), expected));
  }
  check(nc_put_vara_double(id_, variable.id, start.data(), count.data(), values.data()), "write values");
}

void NetcdfFile::close() {
  const int id = id_;
  id_ = -1;
  check(nc_close(id), "finish the file");
}

void NetcdfFile::check(int status, const std::string& action) const {
  if (status != NC_NOERR) throw NetcdfError(fmt::format("{}: cannot {}: {}", file_, action, nc_strerror(status)));
}

void write_provenance(NetcdfFile& file, const Provenance& provenance) {
  file.set_attribute("title", provenance.title);
  file.set_attribute("wingbeat_version", provenance.version);
  file.set_attribute("input", provenance.input);
  file.set_attribute("condition", provenance.condition);
  file.set_attribute("method", provenance.method);
  file.set_attribute("tolerance", fmt::format("{}", provenance.tolerance));
}

}  // namespace wingbeat
