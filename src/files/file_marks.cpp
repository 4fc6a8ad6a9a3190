// How the program knows a file of its own.
#include <fmt/format.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "wingbeat/files/file_record.hpp"
#include "wingbeat/files/netcdf.hpp"
#include "wingbeat/files/stored_file.hpp"
#include "wingbeat/files/waveform_file.hpp"
#include "wingbeat/files/zip_file.hpp"

namespace wingbeat {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view drawn = "Drawn by wingbeat";
constexpr std::string_view png_signature = "\x89PNG\r\n\x1a\n";

/// The columns of waveform files before voltage and the moments of springs came to them.
constexpr std::string_view first_waveform_header =
    "time_s,crank_angle_rad,crank_speed_rad_per_s,current_a,stroke_angle_rad,flapping_velocity_rad_per_s,"
    "angle_of_attack_deg,lift_n,aero_moment_nm,rod_force_n,motor_torque_nm,friction_torque_nm";

/// With the pitch angle, which comes last, or without it.
std::string waveform_header(bool pitching) {
  std::string text;
  for (const WaveformColumn& c : std::span(waveform_columns()).first(waveform_column_count - (pitching ? 0 : 1)))
    text += fmt::format("{}{}", text.empty() ? "" : ",", c.name);
  return text;
}

/// What the heads of the program's own text files say: "# Found by wingbeat 1.2 optimise ...".
bool says_so(std::string_view comment) {
  for (const std::string_view made : {"Found", "found", "Fitted", "Identified", "Written"}) {
    for (const std::string_view by : {" by wingbeat ", " by: wingbeat "}) {
      if (comment.find(fmt::format("{}{}", made, by)) != std::string_view::npos) return true;
    }
  }
  return false;
}

bool text_is_own(std::string_view head) {
  if (head.starts_with("{") || head.starts_with("MATLAB 5.0")) return says_so(head.substr(0, 400));
  if (head.starts_with("<")) return head.find(fmt::format("<!-- {} -->", drawn)) != std::string_view::npos;
  for (int line = 0; line < 3; ++line) {
    const std::string_view content = head.substr(0, head.find_first_of("\r\n"));
    if (line == 0 &&
        (content == first_waveform_header || content == waveform_header(false) || content == waveform_header(true)))
      return true;
    const bool comment = content.starts_with("#") || (line == 0 && content.starts_with("Written by: "));
    if (comment && says_so(content)) return true;
    const auto next = head.find('\n');
    if (next == std::string_view::npos) return false;
    head.remove_prefix(next + 1);
  }
  return false;
}

bool data_set_is_own(const fs::path& file) {
  try {
    const NetcdfReader data(file);
    if (data.attribute("wingbeat_version")) return true;
    const auto source = data.attribute("source");
    return source && source->starts_with("wingbeat ");
  } catch (const NetcdfError&) {
    return false;
  }
}

/// An FMU by the head of the vehicle in it.
bool archive_is_own(const fs::path& file) {
  try {
    const auto files = read_zip(file);
    return std::any_of(files.begin(), files.end(), [](const auto& entry) {
      return entry.first == "resources/vehicle.bin" && entry.second.starts_with("wingbeat FMU vehicle ");
    });
  } catch (const std::runtime_error&) {
    return false;
  }
}

std::string big_endian(std::uint32_t x) {
  return {char(x >> 24 & 0xFF), char(x >> 16 & 0xFF), char(x >> 8 & 0xFF), char(x & 0xFF)};
}

void mark_svg(std::string& text) {
  const auto declaration = text.starts_with("<?xml") ? text.find("?>") : std::string::npos;
  const std::string mark = fmt::format("<!-- {} -->\n", drawn);
  if (declaration == std::string::npos) {
    text.insert(0, mark);
  } else {
    const auto line = text.find('\n', declaration);
    text.insert(line == std::string::npos ? declaration + 2 : line + 1, mark);
  }
}

/// In cairo's place among the document's information, whose length is kept because the file counts its bytes.
void mark_pdf(std::string& text) {
  const std::string key = "/Producer (cairo ", end = "(https://cairographics.org))";
  const auto position = text.rfind(key),
             closing = text.find(end, position == std::string::npos ? text.size() : position);
  if (closing == std::string::npos || closing - position > 60) {
    text += fmt::format("% {}\n", drawn);
    return;
  }
  const std::size_t from = position + std::strlen("/Producer ("), length = closing + end.size() - 1 - from;
  const std::string cairo = text.substr(from, closing - from - 1);
  std::string producer = fmt::format("{}, {}", drawn, cairo);
  producer.resize(length, ' ');
  text.replace(from, length, producer);
}

/// A text chunk behind the header of the image.
void mark_png(std::string& text) {
  constexpr std::size_t header = 8 + 12 + 13;
  if (text.size() < header || !text.starts_with(png_signature)) return;
  std::string chunk = "tEXtSoftware";
  chunk += '\0';
  chunk += drawn;
  boost::crc_32_type sum;
  sum.process_bytes(chunk.data(), chunk.size());
  text.insert(header, big_endian(std::uint32_t(chunk.size() - 4)) + chunk + big_endian(sum.checksum()));
}

}  // namespace

bool written_by_wingbeat(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string head(4096, '\0');
  in.read(head.data(), std::streamsize(head.size()));
  head.resize(std::size_t(in.gcount()));
  if (head.empty()) return true;
  if (head.starts_with("\x89HDF") || head.starts_with("CDF")) return data_set_is_own(file);
  if (head.starts_with("PK\x03\x04")) return archive_is_own(file);
  if (head.starts_with(png_signature)) {
    return head.find(std::string("Software\0", 9) + std::string(drawn)) != std::string::npos;
  }
  if (head.starts_with("%PDF")) {
    constexpr std::streamoff max_bytes = 16384;
    in.clear();
    in.seekg(0, std::ios::end);
    in.seekg(std::max<std::streamoff>(0, std::streamoff(in.tellg()) - max_bytes));
    const std::string tail{std::istreambuf_iterator<char>(in), {}};
    return tail.find(drawn) != std::string::npos;
  }
  return text_is_own(head);
}

void mark_drawing(const fs::path& file, const std::string& shown) {
  const std::string extension = file.extension().string();
  void (*const mark)(std::string&) = extension == ".svg"   ? mark_svg
                                     : extension == ".pdf" ? mark_pdf
                                     : extension == ".png" ? mark_png
                                                           : nullptr;
  if (!mark) return;
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  in.close();
  if (text.find(drawn) != std::string::npos) return;
  mark(text);
  store(file, text, shown);
}

}  // namespace wingbeat
