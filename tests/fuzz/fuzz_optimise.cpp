// "STUDY \0 VEHICLE \0 CATALOGUE" as an optimisation study, its vehicle and its motor catalogue.
#include "files.hpp"
#include "wingbeat/files/optimise_file.hpp"

using namespace wingbeat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto parts = fuzz::parts_of(data, size, 3);
  fuzz::put("designs/friction2022-springs.toml", parts[1]);
  fuzz::put("motors/motors.csv", parts[2]);
  const auto file = fuzz::put("studies/optimise.toml", parts[0]);
  return fuzz::reads_or_refuses([&] {
    const OptimiseFile study = read_optimise_study(file);
    for (const MotorTrial& trial : trials_of(study)) {
      if (!trial.refused()) (void)trial_study(study, trial);
    }
  });
}
