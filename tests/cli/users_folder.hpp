// A folder with a bench, a study of each kind, and all that they name.
#pragma once

#include "program.hpp"

namespace cli {

class UsersFolder : public Program {
 protected:
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }

  void fill() const {
    fs::copy_file(springs, path("vehicle.toml"));
    for (const char* name : {"air.csv", "vacuum.csv", "wingless.csv"})
      fs::copy_file(data + "/bench/" + name, path(name));
    std::string bench = read(data + "/bench/flapper.toml");
    const std::string named = "../designs/friction2022-springs.toml";
    bench.replace(bench.find(named), named.size(), "vehicle.toml");
    write("bench.toml", bench);
    write(
        "optimise.toml",
        "[study]\nvehicle = \"vehicle.toml\"\n[objective]\nminimise = \"power_electrical_w\"\nstarts = 2\nscreen = 32\n"
        "[[parameter]]\nkey = \"supply.voltage\"\nlower = \"3 V\"\nupper = \"8 V\"\n"
        "[[constraint]]\nmetric = \"lift_to_weight\"\nat_least = 1\n");
    write("tolerance.toml",
          "[study]\nvehicle = \"vehicle.toml\"\n[samples]\ncount = 64\n"
          "[[parameter]]\nkey = \"friction.radius\"\ndistribution = \"normal\"\nrelative_deviation = 0.03\n");
    write("sweep.toml",
          "[study]\nvehicle = \"vehicle.toml\"\n[[axis]]\nkey = \"supply.voltage\"\nfrom = 2\nto = 4\ncount = 3\n");
  }
};

}  // namespace cli
