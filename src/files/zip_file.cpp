#include "wingbeat/files/zip_file.hpp"

#include <zip.h>

#include <memory>
#include <stdexcept>

namespace wingbeat {

void write_zip(const std::filesystem::path& file, const std::vector<std::pair<std::string, std::string>>& content) {
  const auto fail = [&](const std::string& reason) {
    throw std::runtime_error(file.string() + ": the archive cannot be written: " + reason);
  };
  int code = 0;
  zip_t* const archive = zip_open(file.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  if (!archive) fail("libzip error " + std::to_string(code));
  for (const auto& [name, bytes] : content) {
    zip_source_t* const source = zip_source_buffer(archive, bytes.data(), bytes.size(), 0);
    const zip_int64_t place = source ? zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8) : -1;
    if (place < 0) {
      const std::string reason = zip_strerror(archive);
      if (source) zip_source_free(source);
      zip_discard(archive);
      fail(reason);
    }
    zip_file_set_dostime(archive, zip_uint64_t(place), 0, 0x21, 0);  // 1 January 1980, the first that a ZIP knows
  }
  if (zip_close(archive) != 0) {
    const std::string reason = zip_strerror(archive);
    zip_discard(archive);
    fail(reason);
  }
}

std::vector<std::pair<std::string, std::string>> read_zip(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& reason) {
    throw std::runtime_error(file.string() + ": the archive cannot be read: " + reason);
  };
  int code = 0;
  const std::unique_ptr<zip_t, void (*)(zip_t*)> archive(zip_open(file.c_str(), ZIP_RDONLY, &code), zip_discard);
  if (!archive) fail("libzip error " + std::to_string(code));
  std::vector<std::pair<std::string, std::string>> content;
  const zip_int64_t count = zip_get_num_entries(archive.get(), 0);
  for (zip_int64_t k = 0; k < count; ++k) {
    zip_stat_t about;
    if (zip_stat_index(archive.get(), zip_uint64_t(k), 0, &about) != 0) fail(zip_strerror(archive.get()));
    const std::string name = about.name;
    if (name.empty() || name.back() == '/') continue;
    const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> from(zip_fopen_index(archive.get(), zip_uint64_t(k), 0),
                                                                 zip_fclose);
    std::string bytes(std::size_t(about.size), '\0');
    if (!from || zip_fread(from.get(), bytes.data(), bytes.size()) != zip_int64_t(bytes.size())) {
      fail(zip_strerror(archive.get()));
    }
    content.emplace_back(name, std::move(bytes));
  }
  return content;
}

}  // namespace wingbeat
