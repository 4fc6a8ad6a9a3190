#include "wingbeat/files/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/written_files.hpp"

namespace wingbeat {
namespace fs = std::filesystem;

OutputFile::OutputFile(std::string option, const fs::path& path, const OutputRules& rules)
    : option_(fmt::format("{} {}", option, path.string())), target_(checked_output(option, path, rules)) {
  const auto refuse = [&](const std::string& reason) { throw InputError(option_, 0, 0, "", reason); };
  if (const auto other = FileRecord::of_this_program().add_output(target_, option)) {
    refuse(fmt::format("is also the file of {}; give another name", *other));
  }
  mode_t mode = 0666;
  struct stat existing{};
  const bool exists = ::stat(target_.c_str(), &existing) == 0;
  if (exists) mode = existing.st_mode & 07777;
  int file = -1;
  for (int attempt = 0; file < 0; ++attempt) {
    // The extension stays: some writers choose the format by it.
    temporary_ =
        target_.parent_path() / fmt::format(".{}-{}.part{}", ::getpid(), attempt, target_.extension().string());
    file = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (file < 0 && (errno != EEXIST || attempt > 1000)) {
      const int reason = errno;
      FileRecord::of_this_program().withdraw(target_);
      refuse(fmt::format("cannot be written: {}", std::strerror(reason)));
    }
  }
  remembered_ = remember_temporary(temporary_);
  FileRecord::of_this_program().add_temporary(temporary_, option_);
  if (exists) (void)::fchmod(file, mode);
  ::close(file);
}

OutputFile::~OutputFile() {
  if (committed_) return;
  ::unlink(temporary_.c_str());
  forget_temporary(remembered_);
  FileRecord::of_this_program().withdraw(target_);
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
  FileRecord& record = FileRecord::of_this_program();
  // Read since the place was reserved.
  if (record.name_read(target_)) throw std::runtime_error(option_ + ": is a file that this command has read");
  mark_drawing(temporary_);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    throw std::runtime_error(fmt::format("{}: {}", option_, std::strerror(errno)));
  }
  committed_ = true;
  forget_temporary(remembered_);
  record.written(target_);
  note_written(option_.substr(option_.find(' ') + 1));
}

}  // namespace wingbeat
