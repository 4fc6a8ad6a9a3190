// Files under way, which no signal leaves behind, and what a killed process left.
#pragma once

#include <filesystem>
#include <string>

namespace wingbeat {

struct TemporaryFile;

/// The name of a file under way, which says whose it is: ".wingbeat-0a1b2c3d-1234-56789-0.part.svg", system (of one
/// boot, and of one container), process and its start.
std::string temporary_name(int number, const std::string& extension);

/// Removes files of such names from a folder whose processes are gone, once in the life of this process. Whether one of
/// another system is gone cannot be known: its files go when nothing has been written to them for a day.
void remove_leftovers(const std::filesystem::path& folder);

/// Enters a file that exists under a name of its own until it is complete; `forget` when it has been renamed or
/// removed.
TemporaryFile* remember_temporary(const std::filesystem::path& file);
void forget_temporary(TemporaryFile* file);

/// Has SIGINT, SIGTERM and SIGHUP remove these files and then end the program as they would without (a shell sees 128
/// and the signal's number). A signal that is ignored stays ignored.
void remove_temporaries_on_signals();
/// What those signals do then, for a handler of one's own: safe in a signal handler. Does not return.
[[noreturn]] void remove_temporaries_and_end(int signal);

}  // namespace wingbeat
