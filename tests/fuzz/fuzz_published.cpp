// "PUBLISHED \0 VEHICLE" as a file of published values and each vehicle that it names.
#include "files.hpp"
#include "wingbeat/files/published.hpp"

using namespace wingbeat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto parts = fuzz::parts_of(data, size, 2);
  return fuzz::reads_or_refuses([&] {
    (void)parse_published(parts[0], "fuzz.toml", [&](const std::string& file) { return parse_design(parts[1], file); });
  });
}
