#include "wingbeat/io/sweep_journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "wingbeat/io/design_file.hpp"

namespace wingbeat {
namespace {

constexpr char magic[16] = "wingbeat sweep\n";
constexpr std::uint64_t largest_chunk = 8192;

struct Header {
  char magic[16];
  std::uint64_t fingerprint, designs, chunk, metrics;
};
static_assert(sizeof(Header) == 48);

struct RecordHead {
  std::uint64_t chunk;
  std::uint64_t checksum;
};

/// Reads until the buffer is full or the file ends; the number of bytes read, or -1.
ssize_t read_at(int file, void* to, std::size_t length, std::uint64_t offset) {
  std::size_t done = 0;
  while (done < length) {
    const ssize_t n = ::pread(file, static_cast<char*>(to) + done, length - done, off_t(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return -1;
    if (n == 0) break;
    done += std::size_t(n);
  }
  return ssize_t(done);
}

bool write_at(int file, const void* from, std::size_t length, std::uint64_t offset) {
  for (std::size_t done = 0; done < length;) {
    const ssize_t n = ::pwrite(file, static_cast<const char*>(from) + done, length - done, off_t(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    done += std::size_t(n);
  }
  return true;
}

}  // namespace

std::uint64_t ChunkLayout::bytes() const { return ((2 * chunk + 7) & ~std::uint64_t(7)) + 8 * chunk * (1 + metrics); }

ChunkLayout layout_of(const Sweep& sweep) {
  const std::uint64_t designs = sweep.size();
  return {designs, std::min(designs, largest_chunk), sweep.options.metrics.count()};
}

void pack(const ChunkLayout& layout, const SweepColumns& columns, std::vector<std::byte>& bytes) {
  bytes.assign(layout.bytes(), std::byte(0));
  std::byte* at = bytes.data();
  const std::size_t n = columns.status.size();
  std::memcpy(at, columns.status.data(), n);
  std::memcpy(at + layout.chunk, columns.recomputed.data(), n);
  at += (2 * layout.chunk + 7) & ~std::uint64_t(7);
  std::memcpy(at, columns.error_estimate.data(), 8 * n);
  for (const auto& column : columns.metrics) std::memcpy(at += 8 * layout.chunk, column.data(), 8 * n);
}

void unpack(const ChunkLayout& layout, std::uint64_t chunk, std::span<const std::byte> bytes, SweepColumns& columns) {
  const std::size_t n = std::size_t(layout.size(chunk));
  columns.first = layout.first(chunk);
  columns.resize(n, std::size_t(layout.metrics));
  const std::byte* at = bytes.data();
  std::memcpy(columns.status.data(), at, n);
  std::memcpy(columns.recomputed.data(), at + layout.chunk, n);
  at += (2 * layout.chunk + 7) & ~std::uint64_t(7);
  std::memcpy(columns.error_estimate.data(), at, 8 * n);
  for (auto& column : columns.metrics) std::memcpy(column.data(), at += 8 * layout.chunk, 8 * n);
}

std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t seed) {
  // Four sums side by side, so that their multiplications overlap.
  constexpr std::uint64_t factor = 0x9e3779b97f4a7c15;
  std::uint64_t lanes[4] = {seed ^ 1, seed ^ 2, seed ^ 3, seed ^ 4};
  std::size_t at = 0;
  const auto take = [&](std::uint64_t& lane, std::uint64_t word) { lane = std::rotl((lane ^ word) * factor, 29); };
  for (; at + 32 <= bytes.size(); at += 32) {
    for (int k = 0; k < 4; ++k) {
      std::uint64_t word;
      std::memcpy(&word, bytes.data() + at + 8 * k, 8);
      take(lanes[k], word);
    }
  }
  for (; at < bytes.size(); ++at) take(lanes[at % 4], std::uint64_t(bytes[at]) + 0x100);
  std::uint64_t sum = bytes.size();
  for (const std::uint64_t lane : lanes) take(sum, lane);
  return sum ^ (sum >> 32);
}

SweepJournal::SweepJournal(const std::filesystem::path& file, std::uint64_t fingerprint, const ChunkLayout& layout)
    : file_(file), layout_(layout), record_of_chunk_(layout.chunks(), none) {
  const std::string name = file.string();
  const auto refuse = [&](const std::string& reason) {
    if (descriptor_ >= 0) ::close(descriptor_);
    throw InputError(name, 0, 0, "", reason);
  };
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) refuse(fmt::format("cannot be written: {}", std::strerror(errno)));
  struct stat found {};
  if (::fstat(descriptor_, &found) != 0 || !S_ISREG(found.st_mode)) refuse("cannot be written: not a regular file");
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    refuse(errno == EWOULDBLOCK ? "another process is at work on this sweep"
                                : fmt::format("cannot be locked: {}", std::strerror(errno)));
  }

  Header header{};
  std::memcpy(header.magic, magic, sizeof magic);
  header.fingerprint = fingerprint;
  header.designs = layout.designs;
  header.chunk = layout.chunk;
  header.metrics = layout.metrics;
  Header there{};
  const ssize_t got = read_at(descriptor_, &there, sizeof there, 0);
  if (got < 0) refuse(fmt::format("cannot be read: {}", std::strerror(errno)));
  const std::size_t common = std::min(std::size_t(got), sizeof header.magic);
  if (std::memcmp(&there, &header, common) != 0) {
    refuse("is not the beginning of a sweep; it is left as it is: move it away, or give another name");
  }
  if (std::memcmp(&there, &header, std::size_t(got)) != 0) {
    refuse("is the beginning of another sweep (another study, vehicle, option or version of the program); it is left "
           "as it is: remove it to begin anew, or give another name");
  }
  if (std::size_t(got) < sizeof header && !write_at(descriptor_, &header, sizeof header, 0)) {
    const int reason = errno;
    if (got == 0) ::unlink(file.c_str());
    refuse(fmt::format("cannot be written: {}", std::strerror(reason)));
  }

  std::vector<std::byte> bytes(layout_.bytes());
  while (true) {
    RecordHead head{};
    const std::uint64_t at = offset(records_);
    if (read_at(descriptor_, &head, sizeof head, at) != ssize_t(sizeof head)) break;
    if (read_at(descriptor_, bytes.data(), bytes.size(), at + sizeof head) != ssize_t(bytes.size())) break;
    if (head.chunk >= layout_.chunks() || head.checksum != checksum(bytes, head.chunk)) break;
    if (holds(head.chunk)) break;
    record_of_chunk_[head.chunk] = records_++;
  }
}

SweepJournal::~SweepJournal() {
  if (records_ == 0) ::unlink(file_.c_str());  // nothing to resume
  ::close(descriptor_);
}

std::uint64_t SweepJournal::offset(std::uint32_t record) const {
  return sizeof(Header) + std::uint64_t(record) * (sizeof(RecordHead) + layout_.bytes());
}

std::uint64_t SweepJournal::designs_held() const {
  std::uint64_t sum = 0;
  for (std::uint64_t c = 0; c < layout_.chunks(); ++c) sum += holds(c) ? layout_.size(c) : 0;
  return sum;
}

void SweepJournal::append(std::uint64_t chunk, std::span<const std::byte> bytes) {
  const RecordHead head{chunk, checksum(bytes, chunk)};
  buffer_.resize(sizeof head + bytes.size());
  std::memcpy(buffer_.data(), &head, sizeof head);
  std::memcpy(buffer_.data() + sizeof head, bytes.data(), bytes.size());
  if (!write_at(descriptor_, buffer_.data(), buffer_.size(), offset(records_))) {
    throw std::runtime_error(fmt::format("{}: cannot be written: {}; what is finished is kept: once that is mended, "
                                         "the same command resumes",
                                         file_.string(), std::strerror(errno)));
  }
  record_of_chunk_[chunk] = records_++;
}

void SweepJournal::read(std::uint64_t chunk, std::vector<std::byte>& bytes) const {
  bytes.resize(layout_.bytes());
  RecordHead head{};
  const std::uint64_t at = offset(record_of_chunk_[chunk]);
  const bool whole = read_at(descriptor_, &head, sizeof head, at) == ssize_t(sizeof head) &&
                     read_at(descriptor_, bytes.data(), bytes.size(), at + sizeof head) == ssize_t(bytes.size());
  if (!whole || head.checksum != checksum(bytes, chunk)) {
    throw std::runtime_error(fmt::format("{}: does not read back as it was written; run the same command again",
                                         file_.string()));
  }
}

void SweepJournal::remove() {
  ::unlink(file_.c_str());
  records_ = 0;
}

}  // namespace wingbeat
