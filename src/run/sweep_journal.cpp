#include "wingbeat/run/sweep_journal.hpp"

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

#include "wingbeat/files/design_file.hpp"

namespace wingbeat {
namespace {

constexpr char magic[16] = "wingbeat sweep\n";

struct Header {
  char magic[16];
  std::uint64_t fingerprint, designs, chunk, metrics;
};
static_assert(sizeof(Header) == 48);

struct Record {
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

SweepJournal::SweepJournal(const std::filesystem::path& journal, const std::filesystem::path& data_set, bool force,
                           std::uint64_t fingerprint, const ChunkLayout& layout, std::uint64_t size,
                           const Prepare& prepare)
    : journal_(journal), data_set_(data_set), force_(force), layout_(layout), held_(layout.chunks(), false) {
  try {
    lock(fingerprint, size, prepare);
    take_over();
  } catch (...) {
    close();
    throw;
  }
}

SweepJournal::~SweepJournal() {
  if (journal_file_ < 0) return;
  if (records_ == 0) {  // nothing to resume
    ::unlink(data_set_.c_str());
    ::unlink(journal_.c_str());
  }
  close();
}

void SweepJournal::remove_finished(const std::filesystem::path& journal, const std::filesystem::path& data_set,
                                   std::uint64_t fingerprint) {
  std::error_code error;
  const int file = ::open(journal.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return;
  Header there{};
  const bool same = ::flock(file, LOCK_EX | LOCK_NB) == 0 &&
                    read_at(file, &there, sizeof there, 0) == ssize_t(sizeof there) &&
                    std::memcmp(there.magic, magic, sizeof magic) == 0 && there.fingerprint == fingerprint;
  if (same && !std::filesystem::exists(data_set, error)) ::unlink(journal.c_str());
  ::close(file);
}

void SweepJournal::close() {
  if (data_file_ >= 0) ::close(data_file_);
  if (journal_file_ >= 0) ::close(journal_file_);
  data_file_ = journal_file_ = -1;
}

void SweepJournal::refuse(const std::filesystem::path& file, const std::string& reason) {
  throw InputError(file.string(), 0, 0, "", reason);
}

void SweepJournal::failed(const std::filesystem::path& file, int reason) const {
  throw std::runtime_error(
      fmt::format("{}: cannot be written: {}; what is finished is kept: once that is mended, the "
                  "same command resumes",
                  file.string(), std::strerror(reason)));
}

/// Opens the journal and makes sure that it is of this sweep and that the data set is prepared.
void SweepJournal::lock(std::uint64_t fingerprint, std::uint64_t size, const Prepare& prepare) {
  const bool data_there = std::filesystem::exists(data_set_);
  const bool journal_there = std::filesystem::exists(journal_);
  if (data_there && !journal_there && !force_) {
    refuse(data_set_, fmt::format("exists without {} and belongs to no sweep in progress; it is unchanged: give "
                                  "another name, or --force to replace it",
                                  journal_.filename().string()));
  }
  journal_file_ = ::open(journal_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (journal_file_ < 0) refuse(journal_, fmt::format("cannot be written: {}", std::strerror(errno)));
  struct stat found{};
  if (::fstat(journal_file_, &found) != 0 || !S_ISREG(found.st_mode)) {
    refuse(journal_, "cannot be written: it is not a regular file");
  }
  if (::flock(journal_file_, LOCK_EX | LOCK_NB) != 0) {
    refuse(journal_, errno == EWOULDBLOCK ? "another process is at work on this sweep"
                                          : fmt::format("cannot be locked: {}", std::strerror(errno)));
  }

  Header header{};
  std::memcpy(header.magic, magic, sizeof magic);
  header.fingerprint = fingerprint;
  header.designs = layout_.designs;
  header.chunk = layout_.chunk;
  header.metrics = layout_.metrics;
  Header there{};
  const ssize_t got = read_at(journal_file_, &there, sizeof there, 0);
  if (got < 0) refuse(journal_, fmt::format("cannot be read: {}", std::strerror(errno)));
  const bool same_kind = std::memcmp(&there, &header, std::min(std::size_t(got), sizeof header.magic)) == 0;
  const bool same_sweep = std::memcmp(&there, &header, std::size_t(got)) == 0;
  if (!same_kind && !force_) {
    refuse(journal_, "is no journal of a sweep; it is unchanged: give another name, or --force to replace it");
  }
  if (!same_sweep && !force_) {
    refuse(journal_, fmt::format("belongs to another sweep (another study, vehicle, option or version of the program); "
                                 "it is unchanged: give another name, or --force to remove it and {} and to begin "
                                 "anew",
                                 data_set_.filename().string()));
  }

  // The places of the columns and the check sum of all around them, written when the data set is prepared.
  std::vector<std::uint64_t> places(layout_.columns() + 2);
  const std::size_t length = places.size() * sizeof places[0];
  const auto sum_of = [](std::span<const std::uint64_t> p) {
    return checksum(std::as_bytes(p.first(p.size() - 1)), 8);
  };
  const auto frame_of_file = [&] {
    const int file = ::open(data_set_.c_str(), O_RDONLY | O_CLOEXEC);
    const std::uint64_t sum = frame_sum(file, std::span(places).first(layout_.columns()));
    if (file >= 0) ::close(file);
    return sum;
  };
  const bool prepared = data_there && same_sweep &&
                        read_at(journal_file_, places.data(), length, sizeof header) == ssize_t(length) &&
                        places.back() == sum_of(places) && places[layout_.columns()] == frame_of_file();
  if (!prepared) {
    const bool usable = ::ftruncate(journal_file_, 0) == 0;
    if (!usable || !write_at(journal_file_, &header, sizeof header, 0)) {
      const int reason = errno;
      if (!journal_there) ::unlink(journal_.c_str());
      refuse(journal_, fmt::format("cannot be written: {}", std::strerror(reason)));
    }
    try {
      reserve(size, true);
      places = prepare(data_set_);
      reserve(size, false);
      places.push_back(frame_of_file());
      places.push_back(0);
      places.back() = sum_of(places);
      if (!write_at(journal_file_, places.data(), length, sizeof header)) failed(journal_, errno);
    } catch (...) {
      ::unlink(data_set_.c_str());
      ::unlink(journal_.c_str());
      throw;
    }
  }
  places.pop_back();
  frame_ = places.back();
  places.pop_back();
  places_ = std::move(places);
}

/// Has the system keep room for the whole data set, so that none is lacking later, and so that HDF5, which does not
/// survive a full disk, never meets one. `fresh`: in an empty file, which tells limits of size too.
void SweepJournal::reserve(std::uint64_t size, bool fresh) const {
  const int file = ::open(data_set_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  int reason = file < 0 ? errno : 0;
  if (reason == 0 && fresh && (::ftruncate(file, off_t(size)) != 0 || ::ftruncate(file, 0) != 0)) reason = errno;
  // File systems that cannot do it are taken as they are.
  if (reason == 0 && ::fallocate(file, FALLOC_FL_KEEP_SIZE, 0, off_t(size)) != 0 && errno != EOPNOTSUPP) reason = errno;
  if (file >= 0) ::close(file);
  if (reason == 0) return;
  throw std::runtime_error(
      fmt::format("{}: cannot be written: {}; the data set needs {:.3g} MB: make room, or keep fewer "
                  "metrics (study.metrics)",
                  data_set_.string(), std::strerror(reason), double(size) / 1e6));
}

/// Opens the data set and finds the chunks that it holds.
void SweepJournal::take_over() {
  data_file_ = ::open(data_set_.c_str(), O_RDWR | O_CLOEXEC);
  if (data_file_ < 0) refuse(data_set_, fmt::format("cannot be written: {}", std::strerror(errno)));
  std::vector<std::byte> bytes(layout_.bytes());
  while (true) {
    Record record{};
    if (read_at(journal_file_, &record, sizeof record, record_at(records_)) != ssize_t(sizeof record)) break;
    if (record.chunk >= layout_.chunks() || held_[record.chunk]) break;
    std::fill(bytes.begin(), bytes.end(), std::byte(0));
    if (!transfer(record.chunk, bytes.data(), false) || record.checksum != checksum(bytes, record.chunk)) break;
    held_[record.chunk] = true;
    ++records_;
  }
}

std::uint64_t SweepJournal::record_at(std::uint64_t record) const {
  return sizeof(Header) + 8 * (layout_.columns() + 2) + record * sizeof(Record);
}

std::uint64_t SweepJournal::designs_held() const {
  std::uint64_t sum = 0;
  for (std::uint64_t c = 0; c < layout_.chunks(); ++c) sum += held_[c] ? layout_.size(c) : 0;
  return sum;
}

bool SweepJournal::transfer(std::uint64_t chunk, std::byte* bytes, bool write) const {
  for (std::size_t column = 0; column < layout_.columns(); ++column) {
    const std::uint64_t size = layout_.bytes_of_value(column);
    const std::uint64_t offset = places_[column] + layout_.first(chunk) * size;
    const std::size_t length = std::size_t(layout_.size(chunk) * size);
    std::byte* const values = bytes + layout_.begin(column);
    const bool done = write ? write_at(data_file_, values, length, offset)
                            : read_at(data_file_, values, length, offset) == ssize_t(length);
    if (!done) return false;
  }
  return true;
}

void SweepJournal::append(std::uint64_t chunk, std::span<const std::byte> bytes) {
  // Nothing is changed through this pointer.
  if (!transfer(chunk, const_cast<std::byte*>(bytes.data()), true)) failed(data_set_, errno);
  const Record record{chunk, checksum(bytes, chunk)};
  if (!write_at(journal_file_, &record, sizeof record, record_at(records_))) failed(journal_, errno);
  held_[chunk] = true;
  ++records_;
}

/// Of everything in the data set that is no result: its header, its attributes, the values of its axes.
std::uint64_t SweepJournal::frame_sum(int data_file, std::span<const std::uint64_t> places) const {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> columns;
  for (std::size_t c = 0; c < places.size(); ++c) {
    columns.emplace_back(places[c], places[c] + layout_.designs * layout_.bytes_of_value(c));
  }
  std::sort(columns.begin(), columns.end());
  struct stat found{};
  const std::uint64_t size = ::fstat(data_file, &found) == 0 ? std::uint64_t(found.st_size) : 0;
  columns.emplace_back(std::max(size, columns.back().second), 0);
  std::vector<std::byte> bytes;
  std::uint64_t sum = 1, offset = 0;
  for (const auto& [begin, end] : columns) {
    constexpr std::uint64_t max_bytes = 1u << 20;
    while (offset < begin) {
      bytes.assign(std::size_t(std::min(max_bytes, begin - offset)), std::byte(0));
      (void)!read_at(data_file, bytes.data(), bytes.size(), offset);
      sum = checksum(bytes, sum);
      offset += bytes.size();
    }
    offset = std::max(offset, end);
  }
  return sum;
}

void SweepJournal::finish(const std::filesystem::path& name) {
  if (::fsync(data_file_) != 0) failed(data_set_, errno);
  if (frame_sum(data_file_, places_) != frame_) {
    throw std::runtime_error(
        fmt::format("{}: was damaged while the sweep ran, so it does not become {}; the same command "
                    "begins anew",
                    data_set_.string(), name.string()));
  }
  if (::rename(data_set_.c_str(), name.c_str()) != 0) failed(name, errno);
  ::unlink(journal_.c_str());
  close();
}

}  // namespace wingbeat
