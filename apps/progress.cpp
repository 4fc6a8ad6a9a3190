#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <utility>

#include "wingbeat/core/text.hpp"

namespace wingbeat::app {

ProgressLine::ProgressLine(std::string name) : name_(std::move(name)), terminal_(::isatty(STDERR_FILENO) == 1) {}

void ProgressLine::show(const std::string& text) {
  if (!terminal_) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  fmt::print(stderr, "\r{:<78}", name_ + detail::printable(text));
  shown_ = true;
}

void ProgressLine::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (shown_) fmt::print(stderr, "\r{:<78}\r", "");
  shown_ = false;
}

std::function<void(const std::string&)> ProgressLine::shower() {
  if (!terminal_) return {};
  return [this](const std::string& text) { show(text); };
}

std::string progress_bar(double share) {
  constexpr int width = 24;
  std::string bar(std::size_t(share * width), '#');
  bar.resize(width, '.');
  return fmt::format("[{}] {:5.1f} %", bar, 100.0 * share);
}

}  // namespace wingbeat::app
