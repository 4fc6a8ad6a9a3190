#include "report/figure.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "wingbeat/core/text.hpp"
#include "wingbeat/files/stored_file.hpp"

extern char** environ;

namespace wingbeat {
namespace {

/// What gnuplot sees of the environment: where programs, libraries and fonts are. Everything else - GNUTERM,
/// GNUPLOT_*, GDFONTPATH, FIT_*, a locale, a display - could change what a drawing looks like or whether there is one.
std::vector<char*> environment_of_gnuplot() {
  constexpr std::string_view kept[] = {"PATH=",
                                       "HOME=",
                                       "TMPDIR=",
                                       "LD_LIBRARY_PATH=",
                                       "FONTCONFIG_FILE=",
                                       "FONTCONFIG_PATH=",
                                       "XDG_CACHE_HOME=",
                                       "XDG_CONFIG_HOME=",
                                       "XDG_DATA_HOME=",
                                       "XDG_DATA_DIRS="};
  std::vector<char*> variables;
  for (char** variable = environ; variable && *variable; ++variable) {
    const std::string_view text(*variable);
    if (std::any_of(std::begin(kept), std::end(kept), [&](auto name) { return text.starts_with(name); })) {
      variables.push_back(*variable);
    }
  }
  variables.push_back(nullptr);
  return variables;
}

/// A pipe, closed at both ends; the other process gets neither end but as one of its standard streams.
class Pipe {
 public:
  Pipe() {
    bool made = ::pipe2(ends_.data(), O_CLOEXEC) == 0;
    // Beyond the standard streams, which the caller may have closed: one end must not take the place of another.
    for (int& end : ends_) {
      if (!made || end > STDERR_FILENO) continue;
      const int moved = ::fcntl(end, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
      made = moved >= 0;
      ::close(std::exchange(end, moved));
    }
    if (!made) throw std::runtime_error(fmt::format("cannot start gnuplot: {}", std::strerror(errno)));
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close(0);
    close(1);
  }
  int end(std::size_t k) const { return ends_[k]; }
  void close(std::size_t k) {
    if (ends_[k] >= 0) ::close(ends_[k]);
    ends_[k] = -1;
  }

 private:
  std::array<int, 2> ends_ = {-1, -1};
};

/// Takes what there is to read; false at the end.
bool take(int from, std::string& to) {
  std::array<char, 65536> bytes;
  const ssize_t n = ::read(from, bytes.data(), bytes.size());
  if (n < 0) return errno == EINTR || errno == EAGAIN;
  to.append(bytes.data(), std::size_t(n));
  return n > 0;
}

/// Feeds `script` to one pipe while the others are read, until both of those have ended.
void converse(const std::string& script, Pipe& input, Pipe& output, std::string& drawn, Pipe& errors,
              std::string& said) {
  ::fcntl(input.end(1), F_SETFL, O_NONBLOCK);
  std::string_view rest = script;
  if (rest.empty()) input.close(1);
  while (output.end(0) >= 0 || errors.end(0) >= 0) {
    // poll() passes over ends that are closed.
    pollfd ends[] = {{input.end(1), POLLOUT, 0}, {output.end(0), POLLIN, 0}, {errors.end(0), POLLIN, 0}};
    if (::poll(ends, 3, -1) < 0) {
      if (errno == EINTR) continue;
      throw std::runtime_error(fmt::format("lost gnuplot: {}", std::strerror(errno)));
    }
    if (ends[0].revents != 0) {
      const ssize_t n = ::write(input.end(1), rest.data(), rest.size());
      if (n > 0) rest.remove_prefix(std::size_t(n));
      // One that has ended before its script did says why, or its drawing is incomplete.
      if (rest.empty() || (n < 0 && errno != EINTR && errno != EAGAIN)) input.close(1);
    }
    if (ends[1].revents != 0 && !take(output.end(0), drawn)) output.close(0);
    if (ends[2].revents != 0 && !take(errors.end(0), said)) errors.close(0);
  }
}

/// A process that ended before it had read everything must not end this one.
class WithoutPipeSignal {
 public:
  WithoutPipeSignal() {
    sigemptyset(&signal_);
    sigaddset(&signal_, SIGPIPE);
    sigset_t pending;
    sigpending(&pending);
    was_pending_ = sigismember(&pending, SIGPIPE) == 1;
    ::pthread_sigmask(SIG_BLOCK, &signal_, &before_);
  }
  WithoutPipeSignal(const WithoutPipeSignal&) = delete;
  WithoutPipeSignal& operator=(const WithoutPipeSignal&) = delete;
  ~WithoutPipeSignal() {
    const timespec none{};
    while (!was_pending_ && ::sigtimedwait(&signal_, nullptr, &none) > 0) {}
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  const sigset_t& before() const { return before_; }

 private:
  sigset_t signal_, before_;
  bool was_pending_ = false;
};

[[noreturn]] void throw_without_gnuplot() {
  throw std::runtime_error("plots need gnuplot, which is not installed; on Debian: apt-get install gnuplot-nox");
}

pid_t start_gnuplot(const Pipe& input, const Pipe& output, const Pipe& errors, const sigset_t& signals) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input.end(0), 0);
  posix_spawn_file_actions_adddup2(&actions, output.end(1), 1);
  posix_spawn_file_actions_adddup2(&actions, errors.end(1), 2);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  posix_spawnattr_setsigmask(&attributes, &signals);
  char program[] = "gnuplot", default_settings[] = "-d";
  char* const arguments[] = {program, default_settings, nullptr};
  std::vector<char*> environment = environment_of_gnuplot();
  pid_t child = 0;
  const int failure = ::posix_spawnp(&child, program, &actions, &attributes, arguments, environment.data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (failure == ENOENT) throw_without_gnuplot();
  if (failure != 0) throw std::runtime_error(fmt::format("cannot start gnuplot: {}", std::strerror(failure)));
  return child;
}

std::string_view extension_of(const std::string& script) {
  return script.find("set terminal svg") != std::string::npos   ? ".svg"
         : script.find("set terminal pdf") != std::string::npos ? ".pdf"
                                                                : ".png";
}

}  // namespace

void require_gnuplot() {
  const char* const path = std::getenv("PATH");
  if (!path) return;  // the system then has a list of its own
  std::string_view rest(path);
  while (true) {
    const auto end = rest.find(':');
    const std::string folder(rest.substr(0, end));
    if (::access((folder.empty() ? "gnuplot" : folder + "/gnuplot").c_str(), X_OK) == 0) return;
    if (end == std::string_view::npos) throw_without_gnuplot();
    rest.remove_prefix(end + 1);
  }
}

std::string drawing_of(const std::string& script) {
  const WithoutPipeSignal quiet;
  Pipe input, output, errors;
  const pid_t child = start_gnuplot(input, output, errors, quiet.before());
  input.close(0);
  output.close(1);
  errors.close(1);
  std::string drawn, said;
  converse(script, input, output, drawn, errors, said);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::runtime_error(fmt::format("lost gnuplot: {}", std::strerror(errno)));
  }
  // gnuplot answers many errors of a terminal with a message and exit status 0.
  const auto missing = missing_end(drawn, extension_of(script));
  if (status != 0 || missing) {
    constexpr std::size_t longest = 4000;
    said = detail::printable(detail::trimmed(std::string_view(said).substr(0, longest)));
    std::replace(said.begin(), said.end(), '\n', ' ');
    throw std::runtime_error(fmt::format("gnuplot failed: {}", !said.empty()   ? said
                                                               : drawn.empty() ? "it drew nothing"
                                                               : missing       ? "what it drew lacks " + *missing
                                                                               : "it ended with an error"));
  }
  return extension_of(script) == ".svg" ? style::tidied_svg(std::move(drawn)) : drawn;
}

void run_gnuplot(const std::string& script, const std::filesystem::path& output) { store(output, drawing_of(script)); }

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : detail::printable(text)) {
    if (c == '\'') out += "''";
    else out += c == '\n' || c == '\t' ? ' ' : c;
  }
  return out + "'";
}

}  // namespace wingbeat
