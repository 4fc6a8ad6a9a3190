// What a cluster sees: the script for Slurm, and data sets that say nothing of the machine that wrote them.
#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include "users_folder.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace cli {
namespace {

using testing::HasSubstr;

class Cluster : public UsersFolder {
 protected:
  void SetUp() override { fill(); }
};

TEST_F(Cluster, NoPlaceOnThisMachineIsKept) {
  const std::string folder = fs::path(path("sweep.toml")).parent_path().string();
  ASSERT_EQ(run({"sweep", path("sweep.toml"), "-o", path("o.nc")}).status, 0);
  EXPECT_EQ(wingbeat::NetcdfReader(path("o.nc")).attribute("study_name"), "sweep.toml");
  EXPECT_EQ(count_of(read(path("o.nc")), folder), 0U);
  std::string text = read(path("vehicle.toml"));
  const auto named = text.find("name = ");
  text.erase(named, text.find('\n', named) - named);
  write("unnamed.toml", text);
  ASSERT_EQ(run({"run", path("unnamed.toml"), "--waveforms", path("w.nc")}).status, 0);
  EXPECT_EQ(wingbeat::NetcdfReader(path("w.nc")).attribute("title"), "One flapping cycle of unnamed.toml");
  EXPECT_EQ(count_of(read(path("w.nc")), folder), 0U);
}

#ifdef WINGBEAT_MPIRUN
TEST_F(Cluster, TheScriptForSlurmPassesItsSignalOn) {
  const std::string script = data + "/../scripts/sweep.slurm";
  // Without B: Slurm would signal the steps of a job alone, and mpirun is none.
  EXPECT_THAT(read(script), HasSubstr("\n#SBATCH --signal=B:TERM@"));
  write("many.toml",
        "[study]\nvehicle = \"vehicle.toml\"\nmetrics = [\"frequency_hz\"]\n[samples]\nmethod = \"sobol\"\n"
        "count = 20000\n[[samples.range]]\nkey = \"supply.voltage\"\nfrom = 2\nto = 4\n");
  const std::pair<const char*, const char*> settings[] = {{"ASAN_OPTIONS", "detect_leaks=0"},
                                                          {"WINGBEAT", WINGBEAT_PROGRAM},
                                                          {"OMPI_ALLOW_RUN_AS_ROOT", "1"},
                                                          {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"},
                                                          {"OMPI_MCA_rmaps_base_oversubscribe", "1"}};
  for (const auto& [name, value] : settings) ::setenv(name, value, 1);
  const std::string journal = path("o.nc.journal"), study = path("many.toml"), output = path("o.nc");
  const pid_t batch = ::fork();
  if (batch == 0) {
    ::dup2(::open("/dev/null", O_RDWR), 1);
    ::dup2(::open(path("stderr.txt").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), 2);
    ::execl("/bin/bash", "bash", script.c_str(), study.c_str(), output.c_str(), nullptr);
    ::_exit(99);
  }
  for (const auto& [name, value] : settings) ::unsetenv(name);
  int status = 0;
  bool ended = false;
  std::error_code error;
  // Beyond the header of the journal: one chunk at least.
  constexpr std::uintmax_t header = 48 + 8 * 7;
  while (!ended && fs::file_size(journal, error) + 1 < header + 16 + 1) {
    ended = ::waitpid(batch, &status, WNOHANG) == batch;
    ::usleep(500);
  }
  if (!ended) {
    ::kill(batch, SIGTERM);  // the batch shell alone, as Slurm does
    ::waitpid(batch, &status, 0);
  }
  if (fs::exists(output)) return;  // it was faster
  EXPECT_THAT(read(path("stderr.txt")), HasSubstr("and the same command resumes"));
  const Outcome o = run({"sweep", study, "-o", output});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr(" of them from before; "));
}
#endif

}  // namespace
}  // namespace cli
