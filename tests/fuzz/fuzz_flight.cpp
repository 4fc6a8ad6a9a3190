// "FLIGHT \0 VEHICLE" as a flight file and its vehicle.
#include "files.hpp"
#include "wingbeat/files/flight_file.hpp"

using namespace wingbeat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto parts = fuzz::parts_of(data, size, 2);
  fuzz::put("designs/flight-friction2022.toml", parts[1]);
  const auto file = fuzz::put("studies/fly.toml", parts[0]);
  return fuzz::reads_or_refuses([&] { (void)read_flight_file(file); });
}
