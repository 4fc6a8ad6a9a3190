// Bytes as a motor data sheet; what it identifies must survive writing and reading.
#include "files.hpp"
#include "wingbeat/files/datasheet_file.hpp"
#include "wingbeat/report/identification_report.hpp"

using namespace wingbeat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::reads_or_refuses([&] {
    const MotorDatasheet sheet = parse_datasheet({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    try {
      const MotorIdentification motor = identify_motor(sheet);
      (void)text_identification(motor, sheet);
      (void)json_identification(motor, sheet);
    } catch (const ParameterError&) {}
  });
}
