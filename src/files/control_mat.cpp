// Control models as a MAT-file of version 5, by libmatio.
#include <fmt/format.h>
#include <matio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "wingbeat/files/control_file.hpp"

namespace wingbeat {
namespace {

struct FreeVariable {
  void operator()(matvar_t* v) const { Mat_VarFree(v); }
};
using MatVariable = std::unique_ptr<matvar_t, FreeVariable>;

MatVariable made(matvar_t* variable) {
  if (!variable) throw std::runtime_error("cannot make a variable of a MAT-file: out of memory");
  return MatVariable(variable);
}

MatVariable real_array(const char* name, const double* values, std::vector<std::size_t> sizes) {
  return made(Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, int(sizes.size()), sizes.data(),
                            const_cast<double*>(values), 0));  // libmatio copies what it takes for mutable
}
MatVariable matrix(const char* name, const Eigen::MatrixXd& m) {
  return real_array(name, m.data(), {std::size_t(m.rows()), std::size_t(m.cols())});
}
MatVariable row(const char* name, const std::vector<double>& values) {
  return real_array(name, values.data(), {1, values.size()});
}
MatVariable text(const char* name, const std::string& content) {
  std::array<std::size_t, 2> sizes = {1, content.size()};
  return made(Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UTF8, 2, sizes.data(), const_cast<char*>(content.data()), 0));
}
MatVariable cell_of_texts(const char* name, const std::vector<std::string>& texts) {
  std::array<std::size_t, 2> sizes = {1, texts.size()};
  std::vector<matvar_t*> cells;
  for (const std::string& content : texts) cells.push_back(text(nullptr, content).release());
  return made(Mat_VarCreate(name, MAT_C_CELL, MAT_T_CELL, 2, sizes.data(), static_cast<void*>(cells.data()), 0));
}
MatVariable structure_of(const AllocationMap& map) {
  std::vector<const char*> fields = {"input"};
  for (const AllocationColumn& c : allocation_columns) fields.push_back(c.name);
  for (const AllocationSlope& s : allocation_slopes) fields.push_back(s.name);
  std::array<std::size_t, 2> sizes = {1, 1};
  MatVariable structure = made(Mat_VarCreateStruct((std::string("map_") + name_of(map.input)).c_str(), 2, sizes.data(),
                                                   fields.data(), unsigned(fields.size())));
  const auto put = [&](const char* field, MatVariable value) {
    Mat_VarSetStructFieldByName(structure.get(), field, 0, value.release());
  };
  const auto column = [&](double AllocationPoint::* member) {
    std::vector<double> values;
    for (const AllocationPoint& p : map.points) values.push_back(p.*member);
    return row(nullptr, values);
  };
  put("input", column(&AllocationPoint::input));
  for (const AllocationColumn& c : allocation_columns) put(c.name, column(c.member));
  for (const AllocationSlope& s : allocation_slopes) {
    std::vector<double> slope;
    for (const AllocationColumn& c : allocation_columns) slope.push_back((map.*s.member).*c.member);
    put(s.name, row(nullptr, slope));
  }
  return structure;
}

struct CloseMat {
  void operator()(mat_t* file) const { Mat_Close(file); }
};

/// True if both hold the same values, cells and fields.
bool are_equal(const matvar_t* a, const matvar_t* b) {
  if (!a || !b) return a == b;
  if (a->class_type != b->class_type || a->rank != b->rank || a->nbytes != b->nbytes ||
      !std::equal(a->dims, a->dims + a->rank, b->dims)) {
    return false;
  }
  if (a->nbytes == 0) return true;
  if (!a->data || !b->data) return false;
  if (a->class_type != MAT_C_CELL && a->class_type != MAT_C_STRUCT) {
    return std::memcmp(a->data, b->data, a->nbytes) == 0;
  }
  const auto parts = [](const matvar_t* variable) {
    return std::span(static_cast<matvar_t* const*>(variable->data), variable->nbytes / sizeof(matvar_t*));
  };
  return std::equal(parts(a).begin(), parts(a).end(), parts(b).begin(), are_equal);
}

/// libmatio does not look at what its writes come to: what was written is read again.
class MatFile {
 public:
  MatFile(const std::filesystem::path& path, const std::string& header)
      : path_(path.string()), file_(Mat_CreateVer(path_.c_str(), header.c_str(), MAT_FT_MAT5)) {
    if (!file_) fail();
  }
  void write(MatVariable variable) {
    errno = 0;
    if (Mat_VarWrite(file_.get(), variable.get(), MAT_COMPRESSION_NONE) != 0) fail();
    if (errno != 0) reason_ = errno;
    written_.push_back(std::move(variable));
  }
  void close() {
    errno = 0;
    const bool closed = Mat_Close(file_.release()) == 0;
    if (errno != 0) reason_ = errno;
    if (!closed) fail();
    file_.reset(Mat_Open(path_.c_str(), MAT_ACC_RDONLY));
    if (!file_) fail();
    for (const MatVariable& variable : written_) {
      const MatVariable there(Mat_VarReadNext(file_.get()));
      if (!there || !are_equal(variable.get(), there.get())) fail();
    }
    file_.reset();
  }

 private:
  [[noreturn]] void fail() const {
    throw std::runtime_error(path_ + ": the MAT-file cannot be written" +
                             (reason_ != 0 ? std::string(": ") + std::strerror(reason_) : ""));
  }
  std::string path_;
  std::unique_ptr<mat_t, CloseMat> file_;
  std::vector<MatVariable> written_;
  int reason_ = 0;
};

void write_signals(MatFile& file, const std::string& kind, const std::vector<CycleSignal>& signals) {
  std::vector<std::string> names, units;
  std::vector<double> values;
  for (const CycleSignal& s : signals) names.push_back(s.name), units.push_back(s.unit), values.push_back(s.value);
  file.write(cell_of_texts((kind + "_names").c_str(), names));
  file.write(cell_of_texts((kind + "_units").c_str(), units));
  file.write(row((kind + "_values").c_str(), values));
}

}  // namespace

void write_control_mat(const ControlModels& models, const std::string& version, const std::filesystem::path& file) {
  const LinearModel& model = *models.linear.model;
  MatFile mat(file, fmt::format("MATLAB 5.0 MAT-file, Written by wingbeat {} linearise", version));
  mat.write(matrix("A", model.map.a));
  mat.write(matrix("B", model.map.b));
  mat.write(matrix("C", model.map.c));
  mat.write(matrix("D", model.map.d));
  mat.write(row("dt", {model.map.period}));
  write_signals(mat, "state", model.map.states);
  write_signals(mat, "input", model.map.inputs);
  write_signals(mat, "output", model.map.outputs);
  mat.write(matrix("steady_gain", model.steady_gain));
  mat.write(matrix("Ac", model.continuous.a));
  mat.write(matrix("Bc", model.continuous.b));
  mat.write(matrix("Cc", model.continuous.c));
  mat.write(matrix("Dc", model.continuous.d));
  write_signals(mat, "continuous_state", model.continuous.states);
  std::vector<double> re, im, time_constants;
  for (const CycleMode& mode : model.modes) {
    re.push_back(mode.multiplier.real()), im.push_back(mode.multiplier.imag());
    time_constants.push_back(mode.time_constant);
  }
  mat.write(row("multipliers_real", re));
  mat.write(row("multipliers_imaginary", im));
  mat.write(row("time_constants", time_constants));
  std::vector<double> steps;
  for (const Eigen::MatrixXd& response : model.step_responses) {
    steps.insert(steps.end(), response.data(), response.data() + response.size());
  }
  mat.write(real_array(
      "step_responses", steps.data(),
      {std::size_t(model.step_responses.front().rows()), model.map.outputs.size(), model.step_responses.size()}));
  if (models.body) {
    mat.write(matrix("body_derivatives", *models.body));
    mat.write(cell_of_texts("body_loads", {body_loads.begin(), body_loads.end()}));
    mat.write(cell_of_texts("body_motions", {body_motions.begin(), body_motions.end()}));
  }
  for (const AllocationMap& map : models.maps) mat.write(structure_of(map));
  mat.close();
}

void write_flight_mat(const StabilityResult& flight, const std::string& version, const std::filesystem::path& file) {
  const FlightLinearModel& model = *flight.model;
  const Eigen::Index states = model.A.rows();
  Eigen::MatrixXd inputs(states, model.B.cols() + model.W.cols());
  inputs << model.B, model.W;
  MatFile mat(file, fmt::format("MATLAB 5.0 MAT-file, Written by wingbeat {} stability", version));
  mat.write(matrix("A", model.A));
  mat.write(matrix("B", inputs));
  mat.write(matrix("C", Eigen::MatrixXd::Identity(states, states)));
  mat.write(matrix("D", Eigen::MatrixXd::Zero(states, inputs.cols())));
  // Units of states and winds are a part of their names.
  const TrimResult& trim = flight.trim;
  const FlightVector trimmed = steady_states(trim);
  std::vector<std::string> state_names(flight_state_names.begin(), flight_state_names.end()), input_names;
  std::vector<double> values(trimmed.begin(), trimmed.end()), input_values;
  for (const FlightControl control : model.controls) {
    input_names.push_back(std::string(name_of(control)) + flight_control_suffix(control));
    input_values.push_back(trim.controls[control]);
  }
  input_names.insert(input_names.end(), wind_input_names.begin(), wind_input_names.end());
  input_values.resize(input_names.size(), 0.0);
  mat.write(cell_of_texts("state_names", state_names));
  mat.write(row("state_values", values));
  mat.write(cell_of_texts("input_names", input_names));
  mat.write(row("input_values", input_values));
  mat.close();
}

}  // namespace wingbeat
