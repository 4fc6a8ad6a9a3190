// "BENCH \0 VEHICLE \0 LOG" as a bench file, its vehicle and its logs.
#include "files.hpp"
#include "wingbeat/files/bench_file.hpp"

using namespace wingbeat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto parts = fuzz::parts_of(data, size, 3);
  for (const char* vehicle : {"friction2022.toml", "friction2022-springs.toml"}) {
    fuzz::put(std::filesystem::path("designs") / vehicle, parts[1]);
  }
  for (const char* log : {"air.csv", "vacuum.csv", "wingless.csv"}) {
    fuzz::put(std::filesystem::path("bench") / log, parts[2]);
  }
  const auto file = fuzz::put("bench/bench.toml", parts[0]);
  return fuzz::reads_or_refuses([&] { (void)read_bench(file); });
}
