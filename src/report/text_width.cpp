#include "report/text_width.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <utility>

namespace wingbeat {
namespace {

// Advance widths of DejaVu Sans 2.37 (table hmtx of DejaVuSans.ttf), 2048 to the em: U+0020 to U+007E,
// U+00A0 to U+00FF, U+0391 to U+03C9.
constexpr std::array<std::uint16_t, 95> ascii = {
    651,  821,  942,  1716, 1303, 1946, 1597, 563,  799,  799,  1024, 1716, 651,  739,  651,  690,  1303, 1303, 1303,
    1303, 1303, 1303, 1303, 1303, 1303, 1303, 690,  690,  1716, 1716, 1716, 1087, 2048, 1401, 1405, 1430, 1577, 1294,
    1178, 1587, 1540, 604,  604,  1343, 1141, 1767, 1532, 1612, 1235, 1612, 1423, 1300, 1251, 1499, 1401, 2025, 1403,
    1251, 1403, 799,  690,  799,  1716, 1024, 1024, 1255, 1300, 1126, 1300, 1260, 721,  1300, 1298, 569,  569,  1186,
    569,  1995, 1298, 1253, 1300, 1300, 842,  1067, 803,  1298, 1212, 1675, 1212, 1212, 1075, 1303, 690,  1303, 1716};
constexpr std::array<std::uint16_t, 96> latin = {
    651,  821,  1303, 1303, 1303, 1303, 690,  1024, 1024, 2048, 965,  1253, 1716, 739,  2048, 1024,
    1024, 1716, 821,  821,  1024, 1303, 1303, 651,  1024, 821,  965,  1253, 1985, 1985, 1985, 1087,
    1401, 1401, 1401, 1401, 1401, 1401, 1995, 1430, 1294, 1294, 1294, 1294, 604,  604,  604,  604,
    1587, 1532, 1612, 1612, 1612, 1612, 1612, 1716, 1612, 1499, 1499, 1499, 1499, 1251, 1239, 1290,
    1255, 1255, 1255, 1255, 1255, 1255, 2011, 1126, 1260, 1260, 1260, 1260, 569,  569,  569,  569,
    1253, 1298, 1253, 1253, 1253, 1253, 1253, 1716, 1253, 1298, 1298, 1298, 1298, 1212, 1300, 1212};
constexpr std::array<std::uint16_t, 57> greek = {
    1401, 1405, 1141, 1401, 1294, 1403, 1540, 1612, 604,  1343, 1401, 1767, 1532, 1294, 1612, 1540, 1235, 2048, 1294,
    1251, 1251, 1612, 1403, 1612, 1565, 604,  1251, 1350, 1107, 1298, 693,  1185, 1350, 1307, 1212, 1253, 1107, 1114,
    1298, 1253, 693,  1207, 1212, 1303, 1144, 1142, 1253, 1233, 1300, 1202, 1298, 1233, 1185, 1351, 1183, 1351, 1715};
constexpr std::pair<std::uint32_t, std::uint16_t> others[] = {{0x2013, 1024}, {0x2032, 465},  {0x2212, 1716},
                                                              {0x2248, 1716}, {0x2264, 1716}, {0x2265, 1716}};
constexpr double em = 2048.0;

double advance(std::uint32_t c) {
  if (c >= 0x20 && c - 0x20 < ascii.size()) return ascii[c - 0x20];
  if (c >= 0xa0 && c - 0xa0 < latin.size()) return latin[c - 0xa0];
  if (c >= 0x391 && c - 0x391 < greek.size()) return greek[c - 0x391];
  const auto found = std::find_if(std::begin(others), std::end(others), [&](const auto& o) { return o.first == c; });
  return found == std::end(others) ? em : found->second;
}

/// The bytes of the character that starts there.
std::size_t character_length(std::string_view text, std::size_t position) {
  std::size_t n = 1;
  while (position + n < text.size() && (static_cast<unsigned char>(text[position + n]) & 0xc0) == 0x80) ++n;
  return n;
}

std::uint32_t character(std::string_view bytes) {
  const auto first = static_cast<unsigned char>(bytes.front());
  std::uint32_t c = bytes.size() == 1   ? first
                    : bytes.size() == 2 ? first & 0x1f
                    : bytes.size() == 3 ? first & 0x0f
                                        : first & 0x07;
  for (const char b : bytes.substr(1)) c = (c << 6) | (static_cast<unsigned char>(b) & 0x3f);
  return c;
}

/// Bytes of the longest beginning that fits; one character at least.
std::size_t fitting_length(std::string_view text, double size, double room) {
  std::size_t n = character_length(text, 0);
  while (n < text.size()) {
    const std::size_t more = n + character_length(text, n);
    if (text_width(text.substr(0, more), size) > room) break;
    n = more;
  }
  return n;
}

}  // namespace

double text_width(std::string_view utf8, double size) {
  double sum = 0.0;
  for (std::size_t position = 0; position < utf8.size();) {
    const std::size_t n = character_length(utf8, position);
    sum += advance(character(utf8.substr(position, n)));
    position += n;
  }
  return sum / em * size / points_per_inch;
}

std::vector<std::string> broken_lines(std::string_view utf8, double size, double room) {
  std::vector<std::string> lines;
  while (!utf8.empty()) {
    std::size_t n = fitting_length(utf8, size, room), next = n;
    if (n < utf8.size()) {
      const std::size_t blank = utf8.rfind(' ', n);
      if (blank != std::string_view::npos && blank > 0) {
        n = blank;
        next = blank + 1;
      }
    }
    lines.emplace_back(utf8.substr(0, n));
    utf8.remove_prefix(std::min(next, utf8.size()));
  }
  return lines;
}

double fitting_size(std::string_view utf8, double size, double room) {
  const double width = text_width(utf8, size);
  return width > room ? size * room / width : size;
}

}  // namespace wingbeat
