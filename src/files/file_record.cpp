#include "wingbeat/files/file_record.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "wingbeat/files/design_file.hpp"

namespace wingbeat {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void refuse(const std::string& option, const fs::path& path, const std::string& reason) {
  throw InputError(fmt::format("{} {}", option, path.string()), 0, 0, "", reason);
}

/// ".svg .pdf .png" as ".svg, .pdf or .png".
std::string listed(std::string_view extensions) {
  std::string text;
  while (!extensions.empty()) {
    const auto end = std::min(extensions.find(' '), extensions.size());
    const bool last = end == extensions.size();
    text += fmt::format("{}{}", text.empty() ? "" : last ? " or " : ", ", extensions.substr(0, end));
    extensions.remove_prefix(last ? end : end + 1);
  }
  return text;
}

bool ends_in(const fs::path& path, std::string_view extensions) {
  const std::string extension = path.extension().string();
  return !extension.empty() && fmt::format(" {} ", extensions).find(" " + extension + " ") != std::string::npos;
}

}  // namespace

FileRecord& FileRecord::of_this_program() {
  static FileRecord record;
  return record;
}

FileRecord::Entry FileRecord::entry_of(const fs::path& file, const std::string& shown) {
  std::error_code error;
  Entry entry{fs::weakly_canonical(fs::absolute(file, error), error), shown, {}};
  struct stat found{};
  if (::stat(file.c_str(), &found) == 0) entry.identity.emplace(found.st_dev, found.st_ino);
  return entry;
}

const FileRecord::Entry* FileRecord::find(const std::vector<Entry>& entries, const Entry& wanted) {
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) {
    return e.path == wanted.path || (e.identity && e.identity == wanted.identity);
  });
  return found == entries.end() ? nullptr : &*found;
}

void FileRecord::add_read(const fs::path& file) {
  struct stat found{};
  if (::stat(file.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) return;
  const Entry entry = entry_of(file, file.string());
  const std::lock_guard lock(mutex_);
  if (!find(read_, entry)) read_.push_back(entry);
}

std::optional<std::string> FileRecord::name_read(const fs::path& path) const {
  const Entry wanted = entry_of(path, "");
  const std::lock_guard lock(mutex_);
  const Entry* found = find(read_, wanted);
  return found ? std::optional(found->shown) : std::nullopt;
}

std::optional<std::string> FileRecord::add_output(const fs::path& target, const std::string& option) {
  const Entry wanted = entry_of(target, option);
  const std::lock_guard lock(mutex_);
  if (const Entry* found = find(outputs_, wanted)) return found->shown;
  outputs_.push_back(wanted);
  return std::nullopt;
}

void FileRecord::written(const fs::path& target) {
  const std::lock_guard lock(mutex_);
  // The inode that was there may be given to another file.
  for (Entry& e : outputs_) {
    if (e.path == target) e.identity.reset();
  }
}

void FileRecord::withdraw(const fs::path& target) {
  const std::lock_guard lock(mutex_);
  std::erase_if(outputs_, [&](const Entry& e) { return e.path == target; });
}

void FileRecord::add_temporary(const fs::path& temporary, const std::string& shown) {
  const std::lock_guard lock(mutex_);
  temporaries_.emplace_back(temporary.string(), shown);
}

std::string FileRecord::with_given_names(std::string message) const {
  const std::lock_guard lock(mutex_);
  for (const auto& [name, shown] : temporaries_) {
    if (const auto position = message.find(name); position != std::string::npos)
      message.replace(position, name.size(), shown);
  }
  return message;
}

void FileRecord::clear() {
  const std::lock_guard lock(mutex_);
  temporaries_.clear();
  read_.clear();
  outputs_.clear();
}

fs::path followed(const std::string& option, const fs::path& path) {
  std::error_code error;
  fs::path target = fs::absolute(path, error);
  constexpr int max_links = 40;
  for (int links = 0; fs::is_symlink(fs::symlink_status(target, error)); ++links) {
    if (links == max_links) refuse(option, path, "cannot be written: its symbolic links lead round in a circle");
    const fs::path next = fs::read_symlink(target, error);
    if (error) refuse(option, path, "cannot be written: " + error.message());
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  const fs::path folder = target.parent_path();
  const fs::path real = fs::weakly_canonical(folder, error);
  if (error) refuse(option, path, "cannot be written: " + error.message());
  if (!fs::is_directory(real, error)) refuse(option, path, fmt::format("there is no folder {}", real.string()));
  return real / target.filename();
}

void check_not_read(const std::string& option, const fs::path& path, const fs::path& target) {
  const auto name = FileRecord::of_this_program().name_read(target);
  if (!name) return;
  refuse(option, path,
         *name == path.string()
             ? "is a file that this command reads, which is never overwritten; give another name"
             : fmt::format("is the file {}, which this command reads and never overwrites; give another name", *name));
}

fs::path checked_output(const std::string& option, const fs::path& path, const OutputRules& rules) {
  if (!rules.extensions.empty() && !ends_in(path, rules.extensions)) {
    refuse(option, path, fmt::format("the name must end in {}", listed(rules.extensions)));
  }
  const fs::path target = followed(option, path);
  check_not_read(option, path, target);
  struct stat existing{};
  if (::stat(target.c_str(), &existing) != 0) return target;
  if (S_ISDIR(existing.st_mode)) refuse(option, path, "cannot be written: it is a folder");
  if (!S_ISREG(existing.st_mode)) refuse(option, path, "cannot be written: it is not a regular file");
  if (::access(target.c_str(), W_OK) != 0) {
    refuse(option, path, fmt::format("cannot be written: {}", std::strerror(errno)));
  }
  if (!rules.force && !written_by_wingbeat(target)) {
    refuse(option, path, "exists and was not written by wingbeat; give another name, or --force to replace it");
  }
  return target;
}

}  // namespace wingbeat
