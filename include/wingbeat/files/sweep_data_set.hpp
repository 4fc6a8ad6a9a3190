// The data set of a sweep: NetCDF-4 with a dimension for each axis and a variable for each metric; docs/sweep.md.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "wingbeat/files/chunk_layout.hpp"
#include "wingbeat/files/study_file.hpp"
#include "wingbeat/study/sweep_best.hpp"

namespace wingbeat {

/// What a finished sweep holds, in short.
struct SweepDigest {
  std::array<std::uint64_t, sweep_status_count> designs{};  ///< by SweepStatus
  std::uint64_t recomputed = 0;                             ///< by the scalar solver
  std::uint64_t outside = 0;                                ///< flapping, but outside the model's domain
  std::array<std::uint64_t, domain_limit_count> beyond{};   ///< of those, by DomainLimit
  SweepBest lift;                                           ///< by lift_mean [N], if kept and not held
  SweepBest power{true};                                    ///< where lift is held, by power_electrical [W], if kept
  SweepBest efficiency;                                     ///< by efficiency_system [1], if kept
};

/// Stands for everything that a data set depends on: study, vehicle, options, instruction set, version.
std::uint64_t fingerprint(const Study& study, std::string_view version);

/// Makes the data set but for the results, for which it has room; the place of each column of results in the file
/// [bytes], in the order of ChunkLayout. Throws NetcdfError.
std::vector<std::uint64_t> prepare_data_set(const std::filesystem::path& file, const Study& study,
                                            std::string_view version);

/// What a data set holds. Throws NetcdfError.
SweepDigest digest_of(const std::filesystem::path& file, const Study& study);

/// The study that a data set was made from. Throws InputError.
Study read_study_in_data_set(const std::filesystem::path& file);

/// What stands under the name of an output: nothing, this very sweep, or something that must not be overwritten.
enum class Standing { nothing, same_sweep };
/// Throws InputError for anything else, with the reason, unless `force` says that it may be replaced, which makes it
/// nothing; `option` is what the path was given for.
Standing standing_of(const std::filesystem::path& file, std::uint64_t fingerprint, const std::string& option,
                     bool force);

/// Bytes of the data set, nearly.
std::uint64_t data_set_size(const Study& study);

}  // namespace wingbeat
