// NetCDF-4 files, written and read through the C API: dimensions, variables with units, text attributes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace wingbeat {

/// A NetCDF call that failed. what() is one sentence naming file, action and reason.
class NetcdfError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Lets HDF5 print no errors on this thread. It keeps what it prints for each thread, and netCDF, which asks it much
/// that may fail, silences it on the first thread that uses netCDF alone.
void silence_hdf5();

/// A new NetCDF-4 file. Text goes into attributes as characters, never as NC_STRING, which Octave cannot read.
/// Every member throws NetcdfError.
class NetcdfFile {
 public:
  struct Dimension {
    int id;
    std::size_t length;
  };
  struct Variable {
    int id;
    std::vector<Dimension> dimensions;
  };

  /// Where a file is made: in memory, to be stored as a whole by close(), or, of one that may not fit there, on the
  /// disk, which must have room for it (HDF5 does not survive a full one).
  enum class Place { memory, disk };

  /// Creates the file, replacing an existing one.
  explicit NetcdfFile(const std::filesystem::path& file, Place place = Place::memory);
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;
  /// Closes without a word, in memory without storing anything; call close() to have everything written. On the disk
  /// nothing is closed after an error: HDF5 does not survive the second meeting with a full disk.
  ~NetcdfFile();

  Dimension define_dimension(const std::string& name, std::size_t length);
  /// Doubles over the dimensions, slowest first; none makes a scalar. `unit` as UDUNITS writes it, "1" without one.
  /// Absent values are written as NaN, which is also what unwritten ones read as.
  Variable define_variable(const std::string& name, const std::vector<Dimension>& dimensions, const std::string& unit,
                           const std::string& long_name);
  /// Doubles, whole numbers or small whole numbers (of one byte: flag; of two: masks) of which every value will be
  /// written: nothing is filled in beforehand, and what is not written is undefined.
  enum class Storage { real, whole, flag, masks };
  Variable define_dense(const std::string& name, const std::vector<Dimension>& dimensions, const std::string& unit,
                        const std::string& long_name, Storage storage = Storage::real);
  /// One text for each place along a dimension, as characters that xarray reads as strings.
  Variable define_texts(const std::string& name, Dimension dimension, std::span<const std::string> texts,
                        const std::string& long_name);
  void set_attribute(const std::string& name, std::string_view text);
  void set_attribute(const Variable& variable, const std::string& name, std::string_view text);

  /// Names the key of the vehicle file that a variable holds, in its attribute wingbeat_key.
  void set_key(const Variable& variable, std::string_view key) { set_attribute(variable, "wingbeat_key", key); }
  /// What the values of a flag mean, in the manner of the CF conventions: 0, 1, 2, ...
  void set_flags(const Variable& variable, std::span<const std::string> meanings);
  /// What the bits of a variable of masks mean, the lowest first (at most 15): flag_masks 1, 2, 4, ...
  void set_flag_masks(const Variable& variable, std::span<const std::string> meanings);

  /// The whole variable, last dimension fastest.
  void write(const Variable& variable, std::span<const double> values);
  /// The block at `start` of extent `count`, both one entry per dimension.
  void write(const Variable& variable, std::span<const std::size_t> start, std::span<const std::size_t> count,
             std::span<const double> values);
  /// Values that follow each other in the order of the file, from the value `first` on: any part of a variable.
  void write_run(const Variable& variable, std::size_t first, std::span<const double> values);
  void write_run(const Variable& variable, std::size_t first, std::span<const std::int8_t> values);
  void write_run(const Variable& variable, std::size_t first, std::span<const std::int16_t> values);

  void close();

 private:
  void check(int status, const std::string& action) const;

  std::string file_;
  Place place_;
  int id_ = -1;
  mutable bool failed_ = false;
};

/// A NetCDF file open for reading. Every member throws NetcdfError.
class NetcdfReader {
 public:
  explicit NetcdfReader(const std::filesystem::path& file);
  NetcdfReader(const NetcdfReader&) = delete;
  NetcdfReader& operator=(const NetcdfReader&) = delete;
  ~NetcdfReader();

  bool has(const std::string& variable) const;
  /// A global text attribute, or nothing.
  std::optional<std::string> attribute(const std::string& name) const;
  /// The whole variable, last dimension fastest.
  std::vector<double> read(const std::string& variable) const;
  /// All characters of a variable of characters.
  std::string text(const std::string& variable) const;
  /// Values that follow each other in the order of the file, from the value `first` on.
  void read_run(const std::string& variable, std::size_t first, std::span<double> values) const;
  void read_run(const std::string& variable, std::size_t first, std::span<std::int8_t> values) const;
  void read_run(const std::string& variable, std::size_t first, std::span<std::int16_t> values) const;

 private:
  void check(int status, const std::string& action) const;
  NetcdfFile::Variable find(const std::string& variable) const;

  std::string file_;
  int id_ = -1;
};

/// What makes a data set one that can be run again: the global attributes of every file the program writes. What is
/// empty, or a tolerance of 0, does not apply and is left out.
struct Provenance {
  std::string title;
  std::string command;         ///< of the program, as "sweep"
  std::string version;         ///< of the program
  std::string vehicle;         ///< the vehicle file, complete in itself
  std::string study = {};      ///< the study file
  std::string condition = {};  ///< air, vacuum, wingless
  std::string method = {};     ///< orbit, transient; of a Pareto study its algorithm
  std::string domain = {};     ///< "inside" or the limits of the model that are exceeded; empty: not said
  double tolerance = 0.0;
};

/// Conventions, title, source, wingbeat_version, vehicle and, where they apply, study, condition, method, tolerance.
void write_provenance(NetcdfFile& file, const Provenance& provenance);

}  // namespace wingbeat
