// Which files under way belong to processes that are gone.
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <boost/crc.hpp>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <fstream>
#include <iterator>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

#include "wingbeat/files/temporary_files.hpp"

namespace wingbeat {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view beginning = ".wingbeat-";
constexpr std::chrono::hours unknown_after(24);

struct Owner {
  std::string system;
  long process = 0;
  std::string start;  ///< in clock ticks since the system's start
};

/// What distinguishes this boot of this machine, and the container, from others that see the same folder.
std::string this_system() {
  std::ifstream in("/proc/sys/kernel/random/boot_id");
  std::string id;
  std::getline(in, id);
  std::error_code error;
  id += fs::read_symlink("/proc/self/ns/pid", error).string();
  boost::crc_32_type sum;
  sum.process_bytes(id.data(), id.size());
  return fmt::format("{:08x}", sum.checksum());
}

struct ProcessState {
  char state = 'X';
  std::string start;
};

/// Nothing where the system does not show it.
std::optional<ProcessState> state_of(const std::string& process) {
  std::ifstream in("/proc/" + process + "/stat");
  const std::string all{std::istreambuf_iterator<char>(in), {}};
  // The name of the program stands in brackets and may hold anything.
  const auto bracket = all.rfind(')');
  if (bracket == std::string::npos || bracket + 2 >= all.size()) return std::nullopt;
  ProcessState found{all[bracket + 2], {}};
  std::size_t position = bracket + 2;
  for (int field = 3; field < 22 && position != std::string::npos; ++field) position = all.find(' ', position + 1);
  if (position == std::string::npos) return std::nullopt;
  found.start = all.substr(position + 1, all.find(' ', position + 1) - position - 1);
  return found;
}

const Owner& this_process() {
  static const Owner owner = [] {
    const auto state = state_of("self");
    return Owner{this_system(), 0, state ? state->start : "0"};
  }();
  return owner;
}

/// Of ".wingbeat-SYSTEM-PROCESS-START-NUMBER.part.svg".
std::optional<Owner> owner_of(std::string_view name) {
  if (!name.starts_with(beginning)) return std::nullopt;
  name.remove_prefix(beginning.size());
  const auto digits = [&](std::string_view allowed) {
    const auto end = std::min(name.find_first_not_of(allowed), name.size());
    const std::string text(name.substr(0, end));
    name.remove_prefix(end);
    return text;
  };
  const auto dash = [&] {
    if (!name.starts_with('-')) return false;
    name.remove_prefix(1);
    return true;
  };
  constexpr std::string_view decimal = "0123456789";
  Owner owner;
  owner.system = digits("0123456789abcdef");
  if (owner.system.size() != 8 || !dash()) return std::nullopt;
  const std::string process = digits(decimal);
  const auto read = std::from_chars(process.data(), process.data() + process.size(), owner.process);
  if (read.ec != std::errc{} || owner.process <= 0 || !dash()) return std::nullopt;
  owner.start = digits(decimal);
  if (owner.start.empty() || !dash() || digits(decimal).empty() || !name.starts_with(".part")) return std::nullopt;
  return owner;
}

bool is_gone(const Owner& owner) {
  if (::kill(pid_t(owner.process), 0) != 0 && errno == ESRCH) return true;
  const auto state = state_of(std::to_string(owner.process));
  return state && (state->start != owner.start || state->state == 'Z' || state->state == 'X');
}

}  // namespace

std::string temporary_name(int number, const std::string& extension) {
  const Owner& owner = this_process();
  return fmt::format("{}{}-{}-{}-{}.part{}", beginning, owner.system, ::getpid(), owner.start, number, extension);
}

void remove_leftovers(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> seen;
  {
    const std::lock_guard lock(mutex);
    if (!seen.insert(folder).second) return;
  }
  std::error_code error, ignored;
  const auto now = fs::file_time_type::clock::now();
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const auto owner = owner_of(entry->path().filename().string());
    if (!owner || !entry->is_regular_file(ignored)) continue;
    bool gone = false;
    if (owner->system == this_process().system) {
      gone = is_gone(*owner);
    } else {
      const auto last = fs::last_write_time(entry->path(), ignored);
      gone = !ignored && now - last > unknown_after;
    }
    if (gone) fs::remove(entry->path(), ignored);
  }
}

}  // namespace wingbeat
