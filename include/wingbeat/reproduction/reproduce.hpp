// A paper reproduced into a folder: figures, the data behind them, assessed statements, one report.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "wingbeat/reproduction/claims.hpp"

namespace wingbeat {

/// A paper whose published values and vehicles the program carries with it.
struct KnownPaper {
  std::string_view name;
  /// Throws InputError only if the program was built from files that are in error.
  PublishedFile (*published)();
};
std::span<const KnownPaper> known_papers();
/// Throws InputError for a paper that the program does not know.
const KnownPaper& known_paper(std::string_view name);

struct ReproduceOptions {
  std::filesystem::path output;  ///< the folder
  bool coarse = false;
  bool force = false;   ///< replaces files that the program did not write
  std::string version;  ///< of the program
  ForEach for_each;
  std::function<void(double share, const std::string& what)> progress;  ///< called by one thread at a time
};

/// A folder that may be written to: new, empty, or one that this command wrote before. Creates it. Throws InputError
/// for every other, and where it cannot be written.
/// That a file in it would be replaced that is not the program's, or was changed since, is refused unless `force`.
void prepare_reproduction_folder(const std::filesystem::path& folder, std::string_view paper, bool force = false);

/// Computes and writes everything. Files of the same names from an earlier run are replaced, others in the folder stay.
/// Throws InputError as prepare_reproduction_folder does, std::runtime_error where a file cannot be stored or drawn;
/// before it computes if gnuplot is missing.
struct ReproduceResult {
  PublishedFile file;
  Assessment assessment;
  int figures = 0;
};
ReproduceResult reproduce_paper(const KnownPaper& paper, const ReproduceOptions& options);

}  // namespace wingbeat
