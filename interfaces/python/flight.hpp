// What the bindings of flight share: vehicles that fly, and their states as arrays.
#pragma once

#include <cstddef>

#include "binding.hpp"
#include "wingbeat/flight/flight_vehicle.hpp"
#include "wingbeat/flight/simulation.hpp"

namespace wingbeat::python {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

inline constexpr std::size_t drive_state_count = 9;

/// Numbers of what `each` of T names, in that order, from and to.
template <class T>
void numbers_of(const T& from, double* to) {
  T::each(from, [&](const double& x) { *to++ = x; });
}
template <class T>
T from_numbers(const double* numbers) {
  T made;
  T::each(made, [&](double& x) { x = *numbers++; });
  return made;
}

/// Drives in rows.
inline py::array_t<double> rows_of(const std::vector<Coordinates<double>>& drives) {
  py::array_t<double> rows({drives.size(), drive_state_count});
  for (std::size_t n = 0; n < drives.size(); ++n) numbers_of(drives[n], rows.mutable_data(py::ssize_t(n), 0));
  return rows;
}

/// Adds many flights that are stepped at once.
void add_flight_batch(py::module_& m);

}  // namespace wingbeat::python
