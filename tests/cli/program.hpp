// Runs the built program and keeps what it says.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>

extern char** environ;

namespace cli {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

inline const std::string data = WINGBEAT_DATA;
inline const std::string plain = data + "/designs/friction2022.toml";
inline const std::string springs = data + "/designs/friction2022-springs.toml";

inline std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

struct Outcome {
  int status = -1;
  std::string out, err;
  Json json() const { return Json::parse(out); }
};

/// A folder of its own for each test, removed afterwards.
class Program : public testing::Test {
 protected:
  Program() {
    std::string pattern = testing::TempDir() + "wingbeat-cli-XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
  }
  ~Program() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// `search_path` replaces PATH; `output` replaces the file that standard output goes to.
  Outcome run(std::vector<std::string> arguments, const std::string& search_path = "",
              const std::string& output = "") const {
    const std::string out = output.empty() ? path("stdout.txt") : output, err = path("stderr.txt");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    arguments.insert(arguments.begin(), WINGBEAT_PROGRAM);
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    std::string path_entry = "PATH=" + search_path;
    char* const bare[] = {path_entry.data(), nullptr};
    pid_t child = 0;
    const int failure =
        ::posix_spawn(&child, WINGBEAT_PROGRAM, &actions, nullptr, argv.data(), search_path.empty() ? environ : bare);
    posix_spawn_file_actions_destroy(&actions);
    Outcome outcome;
    if (failure != 0) return outcome;
    int status = 0;
    ::waitpid(child, &status, 0);
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.out = output.empty() ? read(out) : "";
    outcome.err = read(err);
    return outcome;
  }

  /// Everything in the folder but what run() itself put there.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      if (name != "stdout.txt" && name != "stderr.txt") names.push_back(name);
    }
    return names;
  }

 private:
  fs::path folder_;
};

inline std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t position = text.find(part); position != std::string::npos;
       position = text.find(part, position + part.size()))
    ++n;
  return n;
}

}  // namespace cli
