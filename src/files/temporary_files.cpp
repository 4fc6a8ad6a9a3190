#include "wingbeat/files/temporary_files.hpp"

#include <climits>
#include <csignal>
#include <cstring>
#include <mutex>

#include <atomic>

#include <unistd.h>

namespace wingbeat {

/// Never freed, so that a signal handler may walk the list at any time.
struct TemporaryFile {
  std::atomic<bool> there = false;
  char path[PATH_MAX] = {};
  TemporaryFile* next = nullptr;
};

namespace {

std::atomic<TemporaryFile*> first = nullptr;
std::mutex entering;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<TemporaryFile*>::is_always_lock_free);

extern "C" void end_on_signal(int signal) { remove_temporaries_and_end(signal); }

}  // namespace

TemporaryFile* remember_temporary(const std::filesystem::path& file) {
  const std::string name = file.string();
  if (name.size() >= PATH_MAX) return nullptr;
  const std::lock_guard lock(entering);
  TemporaryFile* place = first;
  while (place && place->there) place = place->next;
  if (!place) {
    place = new TemporaryFile;
    place->next = first;
    first = place;
  }
  std::memcpy(place->path, name.c_str(), name.size() + 1);
  place->there = true;
  return place;
}

void forget_temporary(TemporaryFile* file) {
  if (file) file->there = false;
}

void remove_temporaries_and_end(int signal) {
  for (const TemporaryFile* file = first; file; file = file->next) {
    if (file->there) ::unlink(file->path);
  }
  std::signal(signal, SIG_DFL);
  sigset_t unblocked;
  sigemptyset(&unblocked);
  sigaddset(&unblocked, signal);
  ::sigprocmask(SIG_UNBLOCK, &unblocked, nullptr);
  ::raise(signal);
  ::_exit(128 + signal);
}

void remove_temporaries_on_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction now{};
    if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler == SIG_IGN) continue;
    struct sigaction action{};
    action.sa_handler = end_on_signal;
    ::sigaction(signal, &action, nullptr);
  }
}

}  // namespace wingbeat
