#include "wingbeat/io/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "wingbeat/io/design_file.hpp"
#include "wingbeat/io/written_files.hpp"

namespace wingbeat {
namespace fs = std::filesystem;

OutputFile::OutputFile(std::string option, const fs::path& path)
    : option_(fmt::format("{} {}", option, path.string())) {
  const auto refuse = [&](const std::string& reason) { throw InputError(option_, 0, 0, "", reason); };
  std::error_code error;
  // A symbolic link keeps pointing where it did: the file behind it is replaced.
  target_ = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error) refuse("cannot be written: " + error.message());
  const fs::path folder = target_.parent_path();
  if (!fs::is_directory(folder, error)) refuse(fmt::format("there is no folder {}", folder.string()));

  mode_t mode = 0666;
  struct stat existing {};
  const bool exists = ::stat(target_.c_str(), &existing) == 0;
  if (exists) {
    if (S_ISDIR(existing.st_mode)) refuse("cannot be written: it is a folder");
    if (!S_ISREG(existing.st_mode)) refuse("cannot be written: it is not a regular file");
    if (::access(target_.c_str(), W_OK) != 0) refuse(fmt::format("cannot be written: {}", std::strerror(errno)));
    mode = existing.st_mode & 07777;
  }
  int file = -1;
  for (int attempt = 0; file < 0; ++attempt) {
    // The extension stays: some writers choose the format by it.
    temporary_ = folder / fmt::format(".{}-{}.part{}", ::getpid(), attempt, target_.extension().string());
    file = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (file < 0 && (errno != EEXIST || attempt > 1000)) {
      refuse(fmt::format("cannot be written: {}", std::strerror(errno)));
    }
  }
  if (exists) (void)::fchmod(file, mode);
  ::close(file);
}

OutputFile::~OutputFile() {
  if (!committed_) ::unlink(temporary_.c_str());
}

void OutputFile::write(std::string_view content) {
  const auto failed = [&] { throw std::runtime_error(fmt::format("{}: {}", option_, std::strerror(errno))); };
  const int file = ::open(temporary_.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
  if (file < 0) failed();
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      const int reason = errno;
      ::close(file);
      errno = reason;
      failed();
    }
    content.remove_prefix(std::size_t(written));
  }
  if (::close(file) != 0) failed();
}

void OutputFile::commit() {
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    throw std::runtime_error(fmt::format("{}: {}", option_, std::strerror(errno)));
  }
  committed_ = true;
  note_written(option_.substr(option_.find(' ') + 1));
}

}  // namespace wingbeat
