// Vehicles in time for Python: equations of motion, and simulations that are stepped. Nothing is computed here.
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "binding.hpp"
#include "wingbeat/files/waveform_file.hpp"
#include "wingbeat/time/simulation.hpp"

namespace wingbeat::python {
namespace {

// ---- equations of motion

/// Derivatives of states in rows, one column or many.
py::array_t<double> rates(const EquationsOfMotion& equations, double time,
                          const py::array_t<double, py::array::c_style | py::array::forcecast>& state,
                          std::optional<double> voltage) {
  const std::size_t rows = equations.state_count();
  if (state.ndim() < 1 || state.ndim() > 2 || std::size_t(state.shape(0)) != rows) {
    throw py::value_error("expected a state of " + std::to_string(rows) + " numbers, or an array with as many rows");
  }
  py::array_t<double> derivatives(std::vector<py::ssize_t>(state.shape(), state.shape() + state.ndim()));
  if (state.ndim() == 1) {
    equations.rates(time, state.data(), derivatives.mutable_data(), voltage);
    return derivatives;
  }
  const auto from = state.unchecked<2>();
  auto to = derivatives.mutable_unchecked<2>();
  listening([&] {
    std::array<double, 5> column, slopes;
    for (py::ssize_t n = 0; n < from.shape(1); ++n) {
      check_cancellation();
      for (std::size_t r = 0; r < rows; ++r) column[r] = from(py::ssize_t(r), n);
      equations.rates(time, column.data(), slopes.data(), voltage);
      for (std::size_t r = 0; r < rows; ++r) to(py::ssize_t(r), n) = slopes[r];
    }
  });
  return derivatives;
}

// ---- simulations

py::list events_of(const std::vector<TransientEvent>& events) {
  py::list found;
  for (const TransientEvent& event : events) {
    found.append(py::make_tuple(event.time, event.crank_angle, name_of(event.kind)));
  }
  return found;
}

/// A simulation that one thread steps at a time, and that its commanding function does not step.
class Stepped {
 public:
  explicit Stepped(Simulation simulation) : simulation_(std::move(simulation)) {}
  Stepped(const Stepped& other) : simulation_(other.idle()) {}

  const Simulation& idle() const {
    if (busy_) throw std::runtime_error("the simulation is being stepped");
    return simulation_;
  }
  Simulation& idle() { return const_cast<Simulation&>(std::as_const(*this).idle()); }

  std::vector<TransientEvent> step_to(double until, const std::optional<std::string>& event) {
    Simulation& simulation = idle();
    StepOptions options;
    if (event) options.until_event = event_kind(*event);
    const Busy stepping(busy_);
    return listening([&] { return simulation.step_to(until, options); });
  }

  /// Steps to each of the times: what acts there, absent behind a jam, and the events on the way. Where that ends
  /// early, the simulation stands where it began.
  std::vector<WaveformRow> record(const std::vector<double>& times, std::vector<TransientEvent>& events) {
    Simulation& simulation = idle();
    double last = simulation.time();
    for (const double time : times) {
      if (!(time >= last) || !std::isfinite(time)) {
        throw InputError("", 0, 0, "times", "must not fall, nor begin in the past, and must be finite");
      }
      last = time;
    }
    const SimulationState before = simulation.save();
    const Busy stepping(busy_);
    std::vector<WaveformRow> rows;
    rows.reserve(times.size());
    try {
      listening([&] {
        for (const double time : times) {
          check_cancellation();
          if (!simulation.ended()) {
            for (const TransientEvent& event : simulation.step_to(time)) events.push_back(event);
          }
          rows.push_back(simulation.now());
          if (rows.back().time >= time) continue;
          for (const WaveformColumn& column : waveform_columns()) rows.back().*column.value = absent;
          rows.back().time = time;
        }
      });
    } catch (...) {
      simulation.restore(before);
      throw;
    }
    return rows;
  }

  void command(const py::object& voltage) {
    if (voltage.is_none()) return idle().release();
    if (!PyCallable_Check(voltage.ptr())) return idle().command(voltage.cast<double>());
    idle().command([voltage](double time) {
      const Entered own;
      return voltage(time).cast<double>();
    });
  }

 private:
  struct Busy {
    explicit Busy(bool& flag) : flag(flag) { flag = true; }
    ~Busy() { flag = false; }
    bool& flag;
  };

  static TransientEvent::Kind event_kind(const std::string& name) {
    using Kind = TransientEvent::Kind;
    std::string names;
    for (const Kind kind : {Kind::revolution, Kind::force_sign_change, Kind::standstill, Kind::breakaway,
                            Kind::supply_switch, Kind::stop_impact, Kind::jam}) {
      if (name == name_of(kind)) return kind;
      names += (names.empty() ? "" : kind == Kind::jam ? " or " : ", ") + std::string(name_of(kind));
    }
    throw InputError("", 0, 0, "until", "must be " + names + ", got " + in_quotes(name));
  }

  Simulation simulation_;
  bool busy_ = false;
};

Stepped simulation_of(const Design<double>& design, const std::string& condition, double tolerance, double angle,
                      double speed, double current, double pitch_angle, double pitch_velocity) {
  const SimulationOptions options{tolerance, angle, speed, current, pitch_angle, pitch_velocity};
  return Stepped(simulation(design, options, choice<Condition>("condition", condition)));
}

/// What acts at each of the times, as columns, and the events on the way.
py::tuple recorded(Stepped& stepped, const std::vector<double>& times) {
  std::vector<TransientEvent> events;
  const py::list columns = columns_of(stepped.record(times, events));
  return py::make_tuple(columns, events_of(events));
}

py::list acting(const Stepped& stepped) {
  const WaveformRow row = stepped.idle().now();
  py::list numbers;
  for (const WaveformColumn& column : waveform_columns()) numbers.append(row.*column.value);
  return numbers;
}

}  // namespace

void add_motion(py::module_& m) {
  using namespace py::literals;
  py::class_<EquationsOfMotion>(m, "EquationsOfMotion")
      .def(py::init([](const Design<double>& design, const std::string& condition) {
        return EquationsOfMotion(design, choice<Condition>("condition", condition));
      }))
      .def("state_names", &EquationsOfMotion::state_names)
      .def("rates", &rates);
  py::class_<Stepped>(m, "Simulation")
      .def(py::init(&simulation_of), "design"_a, "condition"_a, "tolerance"_a, "angle"_a, "speed"_a, "current"_a,
           "pitch_angle"_a, "pitch_velocity"_a)
      .def("copy", [](const Stepped& stepped) { return Stepped(stepped); })
      .def("time", [](const Stepped& stepped) { return stepped.idle().time(); })
      .def("state", [](const Stepped& stepped) { return array_of(stepped.idle().state()); })
      .def("state_names", [](const Stepped& stepped) { return stepped.idle().state_names(); })
      .def("acting", &acting)
      .def("stands", [](const Stepped& stepped) { return stepped.idle().stands(); })
      .def("ended", [](const Stepped& stepped) { return stepped.idle().ended(); })
      .def("command", &Stepped::command, "voltage"_a.none(true))
      .def("command_samples",
           [](Stepped& stepped, std::vector<double> times, std::vector<double> voltages) {
             stepped.idle().command(std::move(times), std::move(voltages));
           })
      .def("step_to", [](Stepped& stepped, double until,
                         const std::optional<std::string>& event) { return events_of(stepped.step_to(until, event)); })
      .def("record", &recorded)
      .def("save", [](const Stepped& stepped) { return py::tuple(py::cast(stepped.idle().save().numbers)); })
      .def("restore",
           [](Stepped& stepped, std::vector<double> numbers) { stepped.idle().restore({std::move(numbers)}); });
}

}  // namespace wingbeat::python
