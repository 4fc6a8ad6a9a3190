// Vehicles that fly, for Python: flights that are stepped, trim and stability. Nothing is computed here.
#include "flight.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "wingbeat/flight/stability.hpp"
#include "wingbeat/flight/trim.hpp"
#include "wingbeat/report/flight_report.hpp"

namespace wingbeat::python {
namespace {

template <class T>
py::array_t<double> as_array(const T& from, std::size_t count) {
  py::array_t<double> numbers{py::ssize_t(count)};
  numbers_of(from, numbers.mutable_data());
  return numbers;
}

/// A body from 13 numbers: velocity, rates, attitude, position.
BodyState body_from(const Numbers& numbers) {
  if (numbers.size() != py::ssize_t(body_state_count)) throw py::value_error("expected 13 numbers of a body");
  return from_numbers<BodyState>(numbers.data());
}

std::vector<Coordinates<double>> drives_from(const Numbers& rows) {
  std::vector<Coordinates<double>> drives;
  for (py::ssize_t n = 0; n < rows.shape(0); ++n) drives.push_back(from_numbers<Coordinates<double>>(rows.data(n, 0)));
  return drives;
}

// ---- a flight

/// A flight that one thread steps at a time, and that its wind does not step.
class Flown {
 public:
  Flown(const Design<double>& design, double tolerance, double gravity, bool frozen)
      : flight_(flight_vehicle(design), {tolerance, gravity, frozen, {}}) {}
  Flown(const Flown& other) : flight_(other.idle()) {}

  const FlightSimulation& idle() const {
    if (busy_) throw std::runtime_error("the flight is being stepped");
    return flight_;
  }
  FlightSimulation& idle() { return const_cast<FlightSimulation&>(std::as_const(*this).idle()); }

  /// Where that ends early, the flight stands where the call began.
  bool step_to(double until) {
    FlightSimulation& flight = idle();
    const FlightSimulation before = flight;
    busy_ = true;
    try {
      const bool goes_on = listening([&] { return flight.step_to(until); });
      busy_ = false;
      return goes_on;
    } catch (...) {
      busy_ = false;
      flight = before;
      throw;
    }
  }

  void blow(const py::object& wind) {
    if (wind.is_none()) return idle().blow({});
    if (!PyCallable_Check(wind.ptr())) {
      const Triple steady = wind.cast<Triple>();
      return idle().blow([steady](double, const Triple&) { return steady; });
    }
    idle().blow([wind](double time, const Triple& position) {
      const Entered own;
      return wind(time, position).cast<Triple>();
    });
  }

  void command(const std::array<double, flight_control_count>& settings) { idle().command({settings}); }

 private:
  FlightSimulation flight_;
  bool busy_ = false;
};

// ---- the vehicle

py::list mounts_of(const FlightVehicle& vehicle, const Planform<double>& planform) {
  const double length = length_of(planform) + hub_offset_of(planform),
               chord = wing_area(planform) / length_of(planform);
  py::list wings;
  for (const FlightDrive& drive : vehicle.drives) {
    for (std::size_t n = 0; n < drive.flow.count; ++n) {
      const WingMount& mount = drive.flow.mounts[n];
      py::dict wing;
      wing["side"] = mount.side;
      wing["sense"] = mount.sense;
      wing["shoulder"] = mount.shoulder;
      wing["tilt"] = mount.tilt;
      wing["mean_angle"] = mount.mean_angle;
      wing["length"] = length;
      wing["chord"] = chord;
      wings.append(wing);
    }
  }
  return wings;
}

py::dict described_vehicle(const Design<double>& design) {
  const FlightVehicle vehicle = flight_vehicle(design);
  py::dict result;
  result["name"] = vehicle.name;
  result["mass"] = vehicle.body.mass;
  result["inertia"] = std::array{vehicle.body.inertia_roll, vehicle.body.inertia_pitch, vehicle.body.inertia_yaw,
                                 vehicle.body.inertia_product};
  py::list plates, controls;
  for (const Plate& plate : vehicle.body.plates) {
    if (plate.area > 0.0) plates.append(py::make_tuple(plate.place, plate.normal, plate.area));
  }
  result["plates"] = plates;
  result["wings"] = mounts_of(vehicle, design.wing.planform);
  for (std::size_t k = 0; k < flight_control_count; ++k) {
    if (!vehicle.ranges[k].given()) continue;
    controls.append(py::make_tuple(k, vehicle.ranges[k].low, vehicle.ranges[k].high));
  }
  result["controls"] = controls;
  return result;
}

// ---- trim and stability

constexpr const char* one_of_flights = "flights";

/// What is needed beside the report to start a flight from there.
py::dict with_start(py::dict result, const TrimResult& found) {
  std::vector<Coordinates<double>> drives;
  if (found.flight) {
    for (const DriveCycle& cycle : found.flight->cycles) drives.push_back(cycle.start);
  }
  result["controls"] = found.controls.at;
  result["body"] = as_array(steady_body(found.condition, found.roll, found.pitch), body_state_count);
  result["drives"] = rows_of(drives);
  return result;
}

py::dict trim_of(const Design<double>& design, double speed, double climb, double turn_rate) {
  const FlightVehicle vehicle = flight_vehicle(design);
  const TrimResult found = listening([&] {
    AveragedFlight flight(vehicle);
    return trim(flight, {speed, climb, turn_rate});
  });
  const TrimReport report{
      vehicle.name, {found}, has_battery(design.supply.type) ? usable_energy(design.supply.battery) : absent};
  const detail::Json whole = detail::Json::parse(json_trim(report));
  return with_start(reported(whole.at(one_of_flights).at(0), text_trim(vehicle, report)), found);
}

py::dict stability_of(const Design<double>& design, double speed, double climb, double turn_rate, bool sensitivities) {
  const FlightVehicle vehicle = flight_vehicle(design);
  StabilityReport report{vehicle.name, {}, {}};
  const FlightCondition condition{speed, climb, turn_rate};
  listening([&] {
    AveragedFlight flight(vehicle);
    const TrimResult steady = trim(flight, condition);
    if (!steady.flies()) {
      report.result.trim = steady;
      return 0;
    }
    report.result = flight_stability(flight, steady);
    if (sensitivities) report.sensitivities = mode_sensitivities(design, condition);
    return 0;
  });
  const detail::Json values = detail::Json::parse(json_stability(report));
  return with_start(reported(values, text_stability(report)), report.result.trim);
}

py::tuple controls_of_flights() {
  py::list rows;
  for (std::size_t k = 0; k < flight_control_count; ++k) {
    rows.append(py::make_tuple(name_of(FlightControl(k)), flight_control_units[k]));
  }
  return py::tuple(rows);
}

py::array_t<double> as_array(const BodyLoads& loads) {
  py::array_t<double> numbers(6);
  std::copy(loads.force.begin(), loads.force.end(), numbers.mutable_data());
  std::copy(loads.moment.begin(), loads.moment.end(), numbers.mutable_data() + 3);
  return numbers;
}

}  // namespace

void add_flight(py::module_& m) {
  using namespace py::literals;
  py::class_<Flown>(m, "FlightSimulation")
      .def(py::init<const Design<double>&, double, double, bool>(), "design"_a, "tolerance"_a, "gravity"_a, "frozen"_a)
      .def("copy", [](const Flown& flown) { return Flown(flown); })
      .def("start", [](Flown& flown, const Numbers& body,
                       const Numbers& drives) { flown.idle().start(body_from(body), drives_from(drives)); })
      .def("place", [](Flown& flown, const Numbers& body) { flown.idle().place(body_from(body)); })
      .def("command", &Flown::command)
      .def("controls", [](const Flown& flown) { return flown.idle().controls().at; })
      .def("blow", &Flown::blow, "wind"_a.none(true))
      .def("step_to", &Flown::step_to)
      .def("time", [](const Flown& flown) { return flown.idle().time(); })
      .def("body", [](const Flown& flown) { return as_array(flown.idle().state().body, body_state_count); })
      .def("drives", [](const Flown& flown) { return rows_of(flown.idle().state().drives); })
      .def("totals", [](const Flown& flown) { return as_array(flown.idle().totals(), flight_total_count); })
      .def("stops", [](const Flown& flown) { return flown.idle().totals().stops; })
      .def("loads", [](const Flown& flown) { return as_array(flown.idle().loads()); })
      .def("stored_energy", [](const Flown& flown) { return flown.idle().stored_energy(); })
      .def("cycle_time", [](const Flown& flown) { return flown.idle().cycle_time(); });
  m.def("flight_vehicle", &described_vehicle);
  m.def("flight_controls", &controls_of_flights);
  m.def("euler_angles", [](const std::array<double, 4>& attitude) { return euler_angles(attitude); });
  m.def("attitude_of", [](const Triple& angles) { return attitude_of(angles); });
  m.def("trim", &trim_of);
  m.def("flight_stability", &stability_of);
  add_flight_batch(m);
}

}  // namespace wingbeat::python
