// Calls of the functions of FMI 2 and FMI 3 in any order, with any numbers, in the order of the bytes of the input: the
// first says which version, vehicle and kind of instance, each further one a call, whose arguments follow it.
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "fmu/binary/fmi2_functions.h"
#include "fmu/binary/fmi3_functions.h"
#include "fmu/package.hpp"
#include "fmu/variables.hpp"
#include "vehicle/hinged_design.hpp"

using namespace wingbeat;

namespace {

struct Exported {
  std::string folder, token;
  std::vector<unsigned> references;
};

Exported exported(Design<double> design, int number) {
  const auto folder = std::filesystem::temp_directory_path() /
                      ("wingbeat-fuzz-fmu-" + std::to_string(number) + "-" + std::to_string(std::rand()));
  std::filesystem::create_directories(folder);
  const std::string resource = fmu::resource_of(design);
  std::ofstream(folder / fmu::vehicle_resource, std::ios::binary) << resource;
  Exported exported{folder.string(), fmu::token_of(resource), {}};
  for (const fmu::Variable& v : fmu::variables_of(design)) exported.references.push_back(unsigned(v.reference()));
  return exported;
}

/// A crank, on a switched supply too, with wings on hinges and stops, two of them; a direct drive, with friction that
/// holds it, with wings on hinges and stops, two of them.
const std::vector<Exported>& vehicles() {
  struct All {
    std::vector<Exported> list;
    ~All() {
      for (const Exported& exported : list) std::filesystem::remove_all(exported.folder);
    }
  };
  static const All all{[] {
    Design<double> crank = reference_design(), pwm = crank, two_cranks = crank, direct = direct_design(),
                   sticking = direct, stopped = hinged_design(1e-3), two = stopped,
                   hinged_crank = on_hinges(crank, 1e-3);
    pwm.supply = {SupplyType::pwm, 4.0, 2e3, 0.75};
    pwm.motor.constants.friction_torque = 2e-4;
    two_cranks.motors = two.motors = 2.0;
    sticking.friction = {FrictionLaw::constant, 1e-4};
    sticking.motor.constants.armature_inductance = 0.0;
    stopped.pitch.stop = hinged_crank.pitch.stop = 0.4;
    std::vector<Exported> list;
    for (const auto& design : {crank, pwm, two_cranks, direct, sticking, stopped, two, hinged_crank}) {
      list.push_back(exported(design, int(list.size())));
    }
    return list;
  }()};
  return all.list;
}

/// The input, byte by byte; zeros behind its end.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  bool empty() const { return at_ >= size_; }
  unsigned byte() { return at_ < size_ ? data_[at_++] : 0u; }
  double number() {
    using limits = std::numeric_limits<double>;
    static constexpr double some[] = {0.0,
                                      1.0,
                                      -1.0,
                                      1e-3,
                                      1e-2,
                                      0.05,
                                      0.3,
                                      3.0,
                                      22.0,
                                      1e-5,
                                      1e-7,
                                      1e9,
                                      1e6,
                                      -1e6,
                                      1001.0,
                                      1e300,
                                      -1e300,
                                      2.0,
                                      0.5,
                                      100.0,
                                      1e-300,
                                      -3.0,
                                      1e4,
                                      -1e-3,
                                      limits::infinity(),
                                      -limits::infinity(),
                                      limits::quiet_NaN(),
                                      limits::max(),
                                      limits::denorm_min(),
                                      10.0};
    const unsigned which = byte();
    if (which >= 224) {
      double x = 0.0;
      auto* bytes = reinterpret_cast<unsigned char*>(&x);
      for (std::size_t k = 0; k < sizeof x; ++k) bytes[k] = static_cast<unsigned char>(byte());
      return x;
    }
    return some[which % std::size(some)];
  }
  /// Of seconds that a step or the time moves by: most small.
  double seconds() { return byte() % 4 != 0 ? 1e-4 * (1 + byte() % 200) : number(); }
  std::size_t size() {
    static constexpr std::size_t some[] = {
        0, 1, 2, 7, 8, 9, 17, 40, std::size_t(1) << 63, 1000001, 64, ~std::size_t(0)};
    return some[byte() % std::size(some)];
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
};

constexpr std::size_t room = 64;

/// Values and references of a call; as many as it says fit, or it says more than any call takes.
struct Arguments {
  std::size_t count;
  unsigned references[room];
  double numbers[room];
  const unsigned* refs() const { return null_references ? nullptr : references; }
  double* values() { return null_values ? nullptr : numbers; }
  bool null_references, null_values;

  Arguments(Input& in, const Exported& exported) : references{}, numbers{} {
    const unsigned how = in.byte();
    count = how < 200 ? 1 + how % 4 : in.size();
    null_references = how == 255, null_values = how == 254;
    for (std::size_t k = 0; k < room; ++k) {
      if (k >= 4 && k >= count) break;
      const unsigned which = in.byte();
      references[k] =
          which < 240 ? exported.references[(which * 251u + in.byte()) % exported.references.size()] : which * 997u;
      if (k < 8) numbers[k] = in.number();
    }
  }
};

void quiet2(void*, const char*, fmi2Status, const char*, const char*, ...) {}
void quiet3(void*, fmi3Status, const char*, const char*) {}

/// One instance of one version, by the functions that both have; its own time and saved states.
class Session {
 public:
  Session(bool second, const Exported& exported, bool co_simulation)
      : two_(second), of_(exported), co_simulation_(co_simulation) {
    if (two_) {
      static const fmi2CallbackFunctions callbacks = {quiet2, nullptr, nullptr, nullptr, nullptr};
      instance_ = fmi2Instantiate("one", co_simulation ? fmi2CoSimulation : fmi2ModelExchange, exported.token.c_str(),
                                  ("file://" + exported.folder).c_str(), &callbacks, 0, 1);
    } else if (co_simulation) {
      instance_ = fmi3InstantiateCoSimulation("one", exported.token.c_str(), exported.folder.c_str(), false, true,
                                              false, false, nullptr, 0, nullptr, quiet3, nullptr);
    } else {
      instance_ = fmi3InstantiateModelExchange("one", exported.token.c_str(), exported.folder.c_str(), false, true,
                                               nullptr, quiet3);
    }
    if (!instance_) std::abort();
  }
  Session(const Session&) = delete;
  ~Session() {
    for (void*& state : states_)
      two_ ? (void)fmi2FreeFMUstate(instance_, &state) : (void)fmi3FreeFMUState(instance_, &state);
    two_ ? fmi2FreeInstance(instance_) : fmi3FreeInstance(instance_);
  }

  void call(Input& in, Session& other) {
    const unsigned what = in.byte() % 32;
    void* const c = what == 31 && in.byte() == 0 ? nullptr : instance_;
    switch (what) {
      case 0: enter_initialisation(c, in.byte() % 4 ? 0.0 : in.number(), in.number()); break;
      case 1: two_ ? (void)fmi2ExitInitializationMode(c) : (void)fmi3ExitInitializationMode(c); break;
      case 2:
      case 3:
      case 4: step(c, in); break;
      case 5:
      case 6: get_set(c, in, false); break;
      case 7:
      case 8: get_set(c, in, true); break;
      case 9: wholes(c, in); break;
      case 10: texts(c, in); break;
      case 11: save(c, in); break;
      case 12: restore(c, in.byte() % 8 ? *this : other, in); break;
      case 13: pass_on(c, in, other); break;
      case 14: free_state(c, in); break;
      case 15: directional(c, in); break;
      case 16: two_ ? (void)fmi2EnterEventMode(c) : (void)fmi3EnterEventMode(c); break;
      case 17: two_ ? (void)fmi2EnterContinuousTimeMode(c) : (void)fmi3EnterContinuousTimeMode(c); break;
      case 18:
      case 19: update(c); break;
      case 20:
        time_ += in.seconds();
        two_ ? (void)fmi2SetTime(c, time_) : (void)fmi3SetTime(c, time_);
        break;
      case 21: states(c, in); break;
      case 22:
      case 23: vectors(c, in); break;
      case 24:
        two_ ? (void)fmi2Reset(c) : (void)fmi3Reset(c);
        time_ = 0.0;
        break;
      case 25: in.byte() == 0 ? (void)(two_ ? int(fmi2Terminate(c)) : int(fmi3Terminate(c))) : run(c, in); break;
      case 26: others(c, in); break;
      case 27: start(c); break;
      default: run(c, in); break;
    }
  }

 private:
  void enter_initialisation(void* c, double start, double tolerance) {
    if (two_) {
      fmi2SetupExperiment(c, 1, tolerance, start, 0, 0.0);
      fmi2EnterInitializationMode(c);
    } else {
      fmi3EnterInitializationMode(c, true, tolerance, start, false, 0.0);
    }
    time_ = start;
  }
  /// As importers begin.
  void start(void* c) {
    enter_initialisation(c, 0.0, 1e-4);
    two_ ? (void)fmi2ExitInitializationMode(c) : (void)fmi3ExitInitializationMode(c);
    update(c);
    two_ ? (void)fmi2EnterContinuousTimeMode(c) : (void)fmi3EnterContinuousTimeMode(c);
  }
  void step(void* c, Input& in) {
    const double from = in.byte() % 16 ? time_ : in.number(), length = in.seconds();
    int code = 0;
    if (two_) {
      code = fmi2DoStep(c, from, length, 1);
    } else {
      bool event, terminate, early;
      double last = 0.0;
      code = fmi3DoStep(c, from, length, true, &event, &terminate, &early, in.byte() % 32 ? &last : nullptr);
    }
    if (code == 0) time_ = from + length;
  }
  /// What an importer does between two events.
  void run(void* c, Input& in) {
    if (co_simulation_) return step(c, in);
    double y[room], dy[room], z[room];
    const double length = 1e-4 * (1 + in.byte() % 20);
    if (two_) {
      std::size_t n = 0;
      while (n < room && fmi2GetContinuousStates(c, y, n) != fmi2OK) ++n;
      if (fmi2GetDerivatives(c, dy, n) != fmi2OK) return;
      for (std::size_t k = 0; k < n; ++k) y[k] += length * dy[k];
      fmi2SetTime(c, time_ += length);
      fmi2SetContinuousStates(c, y, n);
      for (n = 0; n < room && fmi2GetEventIndicators(c, z, n) != fmi2OK; ++n) {}
    } else {
      std::size_t n = 0;
      fmi3GetNumberOfContinuousStates(c, &n);
      fmi3GetContinuousStates(c, y, n);
      if (fmi3GetContinuousStateDerivatives(c, dy, n) != fmi3OK) return;
      for (std::size_t k = 0; k < n; ++k) y[k] += length * dy[k];
      fmi3SetTime(c, time_ += length);
      fmi3SetContinuousStates(c, y, n);
      fmi3GetNumberOfEventIndicators(c, &n);
      fmi3GetEventIndicators(c, z, n);
    }
    if (in.byte() % 4 != 0) return;
    two_ ? (void)fmi2EnterEventMode(c) : (void)fmi3EnterEventMode(c);
    update(c);
    two_ ? (void)fmi2EnterContinuousTimeMode(c) : (void)fmi3EnterContinuousTimeMode(c);
  }
  void get_set(void* c, Input& in, bool set) {
    Arguments a(in, of_);
    const std::size_t count3 = in.byte() % 16 ? a.count : in.size();
    if (two_) set ? fmi2SetReal(c, a.refs(), a.count, a.values()) : fmi2GetReal(c, a.refs(), a.count, a.values());
    else if (set) fmi3SetFloat64(c, a.refs(), a.count, a.values(), count3);
    else fmi3GetFloat64(c, a.refs(), a.count, a.values(), count3);
  }
  void wholes(void* c, Input& in) {
    Arguments a(in, of_);
    int values[room];
    std::int64_t long_values[room];
    if (two_) fmi2GetInteger(c, a.refs(), a.count, values);
    else if (in.byte() % 2) fmi3GetInt32(c, a.refs(), a.count, values, a.count);
    else fmi3GetInt64(c, a.refs(), a.count, long_values, a.count);
  }
  void texts(void* c, Input& in) {
    Arguments a(in, of_);
    const char* values[room];
    two_ ? (void)fmi2GetString(c, a.refs(), a.count, values)
         : (void)fmi3GetString(c, a.refs(), a.count, values, a.count);
  }
  void save(void* c, Input& in) {
    void** const state = &states_[in.byte() % std::size(states_)];
    two_ ? (void)fmi2GetFMUstate(c, state) : (void)fmi3GetFMUState(c, state);
  }
  void restore(void* c, Session& session, Input& in) {
    void* const state = session.states_[in.byte() % std::size(states_)];
    two_ ? (void)fmi2SetFMUstate(c, state) : (void)fmi3SetFMUState(c, state);
    // Where the importer's time is then it asks.
    const unsigned time = 0;
    two_ ? (void)fmi2GetReal(c, &time, 1, &time_) : (void)fmi3GetFloat64(c, &time, 1, &time_, 1);
  }
  /// Serialised, spoilt now and then, and read by the other instance, of another vehicle perhaps.
  void pass_on(void* c, Input& in, Session& other) {
    void* const state = states_[in.byte() % std::size(states_)];
    std::size_t size = 0;
    two_ ? (void)fmi2SerializedFMUstateSize(c, state, &size) : (void)fmi3SerializedFMUStateSize(c, state, &size);
    std::vector<char> bytes(size + room);
    const std::size_t said = in.byte() % 8 ? size : std::min(in.size(), bytes.size());
    if (two_) fmi2SerializeFMUstate(c, state, bytes.data(), said);
    else fmi3SerializeFMUState(c, state, reinterpret_cast<fmi3Byte*>(bytes.data()), said);
    if (in.byte() % 4 == 0) bytes[(in.byte() * 256u + in.byte()) % bytes.size()] ^= char(in.byte());
    const std::size_t given = in.byte() % 8 ? size : in.size();
    void** const to = &other.states_[in.byte() % std::size(states_)];
    if (two_) fmi2DeSerializeFMUstate(other.instance_, bytes.data(), given, to);
    else fmi3DeserializeFMUState(other.instance_, reinterpret_cast<const fmi3Byte*>(bytes.data()), given, to);
  }
  void free_state(void* c, Input& in) {
    void*& state = states_[in.byte() % std::size(states_)];
    void* again = state;
    two_ ? (void)fmi2FreeFMUstate(c, &state) : (void)fmi3FreeFMUState(c, &state);
    if (in.byte() % 4 == 0) two_ ? (void)fmi2FreeFMUstate(c, &again) : (void)fmi3FreeFMUState(c, &again);
  }
  void directional(void* c, Input& in) {
    Arguments unknowns(in, of_), knowns(in, of_);
    double found[room];
    if (two_) {
      fmi2GetDirectionalDerivative(c, unknowns.refs(), unknowns.count, knowns.refs(), knowns.count, knowns.values(),
                                   found);
    } else {
      fmi3GetDirectionalDerivative(c, unknowns.refs(), unknowns.count, knowns.refs(), knowns.count, knowns.values(),
                                   in.byte() % 8 ? knowns.count : in.size(), found, unknowns.count);
    }
  }
  void update(void* c) {
    if (two_) {
      fmi2EventInfo info;
      fmi2NewDiscreteStates(c, &info);
    } else {
      bool flags[5];
      double next = 0.0;
      fmi3UpdateDiscreteStates(c, flags, flags + 1, flags + 2, flags + 3, flags + 4, &next);
    }
  }
  void states(void* c, Input& in) {
    double y[room];
    for (double& x : y) x = in.number();
    const std::size_t n = in.size();
    two_ ? (void)fmi2SetContinuousStates(c, y, n) : (void)fmi3SetContinuousStates(c, y, n);
  }
  void vectors(void* c, Input& in) {
    double values[room];
    const std::size_t n = in.size();
    switch (in.byte() % 4) {
      case 0: two_ ? (void)fmi2GetContinuousStates(c, values, n) : (void)fmi3GetContinuousStates(c, values, n); break;
      case 1:
        two_ ? (void)fmi2GetDerivatives(c, values, n) : (void)fmi3GetContinuousStateDerivatives(c, values, n);
        break;
      case 2: two_ ? (void)fmi2GetEventIndicators(c, values, n) : (void)fmi3GetEventIndicators(c, values, n); break;
      default:
        two_ ? (void)fmi2GetNominalsOfContinuousStates(c, values, n)
             : (void)fmi3GetNominalsOfContinuousStates(c, values, n);
    }
  }
  void others(void* c, Input& in) {
    if (two_) {
      fmi2Boolean yes = 0;
      double number = 0.0;
      fmi2GetRealStatus(c, in.byte() % 2 ? fmi2LastSuccessfulTime : fmi2DoStepStatus, &number);
      fmi2GetBooleanStatus(c, fmi2Terminated, &yes);
      fmi2CancelStep(c);
      fmi2SetBoolean(c, nullptr, in.size(), nullptr);
      fmi2CompletedIntegratorStep(c, 1, &yes, in.byte() % 4 ? &yes : nullptr);
    } else {
      const unsigned reference = in.byte() % 4 ? of_.references[in.byte() % of_.references.size()] : in.byte() * 997u;
      std::size_t count = 0;
      fmi3GetNumberOfVariableDependencies(c, reference, &count);
      std::size_t elements[room], more[room];
      unsigned on[room];
      fmi3DependencyKind kinds[room];
      fmi3GetVariableDependencies(c, reference, elements, on, more, kinds, in.byte() % 4 ? count : in.size());
      fmi3EnterStepMode(c);
      fmi3SetBoolean(c, nullptr, in.size(), nullptr, 0);
    }
  }

  bool two_;
  const Exported& of_;
  bool co_simulation_;
  void* instance_ = nullptr;
  void* states_[3] = {};
  double time_ = 0.0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr int max_calls = 150;
  Input in(data, size);
  const unsigned head = in.byte();
  const auto& all = vehicles();
  const bool second = head % 2 == 0, co_simulation = head / 2 % 2 == 0;
  const std::size_t which = head / 4 % all.size();
  Session one(second, all[which], co_simulation);
  Session other(second, all[head / 32 % 2 ? which : (which + 1) % all.size()], co_simulation);
  for (int call = 0; call < max_calls && !in.empty(); ++call) {
    if (in.byte() % 8 != 0) one.call(in, other);
    else other.call(in, one);
  }
  return 0;
}
