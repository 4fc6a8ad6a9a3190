// What a command has written, so that it can say so.
#pragma once

#include <string>
#include <vector>

namespace wingbeat {

/// Notes a file or folder that is complete under its name, as the user typed it.
void note_written(const std::string& name);

/// The names noted since the last call, each once, in their order.
std::vector<std::string> take_written();

}  // namespace wingbeat
