#include "wingbeat/run/ranks.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "module_symbol.hpp"

namespace wingbeat {
namespace {

bool started_as_one_of_several() {
  for (const char* size : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    if (const char* value = std::getenv(size)) return std::atoi(value) > 1;
  }
  const char* tasks = std::getenv("SLURM_NTASKS");
  return std::getenv("PMIX_RANK") && tasks && std::atoi(tasks) > 1;
}

void check(int error) {
  if (error != 0) throw std::runtime_error("MPI error " + std::to_string(error));
}

}  // namespace

std::unique_ptr<Ranks> Ranks::join() {
  if (!started_as_one_of_several()) return nullptr;
  // Open MPI's own modules look for its symbols among the global ones.
  std::string reason;
  const void* const symbol = module_symbol("wingbeat-mpi", "wingbeat_rank_module", RTLD_GLOBAL, reason);
  if (!symbol) throw std::runtime_error("started as one of several processes, but without MPI: " + reason);
  return std::unique_ptr<Ranks>(new Ranks(*static_cast<const RankModule*>(symbol)));
}

Ranks::Ranks(const RankModule& module) : module_(module) { check(module_.start(&rank_, &count_)); }

Ranks::~Ranks() { module_.finish(); }

void Ranks::send(int to, int tag, std::span<const std::byte> bytes) {
  check(module_.send(to, tag, bytes.data(), int(bytes.size())));
}

std::optional<Ranks::Message> Ranks::poll() {
  Message m;
  int found = 0, length = 0;
  check(module_.probe(0, &found, &m.from, &m.tag, &length));
  if (!found) return std::nullopt;
  m.bytes.resize(std::size_t(length));
  check(module_.receive(m.from, m.tag, m.bytes.data(), length));
  return m;
}

Ranks::Message Ranks::receive() {
  Message m;
  int found = 0, length = 0;
  check(module_.probe(1, &found, &m.from, &m.tag, &length));
  m.bytes.resize(std::size_t(length));
  check(module_.receive(m.from, m.tag, m.bytes.data(), length));
  return m;
}

void Ranks::abort() {
  module_.abort();
  std::abort();
}

}  // namespace wingbeat
