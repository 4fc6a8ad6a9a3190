#include "report/figure.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

extern char** environ;

namespace wingbeat {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

File temporary_file() {
  File file(std::tmpfile());
  if (!file) throw std::runtime_error(fmt::format("cannot make a temporary file: {}", std::strerror(errno)));
  return file;
}

std::string content(std::FILE* file) {
  std::rewind(file);
  std::string text(4000, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), file));
  return text;
}

}  // namespace

void run_gnuplot(const std::string& script, const std::filesystem::path& output) {
  const File input = temporary_file();
  const File errors = temporary_file();
  if (std::fwrite(script.data(), 1, script.size(), input.get()) != script.size() || std::fflush(input.get()) != 0) {
    throw std::runtime_error(fmt::format("cannot write a temporary file: {}", std::strerror(errno)));
  }
  std::rewind(input.get());
  const File drawing(std::fopen(output.c_str(), "we"));
  if (!drawing) throw std::runtime_error(fmt::format("{}: {}", output.string(), std::strerror(errno)));

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(input.get()), 0);
  posix_spawn_file_actions_adddup2(&actions, fileno(drawing.get()), 1);
  posix_spawn_file_actions_adddup2(&actions, fileno(errors.get()), 2);
  char program[] = "gnuplot", default_settings[] = "-d";
  char* const arguments[] = {program, default_settings, nullptr};
  pid_t child = 0;
  const int failure = ::posix_spawnp(&child, program, &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure == ENOENT) {
    throw std::runtime_error("plots need gnuplot, which is not installed; on Debian: apt-get install gnuplot-nox");
  }
  if (failure != 0) throw std::runtime_error(fmt::format("cannot start gnuplot: {}", std::strerror(failure)));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::runtime_error(fmt::format("lost gnuplot: {}", std::strerror(errno)));
  }
  std::string said = content(errors.get());
  std::replace_if(said.begin(), said.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  const auto drawn = std::filesystem::file_size(output);
  // gnuplot answers many errors of a terminal with a message and exit status 0.
  if (status != 0 || drawn < 200) {
    throw std::runtime_error(fmt::format("gnuplot failed: {}", said.empty() ? "it drew nothing" : said));
  }
  if (script.find("set terminal svg") != std::string::npos) style::tidy_svg(output);
}

void Figure::remarks(const std::string& all, double height) {
  constexpr std::size_t longest = 60;
  std::size_t split = std::string::npos;
  if (all.size() > longest) {
    split = all.rfind("; ", longest);
    if (split == std::string::npos) split = all.find("; ");
  }
  const bool two = split != std::string::npos;
  text(all.substr(0, split), style::text_size, fmt::format("screen 0.97,{} right", (two ? 0.19 : 0.075) / height));
  if (two) text(all.substr(split + 2), style::text_size, fmt::format("screen 0.97,{} right", 0.075 / height));
}

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += "''";
    else out += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? ' ' : c;
  }
  return out + "'";
}

}  // namespace wingbeat
