#include "wingbeat/files/zip_file.hpp"

#include <zip.h>

#include <memory>
#include <stdexcept>

#include "wingbeat/files/stored_file.hpp"

namespace wingbeat {

void write_zip(const std::filesystem::path& file, const std::vector<std::pair<std::string, std::string>>& content) {
  // Made in memory: libzip itself would write beside the file under a name of its own.
  zip_error_t error;
  zip_error_init(&error);
  const auto fail = [&](zip_error_t* why) {
    throw std::runtime_error(file.string() + ": the archive cannot be made: " + zip_error_strerror(why));
  };
  const std::unique_ptr<zip_source_t, void (*)(zip_source_t*)> buffer(zip_source_buffer_create(nullptr, 0, 0, &error),
                                                                      zip_source_free);
  if (!buffer) fail(&error);
  zip_source_keep(buffer.get());
  std::unique_ptr<zip_t, void (*)(zip_t*)> archive(zip_open_from_source(buffer.get(), ZIP_TRUNCATE, &error),
                                                   zip_discard);
  if (!archive) {
    zip_source_free(buffer.get());
    fail(&error);
  }
  for (const auto& [name, bytes] : content) {
    zip_source_t* const source = zip_source_buffer(archive.get(), bytes.data(), bytes.size(), 0);
    const zip_int64_t place = source ? zip_file_add(archive.get(), name.c_str(), source, ZIP_FL_ENC_UTF_8) : -1;
    if (place < 0) {
      if (source) zip_source_free(source);
      fail(zip_get_error(archive.get()));
    }
    // 1 January 1980, the first day that a ZIP knows.
    if (zip_file_set_dostime(archive.get(), zip_uint64_t(place), 0, 0x21, 0) != 0) fail(zip_get_error(archive.get()));
  }
  if (zip_close(archive.get()) != 0) fail(zip_get_error(archive.get()));
  (void)archive.release();
  zip_stat_t about;
  zip_error_t* const why = zip_source_error(buffer.get());
  if (zip_source_stat(buffer.get(), &about) != 0 || zip_source_open(buffer.get()) != 0) fail(why);
  std::string bytes(std::size_t(about.size), '\0');
  const zip_int64_t got = zip_source_read(buffer.get(), bytes.data(), bytes.size());
  zip_source_close(buffer.get());
  if (got != zip_int64_t(bytes.size())) fail(why);
  store(file, bytes);
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
