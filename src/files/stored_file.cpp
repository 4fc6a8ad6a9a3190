#include "wingbeat/files/stored_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "wingbeat/core/text.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace wingbeat {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const fs::path& file, const std::string& shown, int reason) {
  throw std::runtime_error(
      fmt::format("{}: cannot be written: {}", shown.empty() ? file.string() : shown, std::strerror(reason)));
}

bool ends_with_element(std::string_view content, std::string_view element) {
  return detail::trimmed(content).ends_with(element);
}

/// A MAT-file of version 5 is a header and elements, each a type, a length and as many bytes.
bool is_whole_mat(std::string_view content) {
  constexpr std::size_t header = 128, tag = 8;
  if (content.size() < header) return false;
  std::size_t position = header;
  while (position + tag <= content.size()) {
    std::uint32_t length = 0;
    std::memcpy(&length, content.data() + position + 4, sizeof length);
    position += tag + length;
  }
  return position == content.size();
}

bool is_whole_netcdf(const fs::path& file) {
  try {
    const NetcdfReader data(file);  // the superblock says where the file ends
    return true;
  } catch (const NetcdfError&) {
    return false;
  }
}

}  // namespace

void store(const fs::path& file, std::string_view content, const std::string& shown) {
  const int to = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (to < 0) fail(file, shown, errno);
  while (!content.empty()) {
    const ssize_t written = ::write(to, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int reason = errno;
      ::close(to);
      fail(file, shown, reason);
    }
    content.remove_prefix(std::size_t(written));
  }
  if (::close(to) != 0) fail(file, shown, errno);
}

void settle(const fs::path& file, const std::string& shown) {
  const int written = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (written < 0) fail(file, shown, errno);
  const int reason = ::fdatasync(written) == 0 ? 0 : errno;
  ::close(written);
  // File systems without it.
  if (reason != 0 && reason != EINVAL && reason != ENOSYS && reason != EROFS) fail(file, shown, reason);
}

std::optional<std::string> missing_end(std::string_view content, std::string_view extension) {
  using namespace std::string_view_literals;
  constexpr std::string_view png_begin = "\x89PNG\r\n\x1a\n"sv, png_end = "\0\0\0\0IEND\xAE\x42\x60\x82"sv;
  if (extension == ".svg") {
    if (content.find("<svg") == content.npos || !ends_with_element(content, "</svg>")) return "its end, </svg>";
  } else if (extension == ".pdf") {
    // What is added behind the end is a comment.
    if (!content.starts_with("%PDF-") || content.rfind("%%EOF") == content.npos ||
        content.rfind("%%EOF") < content.rfind("startxref")) {
      return "its end, %%EOF";
    }
  } else if (extension == ".png") {
    if (!content.starts_with(png_begin) || !content.ends_with(png_end)) return "its end, the chunk IEND";
  } else if (extension == ".html") {
    if (!ends_with_element(content, "</html>")) return "its end, </html>";
  } else if (extension == ".mat") {
    if (!is_whole_mat(content)) return "the end of its last element";
  } else if (extension == ".fmu") {
    // The record at the end of an archive without a comment.
    constexpr std::size_t record = 22;
    if (content.size() < record || content.substr(content.size() - record, 4) != "PK\5\6"sv) {
      return "its end, the list of files";
    }
  }
  return std::nullopt;
}

std::optional<std::string> missing_end(const fs::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".nc") return is_whole_netcdf(file) ? std::nullopt : std::optional<std::string>("its end");
  const std::string_view marked[] = {".svg", ".pdf", ".png", ".html", ".mat", ".fmu"};
  if (std::find(std::begin(marked), std::end(marked), extension) == std::end(marked)) return std::nullopt;
  std::ifstream in(file, std::ios::binary);
  return missing_end(std::string{std::istreambuf_iterator<char>(in), {}}, extension);
}

}  // namespace wingbeat
