#include "wingbeat/files/netcdf.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <netcdf.h>
#include <netcdf_mem.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>

#include "wingbeat/core/text.hpp"
#include "wingbeat/files/stored_file.hpp"

namespace wingbeat {

namespace {

/// An open file under a name that netCDF takes as it stands: a backslash in a path it makes a slash.
class PlainName {
 public:
  PlainName(const std::string& file, int flags) : name_(file) {
    if (file.find('\\') == std::string::npos) return;
    open_ = ::open(file.c_str(), flags | O_CLOEXEC, 0666);
    if (open_ >= 0) name_ = fmt::format("/proc/self/fd/{}", open_);
  }
  PlainName(const PlainName&) = delete;
  PlainName& operator=(const PlainName&) = delete;
  ~PlainName() {
    if (open_ >= 0) ::close(open_);
  }
  const char* get() const { return name_.c_str(); }

 private:
  std::string name_;
  int open_ = -1;
};

/// Why a file cannot be created. netCDF answers "Permission denied" whatever the reason; the system knows better.
std::string reason_of(int status, const std::string& file) {
  constexpr off_t room = 65536;
  const int there = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (there < 0) return std::strerror(errno);
  const int reason = ::posix_fallocate(there, 0, room);
  (void)!::ftruncate(there, 0);
  ::close(there);
  return reason != 0 ? std::strerror(reason) : nc_strerror(status);
}

}  // namespace

void silence_hdf5() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

NetcdfFile::NetcdfFile(const std::filesystem::path& file, Place place) : file_(file.string()), place_(place) {
  // Nor would it survive the files that an error left open, at the end of the program.
  static const auto once = H5dont_atexit();
  (void)once;
  const auto refuse = [&](const std::string& reason) {
    throw NetcdfError(fmt::format("{}: cannot create the file: {}", file_, reason));
  };
  if (place == Place::memory) {
    constexpr std::size_t first_size = 65536;
    const int there = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (there < 0) refuse(std::strerror(errno));
    ::close(there);
    const int status = nc_create_mem(file_.c_str(), NC_NETCDF4, first_size, &id_);
    if (status != NC_NOERR) refuse(nc_strerror(status));
    return;
  }
  const PlainName name(file_, O_RDWR | O_CREAT);
  const int status = nc_create(name.get(), NC_NETCDF4 | NC_CLOBBER, &id_);
  if (status != NC_NOERR) refuse(reason_of(status, file_));
}

NetcdfFile::~NetcdfFile() {
  if (id_ < 0) return;
  if (place_ == Place::disk) {
    if (!failed_) nc_close(id_);
    return;
  }
  NC_memio content{};
  nc_close_memio(id_, &content);
  std::free(content.memory);
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
  check(nc_def_var(id_, name.c_str(), NC_DOUBLE, int(ids.size()), ids.data(), &variable.id), "define variable " + name);
  // A coordinate variable, which has the name of its dimension, holds a value everywhere: CF forbids it a fill value.
  char along[NC_MAX_NAME + 1] = {};
  if (ids.size() == 1) check(nc_inq_dimname(id_, ids[0], along), "read the name of a dimension");
  const bool coordinate = name == along;
  const double fill = std::numeric_limits<double>::quiet_NaN();
  check(nc_def_var_fill(id_, variable.id, coordinate ? NC_NOFILL : NC_FILL, coordinate ? nullptr : &fill),
        "set the fill value of " + name);
  set_attribute(variable, "units", unit);
  set_attribute(variable, "long_name", long_name);
  return variable;
}

NetcdfFile::Variable NetcdfFile::define_dense(const std::string& name, const std::vector<Dimension>& dimensions,
                                              const std::string& unit, const std::string& long_name, Storage storage) {
  Variable variable{0, dimensions};
  std::vector<int> ids;
  for (const Dimension& d : dimensions) ids.push_back(d.id);
  nc_type type = NC_DOUBLE;
  switch (storage) {
    case Storage::real: break;
    case Storage::whole: type = NC_INT; break;
    case Storage::flag: type = NC_BYTE; break;
    case Storage::masks: type = NC_SHORT; break;
  }
  check(nc_def_var(id_, name.c_str(), type, int(ids.size()), ids.data(), &variable.id), "define variable " + name);
  check(nc_def_var_fill(id_, variable.id, NC_NOFILL, nullptr), "set the fill mode of " + name);
  if (!ids.empty()) {
    check(nc_def_var_chunking(id_, variable.id, NC_CONTIGUOUS, nullptr), "lay out variable " + name);
  }
  set_attribute(variable, "units", unit);
  set_attribute(variable, "long_name", long_name);
  return variable;
}

NetcdfFile::Variable NetcdfFile::define_texts(const std::string& name, Dimension dimension,
                                              std::span<const std::string> texts, const std::string& long_name) {
  std::size_t width = 1;
  for (const std::string& text : texts) width = std::max(width, text.size());
  const Dimension letters = define_dimension(name + "_letters", width);
  Variable variable{0, {dimension, letters}};
  const int ids[] = {dimension.id, letters.id};
  check(nc_def_var(id_, name.c_str(), NC_CHAR, 2, ids, &variable.id), "define variable " + name);
  set_attribute(variable, "long_name", long_name);
  set_attribute(variable, "_Encoding", "utf-8");
  std::string all;
  for (const std::string& text : texts) {
    all += text;
    all.append(width - text.size(), '\0');
  }
  check(nc_put_var_text(id_, variable.id, all.data()), "write values");
  return variable;
}

void NetcdfFile::set_flags(const Variable& variable, std::span<const std::string> meanings) {
  std::vector<signed char> values;
  std::string names;
  for (const std::string& meaning : meanings) {
    names += (names.empty() ? "" : " ") + meaning;
    values.push_back(static_cast<signed char>(values.size()));
  }
  check(nc_put_att_schar(id_, variable.id, "flag_values", NC_BYTE, values.size(), values.data()),
        "set attribute flag_values");
  set_attribute(variable, "flag_meanings", names);
}

void NetcdfFile::set_flag_masks(const Variable& variable, std::span<const std::string> meanings) {
  std::vector<short> masks;
  std::string names;
  for (const std::string& meaning : meanings) {
    names += (names.empty() ? "" : " ") + meaning;
    masks.push_back(static_cast<short>(1 << masks.size()));
  }
  check(nc_put_att_short(id_, variable.id, "flag_masks", NC_SHORT, masks.size(), masks.data()),
        "set attribute flag_masks");
  set_attribute(variable, "flag_meanings", names);
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

void NetcdfFile::write(const Variable& variable, std::span<const std::size_t> start, std::span<const std::size_t> count,
                       std::span<const double> values) {
  std::size_t expected = 1;
  for (const std::size_t n : count) expected *= n;
  const std::size_t rank = variable.dimensions.size();
  if (start.size() != rank || count.size() != rank || values.size() != expected) {
    throw NetcdfError(fmt::format("{}: cannot write: {} values for a block of {}", file_, values.size(), expected));
  }
  check(nc_put_vara_double(id_, variable.id, start.data(), count.data(), values.data()), "write values");
}

namespace {

/// Calls put(offset, start, count) for the blocks that a run of values is made of: the largest that begin where the run
/// has come to and are whole along their last dimensions.
template <class Put>
void for_each_block(const std::vector<NetcdfFile::Dimension>& dimensions, std::size_t first, std::size_t length,
                    const Put& put) {
  const std::size_t rank = dimensions.size();
  std::vector<std::size_t> start(rank), count(rank);
  for (std::size_t done = 0; done < length;) {
    std::size_t rest = first + done;
    for (std::size_t d = rank; d-- > 0;) {
      start[d] = rest % dimensions[d].length;
      rest /= dimensions[d].length;
    }
    std::size_t size = 1, d = rank;
    std::fill(count.begin(), count.end(), std::size_t(1));
    while (d > 0) {
      --d;
      count[d] = std::min(dimensions[d].length - start[d], (length - done) / size);
      size *= count[d];
      if (start[d] != 0 || count[d] != dimensions[d].length) break;
    }
    put(done, start.data(), count.data());
    done += size;
  }
}

}  // namespace

void NetcdfFile::write_run(const Variable& variable, std::size_t first, std::span<const double> values) {
  for_each_block(variable.dimensions, first, values.size(),
                 [&](std::size_t done, const std::size_t* start, const std::size_t* count) {
                   check(nc_put_vara_double(id_, variable.id, start, count, values.data() + done), "write values");
                 });
}

void NetcdfFile::write_run(const Variable& variable, std::size_t first, std::span<const std::int8_t> values) {
  for_each_block(variable.dimensions, first, values.size(),
                 [&](std::size_t done, const std::size_t* start, const std::size_t* count) {
                   check(nc_put_vara_schar(id_, variable.id, start, count, values.data() + done), "write values");
                 });
}

void NetcdfFile::write_run(const Variable& variable, std::size_t first, std::span<const std::int16_t> values) {
  for_each_block(variable.dimensions, first, values.size(),
                 [&](std::size_t done, const std::size_t* start, const std::size_t* count) {
                   check(nc_put_vara_short(id_, variable.id, start, count, values.data() + done), "write values");
                 });
}

void NetcdfFile::close() {
  const int id = id_;
  id_ = -1;
  if (place_ == Place::disk) {
    check(nc_close(id), "finish the file");
    return;
  }
  NC_memio content{};
  const int status = nc_close_memio(id, &content);
  const std::unique_ptr<void, void (*)(void*)> memory(content.memory, std::free);
  check(status, "finish the file");
  try {
    store(file_, {static_cast<const char*>(content.memory), content.size});
  } catch (const std::runtime_error& error) {
    throw NetcdfError(error.what());
  }
}

void NetcdfFile::check(int status, const std::string& action) const {
  if (status == NC_NOERR) return;
  failed_ = true;
  // Of a full disk HDF5 says nothing; the system does.
  const bool by_system = status == NC_EHDFERR && (errno == ENOSPC || errno == EDQUOT || errno == EFBIG || errno == EIO);
  throw NetcdfError(
      fmt::format("{}: cannot {}: {}", file_, action, by_system ? std::strerror(errno) : nc_strerror(status)));
}

NetcdfReader::NetcdfReader(const std::filesystem::path& file) : file_(file.string()) {
  const PlainName name(file_, O_RDONLY);
  check(nc_open(name.get(), NC_NOWRITE, &id_), "open the file");
}

NetcdfReader::~NetcdfReader() { nc_close(id_); }

bool NetcdfReader::has(const std::string& variable) const {
  int id = 0;
  return nc_inq_varid(id_, variable.c_str(), &id) == NC_NOERR;
}

std::optional<std::string> NetcdfReader::attribute(const std::string& name) const {
  nc_type type = 0;
  std::size_t length = 0;
  if (nc_inq_att(id_, NC_GLOBAL, name.c_str(), &type, &length) != NC_NOERR || type != NC_CHAR) return std::nullopt;
  std::string text(length, '\0');
  check(nc_get_att_text(id_, NC_GLOBAL, name.c_str(), text.data()), "read attribute " + name);
  return text;
}

NetcdfFile::Variable NetcdfReader::find(const std::string& variable) const {
  NetcdfFile::Variable found{0, {}};
  int rank = 0, ids[NC_MAX_VAR_DIMS];
  check(nc_inq_varid(id_, variable.c_str(), &found.id), "find variable " + variable);
  check(nc_inq_varndims(id_, found.id, &rank), "read variable " + variable);
  check(nc_inq_vardimid(id_, found.id, ids), "read variable " + variable);
  for (int d = 0; d < rank; ++d) {
    std::size_t length = 0;
    check(nc_inq_dimlen(id_, ids[d], &length), "read variable " + variable);
    found.dimensions.push_back({ids[d], length});
  }
  return found;
}

std::vector<double> NetcdfReader::read(const std::string& variable) const {
  const NetcdfFile::Variable v = find(variable);
  std::size_t size = 1;
  for (const auto& d : v.dimensions) size *= d.length;
  std::vector<double> values(size);
  check(nc_get_var_double(id_, v.id, values.data()), "read variable " + variable);
  return values;
}

std::string NetcdfReader::text(const std::string& variable) const {
  const NetcdfFile::Variable v = find(variable);
  std::size_t size = 1;
  for (const auto& d : v.dimensions) size *= d.length;
  std::string text(size, '\0');
  check(nc_get_var_text(id_, v.id, text.data()), "read variable " + variable);
  return text;
}

void NetcdfReader::read_run(const std::string& variable, std::size_t first, std::span<double> values) const {
  const NetcdfFile::Variable v = find(variable);
  for_each_block(v.dimensions, first, values.size(),
                 [&](std::size_t done, const std::size_t* start, const std::size_t* count) {
                   check(nc_get_vara_double(id_, v.id, start, count, values.data() + done), "read " + variable);
                 });
}

void NetcdfReader::read_run(const std::string& variable, std::size_t first, std::span<std::int8_t> values) const {
  const NetcdfFile::Variable v = find(variable);
  for_each_block(v.dimensions, first, values.size(),
                 [&](std::size_t done, const std::size_t* start, const std::size_t* count) {
                   check(nc_get_vara_schar(id_, v.id, start, count, values.data() + done), "read " + variable);
                 });
}

void NetcdfReader::read_run(const std::string& variable, std::size_t first, std::span<std::int16_t> values) const {
  const NetcdfFile::Variable v = find(variable);
  for_each_block(v.dimensions, first, values.size(),
                 [&](std::size_t done, const std::size_t* start, const std::size_t* count) {
                   check(nc_get_vara_short(id_, v.id, start, count, values.data() + done), "read " + variable);
                 });
}

void NetcdfReader::check(int status, const std::string& action) const {
  if (status != NC_NOERR) throw NetcdfError(fmt::format("{}: cannot {}: {}", file_, action, nc_strerror(status)));
}

void write_provenance(NetcdfFile& file, const Provenance& provenance) {
  const auto set = [&](const char* name, const std::string& text) {
    if (!text.empty()) file.set_attribute(name, text);
  };
  // A title may come from a file. Study and vehicle are kept to the byte: they can be computed again.
  set("Conventions", "CF-1.8");
  set("title", detail::printable(provenance.title));
  set("source", fmt::format("wingbeat {} {}", provenance.version, provenance.command));
  set("wingbeat_version", provenance.version);
  set("vehicle", provenance.vehicle);
  set("study", provenance.study);
  set("condition", provenance.condition);
  set("method", provenance.method);
  set("domain", provenance.domain);
  if (provenance.tolerance > 0.0) set("tolerance", fmt::format("{}", provenance.tolerance));
}

}  // namespace wingbeat
