// Rivals that are other programs: SciPy and AUTO-07p.
#pragma once

#include <unistd.h>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "peers/integrators.hpp"
#include "peers/tuning.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"

namespace wingbeat::peers {

namespace fs = std::filesystem;

inline std::string environment(const char* name, const char* otherwise) {
  const char* value = std::getenv(name);
  return value && *value ? value : otherwise;
}

inline bool runs(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

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
inline std::vector<std::pair<const char*, double>> numbers_of(const Vehicle<double>& v) {
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

// The numbers of the first `count` designs, for peers_lsoda.py.
inline void write_designs(const std::vector<EnsembleMember>& members, std::size_t count, const fs::path& folder) {
  std::ofstream csv(folder / "designs.csv");
  csv.precision(17);
  const char* comma = "";
  for (const auto& [name, value] : numbers_of(members[0].vehicle)) csv << std::exchange(comma, ",") << name;
  for (std::size_t n = 0; n < count; ++n) {
    const char* before = "\n";
    for (const auto& [name, value] : numbers_of(members[n].vehicle)) csv << std::exchange(before, ",") << value;
  }
  csv << '\n';
}

// SciPy's LSODA, on the designs that write_designs() wrote; times are its own.
inline Answers by_lsoda(const std::string& python, const fs::path& folder, const std::vector<Steady>& exact,
                        double tolerance) {
  char rtol[32];
  std::snprintf(rtol, sizeof rtol, "%.17g", tolerance);
  const fs::path out = folder / "lsoda.txt";
  Answers answers;
  std::system((python + " '" WINGBEAT_PEERS "/peers_lsoda.py' '" + (folder / "designs.csv").string() + "' " + rtol +
               " >'" + out.string() + "' 2>/dev/null")
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
}

// Builds the equations for AUTO-07p; what stands in the way, or nothing.
inline std::string build_auto(const fs::path& folder) {
  const std::string auto_dir = environment("AUTO_DIR", "/usr/lib/auto-07p");
  if (!fs::exists(auto_dir + "/lib/main.o")) return "not installed";
  const bool built =
      runs("cd '" + folder.string() + "' && gfortran -O3 -fopenmp -w '" WINGBEAT_PEERS "/peers_auto.f90' '" + auto_dir +
           "'/lib/*.o -o peers_auto");
  return built ? "" : "installed, but gfortran could not build its equations";
}

// AUTO-07p: one branch of orbits per design, continued in voltage. Time is AUTO's own count, per point of the branch.
inline Answers by_auto(const std::vector<EnsembleMember>& members, int intervals, const fs::path& folder,
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
    by_odeint<Dopri5>(peer, 1e-8, &start);
    std::ofstream design(folder / "design.txt");
    design.precision(17);
    for (const auto& [name, value] : numbers_of(member.vehicle)) design << value << '\n';
    for (const double s : peer.scale) design << s << '\n';
    design.close();
    std::ofstream table(folder / "start.txt");
    table.precision(17);
    std::array<double, all_states> u{start[0], start[1]};
    for (int row = 0; row < rows; ++row) {
      const auto angle = [&](int n) { return iterate_start + two_pi * n / (rows - 1); };
      if (row > 0) Controlled<Dopri5<all_states>>{peer, 1e-8}.integrate(u.data(), angle(row - 1), angle(row));
      for (const double value : u) table << value << ' ';
      table << double(row) / (rows - 1) << '\n';
    }
    table.close();
    runs("cd '" + folder.string() + "' && rm -f fort.7 fort.8 fort.9 log");
    std::system(("cd '" + folder.string() + "' && OMP_NUM_THREADS=1 timeout 60 ./peers_auto >log 2>&1").c_str());

    std::ifstream log(folder / "log");
    double counted = absent;
    for (std::string line; std::getline(log, line);) {
      if (const auto position = line.find("Total Time"); position != std::string::npos)
        counted = std::atof(line.c_str() + position + 10);
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

}  // namespace wingbeat::peers
