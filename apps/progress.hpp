// The line on a terminal that shows how far long work is; nothing where standard error is no terminal.
#pragma once

#include <functional>
#include <mutex>
#include <string>

namespace wingbeat::app {

class ProgressLine {
 public:
  /// `name` begins the line: "fit: ".
  explicit ProgressLine(std::string name);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { clear(); }

  /// False: nothing is ever shown, and no text needs to be made.
  bool on_terminal() const { return terminal_; }
  /// Any thread may call it.
  void show(const std::string& text);
  void clear();

  /// What shows a text; empty where nothing is shown.
  std::function<void(const std::string&)> shower();

 private:
  std::string name_;
  bool terminal_, shown_ = false;
  std::mutex mutex_;
};

/// "[######..................]  25.0 %": a share of 0 to 1.
std::string progress_bar(double share);

}  // namespace wingbeat::app
