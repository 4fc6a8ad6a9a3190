// A sweep's data set that is read again: "STUDY \0 VEHICLE \0 TABLE \0 NAME \0 EDITS" as the texts that it keeps and
// damage to the file, four bytes each: where in three bytes, the new byte.
#include "files.hpp"
#include "wingbeat/files/netcdf.hpp"
#include "wingbeat/files/sweep_data_set.hpp"

using namespace wingbeat;

namespace {

std::filesystem::path made_of(const std::vector<std::string>& parts) {
  const std::filesystem::path path = fuzz::folder() / "sweep.nc";
  try {
    const Study study = parse_study({.study_name = parts[3],
                                     .study = parts[0],
                                     .vehicle = parts[1],
                                     .table_name = "designs.csv",
                                     .table = parts[2]});
    if (study.sweep.size() < 10000) {
      (void)prepare_data_set(path, study, "0");
      return path;
    }
  } catch (const InputError&) {}
  NetcdfFile file(path);
  file.set_attribute("study", parts[0]);
  file.set_attribute("vehicle", parts[1]);
  if (!parts[2].empty()) {
    const std::string texts[] = {parts[2]};
    file.define_texts("samples_file", file.define_dimension("samples_file_count", 1), texts, "designs");
    file.set_attribute("samples_name", "designs.csv");
  }
  file.set_attribute("study_name", parts[3]);
  file.close();
  return path;
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void damage(const std::filesystem::path& file, const std::string& edits) {
  if (edits.size() < 4) return;
  std::string content = content_of(file);
  const auto byte = [&](std::size_t n) { return std::size_t(static_cast<unsigned char>(edits[n])); };
  for (std::size_t n = 0; n + 4 <= edits.size(); n += 4) {
    content[(byte(n) + 256 * byte(n + 1) + 65536 * byte(n + 2)) % content.size()] = edits[n + 3];
  }
  std::ofstream(file, std::ios::binary) << content;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto parts = fuzz::parts_of(data, size, 5);
  std::filesystem::path file;
  try {
    file = made_of(parts);
    damage(file, parts[4]);
    return fuzz::reads_or_refuses([&] {
      const Study study = read_study_in_data_set(file);
      (void)standing_of(file, fingerprint(study, "0"), "-o", false);
      (void)digest_of(file, study);
    });
  } catch (const NetcdfError&) {
    return 0;
  }
}
