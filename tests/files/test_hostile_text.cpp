// Texts that a file may hold and that must not become more than text; files that would take minutes to be refused.
#include <cstdint>
#include <ctime>
#include <functional>
#include <string_view>
#include <utility>

#include "vehicle_text.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/files/stored_file.hpp"
#include "wingbeat/files/toml_text.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat {
namespace {

using namespace design_file_test;
using testing::HasSubstr;

std::string utf8(std::uint32_t code) {
  const auto more = [&](int shift) { return char(0x80 | (code >> shift & 0x3F)); };
  if (code < 0x80) return {char(code)};
  if (code < 0x800) return {char(0xC0 | code >> 6), more(0)};
  if (code < 0x10000) return {char(0xE0 | code >> 12), more(6), more(0)};
  return {char(0xF0 | code >> 18), more(12), more(6), more(0)};
}

TEST(HostileText, TomlTextReadsBackWhateverTheCharacter) {
  constexpr std::uint32_t block = 0x400;
  for (std::uint32_t first = 0; first < 0x110000; first += first < 0x4000 ? block : 16 * block) {
    std::string all;
    for (std::uint32_t code = first; code < first + block; ++code) {
      if (code < 0xD800 || code > 0xDFFF) all += utf8(code);
    }
    if (all.empty()) continue;
    const Design<double> d = parse_design(with("\"test vehicle\"", toml_text(all)), "v.toml");
    ASSERT_TRUE(d.name == all) << first;
    ASSERT_TRUE(parse_design(write_design(d), "v.toml").name == all) << first;
  }
}

TEST(HostileText, TomlTextIsTomlWhateverTheBytes) {
  for (const std::string broken :
       {"\xFF", "\xC2", "\xE2\x80", "\xED\xA0\x80", "\xC0\xAF", "\xF4\x90\x80\x80", "\x9B"}) {
    const std::string text = toml_text("a" + broken + "b");
    EXPECT_THAT(text, HasSubstr("\\uFFFD"));
    EXPECT_THAT(parse_design(with("\"test vehicle\"", text), "v.toml").name, testing::StartsWith("a\xEF\xBF\xBD"));
  }
  EXPECT_EQ(toml_text("\x7F\"\\\n"), "\"\\u007F\\\"\\\\\\u000A\"");
  EXPECT_EQ(toml_key("a-B_1"), "a-B_1");
  EXPECT_EQ(toml_key(""), "\"\"");
  EXPECT_EQ(toml_key("a b\x7F"), "\"a b\\u007F\"");
}

TEST(HostileText, WhatIsShownHoldsNoHiddenCharacters) {
  using detail::printable;
  EXPECT_EQ(printable("m² \xF0\x9F\x98\x80 a\tb\nc"), "m² \xF0\x9F\x98\x80 a\tb\nc");
  EXPECT_EQ(printable("\x1B[31m\x7F"), "\\u001b[31m\\u007f");
  EXPECT_EQ(printable("\xC2\x9B\xE2\x80\xAE\xE2\x81\xA9\xE2\x80\xA8"), "\\u009b\\u202e\\u2069\\u2028");
  EXPECT_EQ(printable("\x9B\xE2\x80"), "\\x9b\\xe2\\x80");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\u0000b");
  EXPECT_EQ(detail::markup_escaped("<a\xC2\x9B&\"b\nc\xFF>"), "&lt;a\\u009b&amp;&quot;b c\\xff&gt;");
  EXPECT_EQ(one_line("a\nb\xC2\x9B"), "a\\nb\\u009b");
  EXPECT_THAT(refusal(with("[motor]", "[\"mo\\u009Btor\"]")), HasSubstr("\\u009b"));
}

TEST(HostileText, EndsOfDocuments) {
  using namespace std::string_view_literals;
  const auto whole = [](std::string_view content, std::string_view extension) {
    return !missing_end(content, extension).has_value();
  };
  EXPECT_TRUE(whole("<?xml?><svg a=''><g/></svg>\n\n", ".svg"));
  EXPECT_FALSE(whole("<?xml?><svg a=''><g/></svg", ".svg"));
  EXPECT_FALSE(whole("", ".svg"));
  EXPECT_TRUE(whole("%PDF-1.5\n1\nstartxref\n9\n%%EOF\n% Drawn by\n", ".pdf"));
  EXPECT_FALSE(whole("%PDF-1.5\n%%EOF\nstartxref\n9\n%%", ".pdf"));
  EXPECT_TRUE(whole("\x89PNG\r\n\x1a\n\0\0\0\0IEND\xAE\x42\x60\x82"sv, ".png"));
  EXPECT_FALSE(whole("\x89PNG\r\n\x1a\n\0\0\0\0IEND\xAE\x42\x60"sv, ".png"));
  EXPECT_TRUE(whole("<html></html>\n", ".html"));
  EXPECT_FALSE(whole("<html></html", ".html"));
  std::string mat(128, ' ');
  EXPECT_TRUE(whole(mat, ".mat"));
  mat += std::string("\x0E\0\0\0\x08\0\0\0", 8) + "12345678";
  EXPECT_TRUE(whole(mat, ".mat"));
  EXPECT_FALSE(whole(std::string_view(mat).substr(0, mat.size() - 1), ".mat"));
  const std::string record = "PK\5\6" + std::string(18, '\0');
  EXPECT_TRUE(whole("PK\3\4..." + record, ".fmu"));
  EXPECT_FALSE(whole("PK\3\4..." + record.substr(0, 21), ".fmu"));
  EXPECT_TRUE(whole("any", ".csv"));
}

std::string repeated(int count, const std::function<std::string(int)>& part) {
  std::string text;
  for (int n = 0; n < count; ++n) text += part(n);
  return text;
}

TEST(HostileText, NoFileTakesLongToBeRefused) {
  using std::to_string;
  const std::pair<const char*, std::string> files[] = {
      {"sections", repeated(300000, [](int n) { return "[s" + to_string(n) + "]\n"; })},
      {"sections that may be", repeated(9999, [](int n) { return "[s" + to_string(n) + "]\n"; })},
      {"sections in sections", repeated(200000, [](int n) { return "[s" + to_string(n) + ".t]\n"; })},
      {"lists of tables", repeated(300000, [](int n) { return "[[s" + to_string(n) + "]]\n"; })},
      {"one list of tables", repeated(300000, [](int) { return std::string("[[s]]\n"); })},
      {"keys", repeated(300000, [](int n) { return "k" + to_string(n) + " = 1\n"; })},
      {"keys that may be", repeated(19000, [](int n) { return "k" + to_string(n) + " = 1\n"; })},
      {"dotted keys", repeated(250000, [](int n) { return "k" + to_string(n) + ".a = 1\n"; })},
      {"dotted keys that may be", repeated(19000, [](int n) { return "k" + to_string(n) + ".a = 1\n"; })},
      {"inline tables", "a = [" + repeated(300000, [](int) { return std::string("{b = 1}, "); }) + "]\n"},
      {"brackets", std::string(2000000, '[')},
      {"dots", "a" + repeated(1000000, [](int) { return std::string(".a"); }) + " = 1\n"},
      {"a long key", std::string(4000000, 'k') + " = 1\n"},
      {"a long text", "k = \"" + std::string(4000000, 'x') + "\"\n"},
      {"a long unit", with("\"9 ohm\"", "\"9" + repeated(500000, [](int) { return std::string(" ohm"); }) + "\"")},
      {"a long number", with("\"9 ohm\"", "\"" + std::string(2000000, '9') + " ohm\"")},
      {"a long whole number", with("\"9 ohm\"", std::string(2000000, '9'))},
      {"a long power", with("\"9 ohm\"", "\"9 ohm" + repeated(500000, [](int) { return std::string("^1"); }) + "\"")},
      {"a long array", with("\"9 ohm\"", "[" + repeated(1000000, [](int) { return std::string("1, "); }) + "]")},
      {"backslashes", "k = \"\"\"" + repeated(400000, [](int) { return std::string("\\\n \n"); }) + "\n"},
      {"quotes", repeated(1000000, [](int) { return std::string("''"); })},
      {"lines", std::string(4000000, '\n') + "k = 1\n"},
      {"a long comment", "#" + std::string(4000000, ' ') + "\nk = 1\n"}};
  for (const auto& [what, text] : files) {
    const std::clock_t start = std::clock();
    const std::string said = refusal(text);
    const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
    EXPECT_NE(said, "accepted") << what;
    EXPECT_LT(said.size(), 2000U) << what;
#ifndef WINGBEAT_SANITIZED
    EXPECT_LT(seconds, 3.0) << what;
#endif
    RecordProperty(what, std::to_string(seconds));
  }
  EXPECT_THAT(refusal(files[0].second), HasSubstr("v.toml:10001:1: more than 10000 sections, which no file has"));
  EXPECT_THAT(refusal(files[5].second), HasSubstr("more than 20000 keys, which no file has"));
}

TEST(HostileText, LongTablesAreReadInTime) {
  const int rows = 20000;
  const std::string chords =
      "planform = { shape = \"tabulated\", chords = [" +
      repeated(rows, [](int n) { return "[\"" + std::to_string(n * 0.001) + " mm\", \"20 mm\"],"; }) + "] }";
  const std::clock_t start = std::clock();
  const Design<double> d =
      parse_design(with("planform = { shape = \"moments\", s2 = \"2.457e-6 m4\", s3 = \"1.048e-7 m5\" }", chords), "v");
  EXPECT_EQ(d.wing.planform.chord_table.size(), std::size_t(rows));
#ifndef WINGBEAT_SANITIZED
  EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, 3.0);
#endif
}

}  // namespace
}  // namespace wingbeat
