// Bytes as a vehicle file, its table files and overrides: "FILE \0 TABLE \0 OVERRIDE \0 OVERRIDE ...". Only InputError
// may escape, a design that is accepted must survive writing and reading, and no file is touched.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "wingbeat/files/two_sides_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::string> parts(1);
  for (std::size_t n = 0; n < size; ++n) {
    if (data[n] == 0 && parts.size() < 6) {
      parts.emplace_back();
    } else {
      parts.back() += char(data[n]);
    }
  }
  const std::string table = parts.size() > 1 ? parts[1] : "";
  const std::vector<std::string> overrides(parts.begin() + std::min<std::ptrdiff_t>(2, std::ptrdiff_t(parts.size())),
                                           parts.end());
  std::string written;
  try {
    const wingbeat::VehicleFile vehicle =
        wingbeat::parse_vehicle(parts[0], "fuzz.toml", overrides, [&](const std::string&) { return table; });
    written = wingbeat::write_design(vehicle.sides ? vehicle.sides->left : vehicle.design);
  } catch (const wingbeat::InputError& error) {
    // One error a line, each with its place.
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);) {
      if (line.find(": ") == std::string::npos) std::abort();
    }
    return 0;
  }
  try {
    if (wingbeat::write_design(wingbeat::parse_design(written, "written.toml")) != written) std::abort();
  } catch (const wingbeat::InputError& error) {
    std::fprintf(stderr, "%s\n%s\n", error.what(), written.c_str());
    std::abort();
  }
  return 0;
}
