// What the targets share: an input divided into the files that a reader asks for, and how a reader may refuse them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "wingbeat/files/design_file.hpp"

namespace wingbeat::fuzz {

/// The parts of an input, which zero bytes divide, at most `count`; missing ones are empty.
inline std::vector<std::string> parts_of(const std::uint8_t* data, std::size_t size, std::size_t count) {
  std::vector<std::string> parts(1);
  for (std::size_t n = 0; n < size; ++n) {
    if (data[n] == 0 && parts.size() < count) {
      parts.emplace_back();
    } else {
      parts.back() += char(data[n]);
    }
  }
  parts.resize(count);
  return parts;
}

/// A folder of this process alone, in the place that TMPDIR names.
inline const std::filesystem::path& folder() {
  static const std::filesystem::path made = [] {
    std::string name = (std::filesystem::temp_directory_path() / "wingbeat-fuzz-XXXXXX").string();
    if (!::mkdtemp(name.data())) std::abort();
    static const struct Cleaner {
      std::filesystem::path path;
      ~Cleaner() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
      }
    } cleaner{name};
    return std::filesystem::path(name);
  }();
  return made;
}

/// Writes a file below folder(), whose subfolders are made at the first use.
inline std::filesystem::path put(const std::filesystem::path& name, const std::string& content) {
  const std::filesystem::path file = folder() / name;
  std::ofstream stream(file, std::ios::binary);
  if (!stream) {
    std::filesystem::create_directories(file.parent_path());
    stream.open(file, std::ios::binary);
  }
  stream.write(content.data(), std::streamsize(content.size()));
  stream.close();
  if (!stream) std::abort();
  return file;
}

/// Runs a reader: it may refuse its input by an InputError of at least one word, nothing else may escape.
template <class Read>
int reads_or_refuses(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    if (std::string(error.what()).empty()) std::abort();
  }
  return 0;
}

}  // namespace wingbeat::fuzz
