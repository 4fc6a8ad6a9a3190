// "STUDY \0 VEHICLE \0 TABLE" as a sweep's study, its vehicle and its CSV of designs.
#include "files.hpp"
#include "wingbeat/files/study_file.hpp"

using namespace wingbeat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto parts = fuzz::parts_of(data, size, 3);
  for (const char* vehicle : {"friction2022-springs.toml", "direct-drive.toml"}) {
    fuzz::put(std::filesystem::path("designs") / vehicle, parts[1]);
  }
  fuzz::put("studies/designs.csv", parts[2]);
  const auto file = fuzz::put("studies/study.toml", parts[0]);
  return fuzz::reads_or_refuses([&] {
    const Study study = read_study(file);
    if (study.sweep.size() == 0) std::abort();
    for (const std::uint64_t index : {std::uint64_t(0), study.sweep.size() / 2, study.sweep.size() - 1}) {
      (void)design_at(study.sweep, index);
    }
    // A data set keeps these texts, from which it must be possible to run the sweep again.
    if (parse_study(study.input).sweep.size() != study.sweep.size()) std::abort();
  });
}
