#include "wingbeat/files/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/stored_file.hpp"
#include "wingbeat/files/written_files.hpp"

namespace wingbeat {
namespace fs = std::filesystem;

OutputFile::OutputFile(std::string option, const fs::path& path, const OutputRules& rules)
    : option_(fmt::format("{} {}", option, path.string())), target_(checked_output(option, path, rules)) {
  const auto refuse = [&](const std::string& reason) { throw InputError(option_, 0, 0, "", reason); };
  if (const auto other = FileRecord::of_this_program().add_output(target_, option)) {
    refuse(fmt::format("is also the file of {}; give another name", *other));
  }
  struct stat existing{};
  if (::stat(target_.c_str(), &existing) == 0) mode_ = existing.st_mode & 07777;
  const fs::path folder = target_.parent_path();
  remove_leftovers(folder);
  // No name comes twice: in messages each stands for one output (FileRecord::with_given_names).
  static std::atomic<int> number = 0;
  int file = -1;
  for (int attempt = 0;; ++attempt) {
    // The extension stays: some writers choose the format by it.
    temporary_ = folder / temporary_name(number++, target_.extension().string());
    // Before it is there: a signal between the two would leave it.
    remembered_ = remember_temporary(temporary_);
    file = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode_.value_or(0666));
    if (file >= 0) break;
    const int reason = errno;
    forget_temporary(remembered_);
    if (reason != EEXIST || attempt > 1000) {
      FileRecord::of_this_program().withdraw(target_);
      refuse(fmt::format("cannot be written: {}", std::strerror(reason)));
    }
  }
  FileRecord::of_this_program().add_temporary(temporary_, option_);
  ::close(file);
}

OutputFile::~OutputFile() {
  if (committed_) return;
  ::unlink(temporary_.c_str());
  forget_temporary(remembered_);
  FileRecord::of_this_program().withdraw(target_);
}

void OutputFile::write(std::string_view content) {
  expected_ = content.size();
  store(temporary_, content, option_);
}

void OutputFile::commit() {
  FileRecord& record = FileRecord::of_this_program();
  const auto fail = [&](const std::string& reason) {
    throw std::runtime_error(fmt::format("{}: {}", option_, reason));
  };
  // Read since the place was reserved.
  if (record.name_read(target_)) fail("is a file that this command has read");
  std::error_code error;
  const std::uintmax_t size = fs::file_size(temporary_, error);
  if (error) fail("cannot be written: " + error.message());
  if (expected_ && size != *expected_) fail(fmt::format("{} of {} bytes were written", size, *expected_));
  if (const auto missing = missing_end(temporary_))
    fail(fmt::format("cannot be written whole: {} is missing", *missing));
  mark_drawing(temporary_, option_);
  if (mode_) (void)::chmod(temporary_.c_str(), *mode_);
  settle(temporary_, option_);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(std::strerror(errno));
  committed_ = true;
  forget_temporary(remembered_);
  record.written(target_);
  note_written(option_.substr(option_.find(' ') + 1));
}

}  // namespace wingbeat
