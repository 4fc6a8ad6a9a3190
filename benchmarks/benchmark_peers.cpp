// The same designs through the batched solver, the scalar solver and general-purpose solvers, in one run on one core:
// time per design, ratio to the batched solver and the accuracy that each reached. docs/benchmarks.md has a run and its
// meaning.
//
//   benchmark_peers             4096 designs (fewer for the slow ones)
//   benchmark_peers DESIGNS     another number of designs
//
// Every peer integrates in crank angle, where the period is known, from the same guess; its first laps are coarse; and
// its tolerance (for AUTO-07p: its number of mesh intervals) is the loosest of a ladder that brings the median lift
// error to 1e-6 and 99 % of the designs within ten times that. SciPy is asked of /usr/bin/python3, or of what
// WINGBEAT_PYTHON names; AUTO-07p is expected where Debian puts it, or in AUTO_DIR.
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#include <unistd.h>
#include <algorithm>
#include <boost/numeric/odeint.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "vehicle/random_vehicle.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/study/run.hpp"

namespace {

using namespace wingbeat;
namespace fs = std::filesystem;

constexpr double goal = 1e-6;              // lift error that every method is to reach at the median
constexpr double high_goal = 10.0 * goal;  // and at the 99th percentile
constexpr double periodic = 1e-6;          // a lap that returns to its start within this, relatively, is the orbit
constexpr double coarse = 1e-4;            // tolerance of the first laps, which only approach the orbit
constexpr double settled = 3e-2;           // change over a coarse lap below which the real ones begin
constexpr int max_laps = 60;
constexpr double lap_start = -0.5 * pi;  // the lower dead centre

struct Steady {
  double lift = absent;       // mean [N]
  double power = absent;      // mean electrical [W]
  double frequency = absent;  // [Hz]
};

double seconds_of(const std::function<void()>& f) {
  const auto start = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The right-hand side in doubles -------------------------------------------------------------------------------------

constexpr std::size_t all_states = 5;  // crank speed, current; time, lift impulse, charge

// d(state)/d(theta), every state divided by a scale of its own.
struct Peer {
  Vehicle<double> vehicle;
  CrankGeometry<double> geometry;
  std::array<double, all_states> scale;
  std::array<double, 2> guess;

  explicit Peer(const Vehicle<double>& v) : vehicle(v), geometry(geometry_of(v.transmission.slider_crank)) {
    const double omega = 0.6 * no_load_speed(v.motor, v.voltage);
    const double lap = two_pi / omega;
    const double stall_current = v.voltage / v.motor.armature_resistance;
    const double stroke_velocity =
        v.transmission.slider_crank.crank_radius / v.transmission.slider_crank.hinge_offset * omega;
    scale = {omega, stall_current, lap, 0.5 * v.wings.air_density * v.wings.s2 * square(stroke_velocity) * lap,
             stall_current * lap};
    guess = {1.0, 1.0 - v.motor.torque_constant * omega / v.voltage};
  }

  template <std::size_t N>
  void rates(double theta, const double* u, double* du) const {
    const double omega = u[0] * scale[0];
    const double i = u[1] * scale[1];
    const CrankKinematics<double> k = crank_kinematics(geometry, std::sin(theta), std::cos(theta));
    const double stroke = k.stroke_slope >= 0.0 ? 1.0 : -1.0;
    const Instant<double> at =
        instant_at(vehicle, k, spring_moment(vehicle, k), omega, i, vehicle.voltage, stroke, 1.0);
    const Branch<double> branch{stroke, at.force_switch >= 0.0 ? 1.0 : -1.0, 1.0, 1.0};
    const Motion<double> m = motion_on(vehicle, at, i, vehicle.voltage, branch);
    const double dt = 1.0 / omega;
    du[0] = m.crank_acceleration * dt / scale[0];
    du[1] = m.inductive_voltage / vehicle.motor.armature_inductance * dt / scale[1];
    if constexpr (N == all_states) {
      du[2] = dt / scale[2];
      du[3] = m.aero.lift * dt / scale[3];
      du[4] = i * dt / scale[4];
    }
  }

  Steady metrics(const double* u) const {
    const double period = u[2] * scale[2];
    return {u[3] * scale[3] / period, vehicle.voltage * u[4] * scale[4] / period, 1.0 / period};
  }
};

double change_of(const double* from, const double* to) {
  return std::max(std::abs(to[0] - from[0]) / std::abs(to[0]), std::abs(to[1] - from[1]));
}

// Laps until periodic: `plain` takes the two states over a coarse lap, `measured` all states over a lap at the
// tolerance asked for (the quadratures count from zero). Both return false where they fail.
template <class Plain, class Measured>
Steady flap(const Peer& peer, bool start_coarse, const Plain& plain, const Measured& measured,
            std::array<double, 2>* start = nullptr) {
  std::array<double, all_states> u{peer.guess[0], peer.guess[1]};
  int laps = 0;
  for (double change = 1.0; start_coarse && change > settled; ++laps) {
    const std::array<double, 2> from{u[0], u[1]};
    if (laps == max_laps || !plain(laps, u.data())) return {};
    change = change_of(from.data(), u.data());
  }
  for (; laps < max_laps; ++laps) {
    const std::array<double, 2> from{u[0], u[1]};
    u[2] = u[3] = u[4] = 0.0;
    if (!measured(laps, u.data())) return {};
    if (change_of(from.data(), u.data()) < periodic) {
      if (start) *start = {u[0], u[1]};
      return peer.metrics(u.data());
    }
  }
  return {};
}

// Boost.odeint -------------------------------------------------------------------------------------------------------

template <std::size_t N>
struct Dopri5 {
  using State = std::array<double, N>;
  const Peer& peer;
  double tolerance;
  double step = 0.1;

  void integrate(double* u, double from, double to) {
    namespace odeint = boost::numeric::odeint;
    State state;
    std::copy_n(u, N, state.begin());
    auto stepper = odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_dopri5<State>());
    const auto rates = [&](const State& x, State& dx, double theta) { peer.rates<N>(theta, x.data(), dx.data()); };
    // As odeint::integrate_adaptive, but the step found is kept for the next lap, and a step to where the crank would
    // turn back (which odeint accepts if its error is no number) is taken again in quarters.
    double theta = from;
    while (to - theta > 1e-12) {
      const State before = state;
      const double theta_before = theta;
      double h = std::min(step, to - theta);
      const bool cut = h < step;
      if (stepper.try_step(rates, state, theta, h) != odeint::success) {
        step = h;
      } else if (!(state[0] > 0.0)) {
        state = before;
        theta = theta_before;
        step = 0.25 * std::min(step, to - theta);
        if (step < 1e-9) break;
        stepper.reset();
      } else if (!cut) {
        step = h;
      }
    }
    if (to - theta > 1e-12) state[0] = absent;
    std::copy_n(state.begin(), N, u);
  }
};

Steady by_odeint(const Peer& peer, double tolerance, std::array<double, 2>* start = nullptr) {
  Dopri5<2> plain{peer, std::max(coarse, tolerance)};
  Dopri5<all_states> measured{peer, tolerance};
  const auto lap = [](auto& method, double* u) {
    method.integrate(u, lap_start, lap_start + two_pi);
    return std::isfinite(u[0]) && u[0] > 0.0;
  };
  return flap(
      peer, tolerance < coarse, [&](int, double* u) { return lap(plain, u); },
      [&](int, double* u) { return lap(measured, u); }, start);
}

// CVODE: Adams with functional iteration -----------------------------------------------------------------------------

template <std::size_t N>
class Adams {
 public:
  Adams() {
    SUNContext_Create(nullptr, &context_);
    y_ = N_VNew_Serial(sunindextype(N), context_);
    N_VConst(1.0, y_);
    memory_ = CVodeCreate(CV_ADAMS, context_);
    nonlinear_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
    CVodeInit(memory_, &rates, 0.0, y_);
    CVodeSetNonlinearSolver(memory_, nonlinear_);
    CVodeSetUserData(memory_, this);
    CVodeSetErrHandlerFn(memory_, [](int, const char*, const char*, char*, void*) {}, nullptr);
    CVodeSetMaxNumSteps(memory_, 100000);
  }
  Adams(const Adams&) = delete;
  Adams& operator=(const Adams&) = delete;
  ~Adams() {
    CVodeFree(&memory_);
    SUNNonlinSolFree(nonlinear_);
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }

  void begin(const Peer& peer, const double* u, double tolerance) {
    peer_ = &peer;
    std::copy_n(u, N, N_VGetArrayPointer(y_));
    CVodeReInit(memory_, lap_start, y_);
    CVodeSStolerances(memory_, tolerance, tolerance);
    begun_ = theta_ = lap_start;
    last_.fill(0.0);
  }

  // Goes on to the next lap's start without a restart, which would fall back to first order; quadratures by difference.
  bool lap(double* u) {
    begun_ += two_pi;
    if (CVode(memory_, begun_, y_, &theta_, CV_NORMAL) < 0) return false;
    const double* y = N_VGetArrayPointer(y_);
    for (std::size_t n = 0; n < N; ++n) {
      u[n] = n < 2 ? y[n] : y[n] - last_[n];
      last_[n] = y[n];
    }
    return u[0] > 0.0;
  }

 private:
  static int rates(realtype theta, N_Vector y, N_Vector dy, void* self) {
    const double* u = N_VGetArrayPointer(y);
    if (!(u[0] > 0.0)) return 1;
    static_cast<Adams*>(self)->peer_->template rates<N>(theta, u, N_VGetArrayPointer(dy));
    return 0;
  }

  const Peer* peer_ = nullptr;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
  void* memory_ = nullptr;
  SUNNonlinearSolver nonlinear_ = nullptr;
  double begun_ = 0.0, theta_ = 0.0;
  std::array<double, N> last_{};
};

Steady by_cvode(Adams<2>& plain, Adams<all_states>& measured, const Peer& peer, double tolerance) {
  bool fine = false;
  return flap(
      peer, tolerance < coarse,
      [&](int laps, double* u) {
        if (laps == 0) plain.begin(peer, u, coarse);
        return plain.lap(u);
      },
      [&](int, double* u) {
        if (!fine) measured.begin(peer, u, tolerance);
        fine = true;
        return measured.lap(u);
      });
}

// Other programs -----------------------------------------------------------------------------------------------------

std::string environment(const char* name, const char* otherwise) {
  const char* value = std::getenv(name);
  return value && *value ? value : otherwise;
}

bool runs(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

// A folder of our own for what other programs read and write.
struct Scratch {
  fs::path path = fs::temp_directory_path() / ("benchmark_peers." + std::to_string(getpid()));
  Scratch() { fs::create_directories(path); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

// Every number of the equations, in the order that peers_auto.f90 reads.
std::vector<std::pair<const char*, double>> numbers_of(const Vehicle<double>& v) {
  const auto& c = v.wings.coefficients;
  return {{"voltage", v.voltage},
          {"resistance", v.motor.armature_resistance},
          {"inductance", v.motor.armature_inductance},
          {"torque_constant", v.motor.torque_constant},
          {"inertia", v.motor.inertia},
          {"damping", v.motor.viscous_damping},
          {"friction_torque", v.motor.friction_torque},
          {"crank_radius", v.transmission.slider_crank.crank_radius},
          {"rod_length", v.transmission.slider_crank.rod_length},
          {"hinge_offset", v.transmission.slider_crank.hinge_offset},
          {"mid_stroke_height", v.transmission.slider_crank.mid_stroke_height},
          {"rod_force", v.transmission.slider_crank.formulation == Formulation::rod_force ? 1.0 : 0.0},
          {"friction_radius", v.friction.radius},
          {"stiffness", v.spring.stiffness},
          {"wing_count", v.wing_count},
          {"wing_inertia", v.wing_inertia},
          {"air_density", v.wings.air_density},
          {"pitch", v.wings.pitch_coefficient},
          {"s2", v.wings.s2},
          {"s3", v.wings.s3},
          {"lift0", c.lift.offset},
          {"lift1", c.lift.amplitude},
          {"lift2", c.lift.rate},
          {"lift3", c.lift.phase},
          {"drag0", c.drag.offset},
          {"drag1", c.drag.amplitude},
          {"drag2", c.drag.rate},
          {"drag3", c.drag.phase}};
}

// Tuning and the table -----------------------------------------------------------------------------------------------

struct Answers {
  std::vector<Steady> got, exact;
  double seconds = 0.0;  // per answer
};

struct Errors {
  double median, high, worst, others;
  int failed = 0;
};

double quantile(const std::vector<double>& sorted, double q) {
  return sorted.empty() ? absent : sorted[std::size_t(std::ceil(q * double(sorted.size() - 1)))];
}

Errors errors_of(const Answers& answers) {
  Errors e{};
  std::vector<double> lift;
  for (std::size_t n = 0; n < answers.got.size(); ++n) {
    const Steady& got = answers.got[n];
    const Steady& exact = answers.exact[n];
    if (!std::isfinite(got.lift)) {
      ++e.failed;
      continue;
    }
    lift.push_back(std::abs(got.lift / exact.lift - 1.0));
    e.others =
        std::max({e.others, std::abs(got.power / exact.power - 1.0), std::abs(got.frequency / exact.frequency - 1.0)});
  }
  std::sort(lift.begin(), lift.end());
  e.median = quantile(lift, 0.5);
  e.high = quantile(lift, 0.99);
  e.worst = lift.empty() ? absent : lift.back();
  return e;
}

struct Rival {
  std::string name;
  std::string missing;  // why it cannot be run; empty if it can
  std::string setting;  // printf format of what is tuned
  std::vector<double> ladder;
  int rounds;  // of timing, the best counts
  std::function<Answers(double)> solve;
};

struct Row {
  Answers answers;
  Errors errors;
  double setting;
};

Row tuned(const Rival& rival) {
  Row row;
  for (const double setting : rival.ladder) {
    row.setting = setting;
    row.answers = rival.solve(setting);
    row.errors = errors_of(row.answers);
    const bool few_failures = row.errors.failed * 20 < int(row.answers.got.size());
    if (few_failures && row.errors.median <= goal && row.errors.high <= high_goal) break;
  }
  return row;
}

std::vector<double> tolerances() {
  std::vector<double> list;
  for (int n = 16; n <= 40; ++n) list.push_back(std::pow(10.0, -0.25 * n));
  return list;
}

Steady steady_of(const Metrics<double>& m) {
  return {m[Metric::lift_mean], m[Metric::power_electrical], m[Metric::frequency]};
}

// AUTO-07p: one branch of orbits per design, continued in voltage. Time is AUTO's own count, per point of the branch.
Answers by_auto(const std::vector<EnsembleMember>& members, int intervals, const fs::path& folder,
                const StartUp& start_up) {
  constexpr int points = 60;
  constexpr int rows = 201;
  std::ofstream(folder / "fort.2") << "NDIM=6 IPS=4 IRS=0 ILP=0\nICP=[1,2,3,4]\nNTST=" << intervals
                                   << " NCOL=4 IAD=1 ISP=0 ISW=1 IPLT=0 NBC=6 NINT=0\nNMX=" << points
                                   << " NPR=0 MXBF=0 IID=2 ITMX=8 ITNW=7 NWTN=3 JAC=0\nRL0=0.5 RL1=20 A0=-1e9 A1=1e9\n"
                                      "EPSL=1e-7 EPSU=1e-7 EPSS=1e-4 DS=0.01 DSMIN=1e-5 DSMAX=0.05 IADS=1\nNPAR=36\n"
                                      "THL={}\nTHU={}\nUZR={}\n";
  Answers answers;
  double total = 0.0;
  std::vector<EnsembleMember> asked;
  for (const EnsembleMember& member : members) {
    const Peer peer(member.vehicle);
    std::array<double, 2> start{};
    by_odeint(peer, 1e-8, &start);
    std::ofstream design(folder / "design.txt");
    design.precision(17);
    for (const auto& [name, value] : numbers_of(member.vehicle)) design << value << '\n';
    for (const double s : peer.scale) design << s << '\n';
    design.close();
    std::ofstream table(folder / "start.txt");
    table.precision(17);
    std::array<double, all_states> u{start[0], start[1]};
    for (int row = 0; row < rows; ++row) {
      const auto angle = [&](int n) { return lap_start + two_pi * n / (rows - 1); };
      if (row > 0) Dopri5<all_states>{peer, 1e-8}.integrate(u.data(), angle(row - 1), angle(row));
      for (const double value : u) table << value << ' ';
      table << double(row) / (rows - 1) << '\n';
    }
    table.close();
    runs("cd '" + folder.string() + "' && rm -f fort.7 fort.8 fort.9 log");
    std::system(("cd '" + folder.string() + "' && OMP_NUM_THREADS=1 timeout 60 ./peers_auto >log 2>&1").c_str());

    std::ifstream log(folder / "log");
    double counted = absent;
    for (std::string line; std::getline(log, line);) {
      if (const auto at = line.find("Total Time"); at != std::string::npos) counted = std::atof(line.c_str() + at + 10);
    }
    std::ifstream branch(folder / "fort.7");
    std::size_t found = 0;
    for (std::string line; std::getline(branch, line);) {
      std::istringstream fields(line);
      std::vector<double> values;
      for (double value; fields >> value;) values.push_back(value);
      if (values.size() < 9 || values[0] == 0.0) continue;
      const std::size_t last = values.size();
      answers.got.push_back({values[last - 3], values[last - 2], values[last - 1]});
      asked.push_back(member);
      asked.back().vehicle.voltage = values[4];
      ++found;
    }
    if (found == 0 || !std::isfinite(counted)) {
      answers.got.emplace_back();
      asked.push_back(member);
      continue;
    }
    total += counted;
  }
  EnsembleOptions exact;
  exact.scalar_only = true;
  exact.tolerance = 1e-10;
  std::vector<EnsembleOutcome> outcomes(asked.size());
  solve_ensemble(asked, exact, start_up, outcomes);
  for (const EnsembleOutcome& out : outcomes) answers.exact.push_back(steady_of(out.metrics));
  answers.seconds = total / double(std::max<std::size_t>(1, asked.size()));
  return answers;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::max(1, std::atoi(argv[1])) : 4096;
  const StartUp start_up = start_up_in_time();

  // The designs of the box that flap, with their exact answers.
  std::mt19937_64 random(20222);
  std::vector<EnsembleMember> members;
  std::vector<Steady> exact;
  while (members.size() < count) {
    const Design<double> design = box_design(random);
    const std::vector<EnsembleMember> one{{resolve(design), reporting_of(design)}};
    EnsembleOptions options;
    options.scalar_only = true;
    options.tolerance = 1e-10;
    std::vector<EnsembleOutcome> outcome(1);
    solve_ensemble(one, options, start_up, outcome);
    if (outcome[0].status != FlappingStatus::flapping) continue;
    members.push_back(one[0]);
    exact.push_back(steady_of(outcome[0].metrics));
  }
  std::vector<Peer> peers;
  for (const EnsembleMember& m : members) peers.emplace_back(m.vehicle);

  const auto ours = [&](bool scalar, bool every_metric) {
    return [&, scalar, every_metric](double tolerance) {
      EnsembleOptions options;
      options.tolerance = tolerance;
      options.scalar_only = scalar;
      if (!every_metric) {
        options.metrics.reset();
        for (const Metric m : {Metric::lift_mean, Metric::power_electrical, Metric::frequency})
          options.metrics.set(std::size_t(m));
      }
      std::vector<EnsembleOutcome> outcomes(members.size());
      Answers answers;
      answers.seconds =
          seconds_of([&] { solve_ensemble(members, options, start_up, outcomes); }) / double(members.size());
      answers.exact = exact;
      for (const EnsembleOutcome& out : outcomes) answers.got.push_back(steady_of(out.metrics));
      return answers;
    };
  };
  const auto each = [&](auto solve) {
    return [&, solve](double tolerance) {
      Answers answers;
      answers.exact = exact;
      answers.got.resize(peers.size());
      answers.seconds = seconds_of([&] {
                          for (std::size_t n = 0; n < peers.size(); ++n) answers.got[n] = solve(peers[n], tolerance);
                        }) /
                        double(peers.size());
      return answers;
    };
  };

  const Scratch scratch;
  const std::string python = environment("WINGBEAT_PYTHON", "/usr/bin/python3");
  const bool scipy = runs(python + " -c 'from scipy.integrate import odeint'");
  const std::size_t few = std::min<std::size_t>(count, 32), fewer = std::min<std::size_t>(count, 6);
  if (scipy) {
    std::ofstream csv(scratch.path / "designs.csv");
    csv.precision(17);
    const char* comma = "";
    for (const auto& [name, value] : numbers_of(members[0].vehicle)) csv << std::exchange(comma, ",") << name;
    for (std::size_t n = 0; n < few; ++n) {
      const char* before = "\n";
      for (const auto& [name, value] : numbers_of(members[n].vehicle)) csv << std::exchange(before, ",") << value;
    }
    csv << '\n';
  }
  const auto by_lsoda = [&](double tolerance) {
    char rtol[32];
    std::snprintf(rtol, sizeof rtol, "%.17g", tolerance);
    const fs::path out = scratch.path / "lsoda.txt";
    Answers answers;
    std::system((python + " '" WINGBEAT_PEERS "/peers_lsoda.py' '" + (scratch.path / "designs.csv").string() + "' " +
                 rtol + " >'" + out.string() + "' 2>/dev/null")
                    .c_str());
    std::ifstream rows(out);
    for (std::string line; std::getline(rows, line);) {
      Steady s;
      double seconds = 0.0;
      if (std::sscanf(line.c_str(), "%lf %lf %lf %lf", &s.lift, &s.power, &s.frequency, &seconds) != 4) continue;
      answers.got.push_back(s);
      answers.seconds += seconds;
    }
    answers.exact.assign(exact.begin(), exact.begin() + std::ptrdiff_t(answers.got.size()));
    answers.seconds /= double(std::max<std::size_t>(1, answers.got.size()));
    return answers;
  };

  const std::string auto_dir = environment("AUTO_DIR", "/usr/lib/auto-07p");
  std::string no_auto;
  if (!fs::exists(auto_dir + "/lib/main.o")) {
    no_auto = "not installed";
  } else if (!runs("cd '" + scratch.path.string() +
                   "' && gfortran -O3 -fopenmp -w '" WINGBEAT_PEERS "/peers_auto.f90' '" + auto_dir +
                   "'/lib/*.o -o peers_auto")) {
    no_auto = "installed, but gfortran could not build its equations";
  }

  Adams<2> plain;
  Adams<all_states> measured;
  std::vector<Rival> rivals;
  rivals.push_back({"wingbeat, batched", "", "tolerance %.0e", {goal}, 40, ours(false, false)});
  rivals.push_back({"wingbeat, batched, tuned alike",
                    "",
                    "tolerance %.0e",
                    {1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, goal},
                    40,
                    ours(false, false)});
  rivals.push_back({"wingbeat, batched, all metrics", "", "tolerance %.0e", {goal}, 20, ours(false, true)});
  rivals.push_back({"wingbeat, scalar orbit", "", "tolerance %.0e", {goal}, 5, ours(true, false)});
  rivals.push_back({"Boost.odeint dopri5", "", "rtol %.1e", tolerances(), 5,
                    each([](const Peer& p, double tolerance) { return by_odeint(p, tolerance); })});
  rivals.push_back({"CVODE, Adams", "", "rtol %.1e", tolerances(), 5,
                    each([&](const Peer& p, double tolerance) { return by_cvode(plain, measured, p, tolerance); })});
  rivals.push_back({"SciPy LSODA", scipy ? "" : "not installed", "rtol %.1e", tolerances(), 2, by_lsoda});
  rivals.push_back({"AUTO-07p, per point",
                    no_auto,
                    "NTST %.0f",
                    {10, 14, 20, 28, 40, 56, 80, 112, 160, 224, 320},
                    2,
                    [&](double intervals) {
                      return by_auto({members.begin(), members.begin() + std::ptrdiff_t(fewer)}, int(intervals),
                                     scratch.path, start_up);
                    }});

  std::printf("%zu designs of the reference box that flap (%zu for LSODA, %zu branches for AUTO), one core, %s\n",
              count, few, fewer,
              std::string(std::find_if(std::begin(instruction_sets), std::end(instruction_sets),
                                       [](const auto& entry) { return entry.second == best_instruction_set(); })
                              ->first)
                  .c_str());
  std::printf("errors are relative, against the scalar solver at 1e-10; 'others': worst of power and frequency\n\n");
  std::printf("%-31s %-16s %14s %9s   %8s %8s %8s %8s\n", "method", "tuned to", "us per design", "ratio", "lift 50%",
              "99%", "worst", "others");

  // Tuned first; then timed in turns, so that a busy moment meets all alike. The best of each counts.
  std::vector<Row> rows;
  for (const Rival& rival : rivals) rows.push_back(rival.missing.empty() ? tuned(rival) : Row{});
  const int most =
      std::max_element(rivals.begin(), rivals.end(), [](auto& a, auto& b) { return a.rounds < b.rounds; })->rounds;
  for (int round = 0; round < most; ++round) {
    for (std::size_t n = 0; n < rivals.size(); ++n) {
      if (round >= rivals[n].rounds || !rivals[n].missing.empty()) continue;
      rows[n].answers.seconds = std::min(rows[n].answers.seconds, rivals[n].solve(rows[n].setting).seconds);
    }
  }
  for (std::size_t n = 0; n < rivals.size(); ++n) {
    if (!rivals[n].missing.empty()) {
      std::printf("%-31s %s\n", rivals[n].name.c_str(), rivals[n].missing.c_str());
      continue;
    }
    char setting[64];
    std::snprintf(setting, sizeof setting, rivals[n].setting.c_str(), rows[n].setting);
    const Errors& e = rows[n].errors;
    std::printf("%-31s %-16s %14.2f %9.1f   %8.1e %8.1e %8.1e %8.1e", rivals[n].name.c_str(), setting,
                1e6 * rows[n].answers.seconds, rows[n].answers.seconds / rows[0].answers.seconds, e.median, e.high,
                e.worst, e.others);
    if (e.failed > 0) std::printf("  (%d of %zu without an answer)", e.failed, rows[n].answers.got.size());
    std::printf("\n");
  }
  return 0;
}
