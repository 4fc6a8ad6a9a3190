// "STUDY \0 VEHICLE \0 COVARIANCE" as a tolerance study, its vehicle and a fit's covariance.
#include "files.hpp"
#include "wingbeat/files/tolerance_file.hpp"

using namespace wingbeat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto parts = fuzz::parts_of(data, size, 3);
  fuzz::put("designs/friction2022-springs.toml", parts[1]);
  fuzz::put("studies/fitted.covariance.toml", parts[2]);
  const auto file = fuzz::put("studies/tolerance.toml", parts[0]);
  return fuzz::reads_or_refuses([&] { (void)read_tolerance_study(file); });
}
