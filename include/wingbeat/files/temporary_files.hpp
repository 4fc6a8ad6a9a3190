// Files under way, which no signal leaves behind.
#pragma once

#include <filesystem>

namespace wingbeat {

struct TemporaryFile;

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
