// What an interrupted sweep left behind, damaged: the input is a list of edits, four bytes each (which file, where in
// two bytes, the new byte; or a new length), of a journal and a data set that were sound. A chunk that the journal
// still claims to hold must be the one that was stored.
#include <cstring>
#include <stdexcept>

#include "files.hpp"
#include "wingbeat/run/sweep_journal.hpp"

using namespace wingbeat;

namespace {

constexpr ChunkLayout layout{.designs = 100, .chunk = 16, .metrics = 2};
constexpr std::uint64_t fingerprint = 0x5eedULL;

std::vector<std::byte> chunk_bytes(std::uint64_t chunk) {
  std::vector<std::byte> bytes(layout.bytes());
  for (std::size_t column = 0; column < layout.columns(); ++column) {
    const std::size_t length = std::size_t(layout.size(chunk) * layout.bytes_of_value(column));
    std::memset(bytes.data() + layout.begin(column), int(17 * chunk + column + 1), length);
  }
  return bytes;
}

std::uint64_t place_of(std::size_t column) {
  std::uint64_t position = 64;
  for (std::size_t c = 0; c < column; ++c) position += layout.designs * layout.bytes_of_value(c);
  return position;
}

std::vector<std::uint64_t> prepare(const std::filesystem::path& file) {
  std::vector<std::uint64_t> places;
  for (std::size_t column = 0; column < layout.columns(); ++column) places.push_back(place_of(column));
  std::filesystem::resize_file(file, place_of(layout.columns()));
  return places;
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

struct Sound {
  std::string journal, data_set;
};

const std::filesystem::path& journal_path() {
  static const auto path = fuzz::folder() / "sweep.nc.journal";
  return path;
}
const std::filesystem::path& data_path() {
  static const auto path = fuzz::folder() / "sweep.nc.part";
  return path;
}

const Sound& sound() {
  static const Sound made = [] {
    SweepJournal journal(journal_path(), data_path(), false, fingerprint, layout, place_of(layout.columns()), prepare);
    for (const std::uint64_t chunk : {0, 3, 1, 6}) journal.append(chunk, chunk_bytes(chunk));
    return Sound{content_of(journal_path()), content_of(data_path())};
  }();
  return made;
}

void edit(std::string& file, bool length, std::size_t offset, char byte) {
  if (length) {
    file.resize(offset % (file.size() + 64));
  } else if (!file.empty()) {
    file[offset % file.size()] = byte;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Sound damaged = sound();
  for (std::size_t n = 0; n + 4 <= size; n += 4) {
    std::string& file = data[n] & 1 ? damaged.journal : damaged.data_set;
    edit(file, data[n] & 2, std::size_t(data[n + 1]) + 256 * std::size_t(data[n + 2]), char(data[n + 3]));
  }
  fuzz::put("sweep.nc.journal", damaged.journal);
  fuzz::put("sweep.nc.part", damaged.data_set);
  try {
    SweepJournal journal(journal_path(), data_path(), false, fingerprint, layout, place_of(layout.columns()), prepare);
    const std::string now = content_of(data_path());
    for (std::uint64_t chunk = 0; chunk < layout.chunks(); ++chunk) {
      if (!journal.holds(chunk)) continue;
      const std::vector<std::byte> stored = chunk_bytes(chunk);
      for (std::size_t column = 0; column < layout.columns(); ++column) {
        const std::size_t width = layout.bytes_of_value(column), length = std::size_t(layout.size(chunk)) * width;
        const std::uint64_t offset = place_of(column) + layout.first(chunk) * width;
        if (offset + length > now.size() ||
            std::memcmp(now.data() + offset, stored.data() + layout.begin(column), length) != 0) {
          std::abort();
        }
      }
    }
    for (std::uint64_t chunk = 0; chunk < layout.chunks(); ++chunk) {
      if (!journal.holds(chunk)) journal.append(chunk, chunk_bytes(chunk));
    }
    if (journal.designs_held() != layout.designs) std::abort();
    journal.finish(fuzz::folder() / "sweep.nc");
  } catch (const InputError&) {
  } catch (const std::runtime_error&) {}
  return 0;
}
