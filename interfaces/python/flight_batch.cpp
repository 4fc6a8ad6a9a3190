// Many flights of one vehicle that are stepped at once, on threads: for learning.
#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "flight.hpp"

namespace wingbeat::python {
namespace {

/// How a step ended.
enum class Ended : std::uint8_t { goes_on, jammed, failed };

class FlightBatch {
 public:
  FlightBatch(const Design<double>& design, std::size_t count, double tolerance, double gravity, int threads)
      : flights_(count, FlightSimulation(flight_vehicle(design), {tolerance, gravity, false, {}})),
        winds_(count),
        threads_(threads) {
    for (std::size_t n = 0; n < count; ++n) {
      flights_[n].blow([this, n](double, const Triple&) { return winds_[n]; });
    }
  }
  FlightBatch(const FlightBatch&) = delete;
  FlightBatch& operator=(const FlightBatch&) = delete;

  /// Starts these flights at time 0, each from 13 numbers of its body and with the drives given.
  void start(const std::vector<std::size_t>& which, const Numbers& bodies, const Numbers& drives) {
    check_shape("bodies", bodies, which.size(), body_state_count);
    std::vector<Coordinates<double>> from;
    for (py::ssize_t d = 0; d < drives.shape(0); ++d)
      from.push_back(from_numbers<Coordinates<double>>(drives.data(d, 0)));
    for (std::size_t k = 0; k < which.size(); ++k) {
      winds_.at(which[k]) = {};
      flights_.at(which[k]).start(from_numbers<BodyState>(bodies.data(py::ssize_t(k), 0)), from);
    }
  }

  /// Steps those that are `active` by that time [s] under their controls, in a wind [m/s] each; how each step ended.
  py::array_t<std::uint8_t> step(double duration, const Numbers& controls, const Numbers& winds,
                                 const std::vector<bool>& active) {
    check_shape("controls", controls, flights_.size(), flight_control_count);
    check_shape("winds", winds, flights_.size(), 3);
    if (active.size() != flights_.size()) throw py::value_error("active: expected one for each flight");
    if (busy_) throw std::runtime_error("the flights are being stepped");
    py::array_t<std::uint8_t> ended{py::ssize_t(flights_.size())};
    std::uint8_t* const ends = ended.mutable_data();
    const double *const u = controls.data(), *const w = winds.data();
    const auto step_one = [&](std::size_t n) {
      ends[n] = std::uint8_t(Ended::goes_on);
      if (!active[n]) return;
      FlightControls commanded;
      std::copy_n(u + n * flight_control_count, flight_control_count, commanded.at.begin());
      std::copy_n(w + 3 * n, 3, winds_[n].begin());
      ends[n] = std::uint8_t(step_of(flights_[n], duration, commanded));
    };
    busy_ = true;
    try {
      run(step_one);
    } catch (...) {
      busy_ = false;
      throw;
    }
    busy_ = false;
    return ended;
  }

  py::array_t<double> bodies() const {
    return rows(body_state_count,
                [](const FlightSimulation& flight, double* to) { numbers_of(flight.state().body, to); });
  }
  py::array_t<double> totals() const {
    return rows(flight_total_count,
                [](const FlightSimulation& flight, double* to) { numbers_of(flight.totals(), to); });
  }
  py::array_t<double> times() const {
    py::array_t<double> all{py::ssize_t(flights_.size())};
    for (std::size_t n = 0; n < flights_.size(); ++n) all.mutable_data()[n] = flights_[n].time();
    return all;
  }

 private:
  static Ended step_of(FlightSimulation& flight, double duration, const FlightControls& controls) {
    flight.command(controls);
    try {
      return flight.step_to(flight.time() + duration) ? Ended::goes_on : Ended::jammed;
    } catch (const std::runtime_error&) {
      return Ended::failed;
    }
  }

  template <class Step>
  void run(const Step& step_one) {
    if (threads_ == 1 || flights_.size() == 1) {
      listening([&] {
        for (std::size_t n = 0; n < flights_.size(); ++n) step_one(n);
      });
    } else {
      watched(py::none(), [&](Watch&) {
        for_each_in_parallel(flights_.size(), step_one, threads_);
        return 0;
      });
    }
  }

  template <class Write>
  py::array_t<double> rows(std::size_t width, const Write& write) const {
    if (busy_) throw std::runtime_error("the flights are being stepped");
    py::array_t<double> all({flights_.size(), width});
    for (std::size_t n = 0; n < flights_.size(); ++n) write(flights_[n], all.mutable_data(py::ssize_t(n), 0));
    return all;
  }

  static void check_shape(const char* name, const Numbers& numbers, std::size_t count, std::size_t width) {
    if (numbers.ndim() == 2 && std::size_t(numbers.shape(0)) == count && std::size_t(numbers.shape(1)) == width) return;
    throw py::value_error(std::string(name) + ": expected an array of " + std::to_string(count) + " by " +
                          std::to_string(width));
  }

  std::vector<FlightSimulation> flights_;
  std::vector<Triple> winds_;
  int threads_;
  bool busy_ = false;
};

}  // namespace

void add_flight_batch(py::module_& m) {
  using namespace py::literals;
  py::class_<FlightBatch>(m, "FlightBatch")
      .def(py::init<const Design<double>&, std::size_t, double, double, int>(), "design"_a, "count"_a, "tolerance"_a,
           "gravity"_a, "threads"_a)
      .def("start", &FlightBatch::start)
      .def("step", &FlightBatch::step)
      .def("bodies", &FlightBatch::bodies)
      .def("totals", &FlightBatch::totals)
      .def("times", &FlightBatch::times);
}

}  // namespace wingbeat::python
