// write_unit_table FOLDER: the C++ source of unit_table.hpp's tables from the XML files of UDUNITS in that folder. Each
// word is taken apart by the program's own reader of units, so that page and program agree.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "files/unit_system.hpp"

namespace {

using wingbeat::detail::UnitAnatomy;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> all_between(const std::string& text, const char* tag) {
  const std::regex pattern(fmt::format("<{0}[^>]*>\\s*([^<]*?)\\s*</{0}>", tag));
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
    found.push_back((*match)[1]);
  return found;
}

/// A reference to a character in an XML text, as UTF-8.
std::string without_references(std::string text) {
  static const std::regex reference("&#x([0-9A-Fa-f]+);");
  for (std::smatch found; std::regex_search(text, found, reference);) {
    const unsigned long code = std::stoul(found[1], nullptr, 16);
    std::string utf8;
    if (code < 0x80) utf8 = {char(code)};
    else if (code < 0x800) utf8 = {char(0xC0 | code >> 6), char(0x80 | (code & 0x3F))};
    else utf8 = {char(0xE0 | code >> 12), char(0x80 | (code >> 6 & 0x3F)), char(0x80 | (code & 0x3F))};
    text = found.prefix().str() + utf8 + found.suffix().str();
  }
  return text;
}

std::string literal(const std::string& text) {
  std::string result;
  for (const char c : text) {
    result += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  }
  return result;
}

void write_unit(const std::string& word, bool symbol, std::set<std::string>& written) {
  if (!written.insert(word).second) return;
  const auto unit = wingbeat::detail::dissect_unit(word);
  if (!unit) return;
  std::string dimension;
  for (const auto& [base, power] : unit->dimension) dimension += fmt::format("{} {} ", base, power);
  const double offset = wingbeat::detail::converted_temperature(0.0, word, "K").value_or(0.0);
  std::puts(fmt::format("    {{\"{}\", {}, {}, {}, {}, \"{}\", {}}},", literal(word), symbol, unit->scale, offset,
                        unit->angle, dimension, unit->plain)
                .c_str());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  std::string text;
  for (const char* part : {"base", "derived", "accepted", "common"}) {
    text += text_of(std::filesystem::path(argv[1]) / fmt::format("udunits2-{}.xml", part));
  }
  const std::string prefixes = text_of(std::filesystem::path(argv[1]) / "udunits2-prefixes.xml");
  if (text.empty() || prefixes.empty()) {
    std::fputs("write_unit_table: the XML files of UDUNITS-2 are missing\n", stderr);
    return 1;
  }
  std::puts("#include \"unit_table.hpp\"\n\nnamespace wingbeat::web {\nnamespace {\n\nconstexpr UnitRow units[] = {");
  std::set<std::string> written;
  for (const std::string& word : all_between(text, "symbol")) write_unit(without_references(word), true, written);
  for (const auto& [symbol, definition] : wingbeat::detail::unit_products) write_unit(symbol, true, written);
  for (const char* symbol : {"deg", "rev"}) write_unit(symbol, true, written);
  for (const char* tag : {"singular", "plural"}) {
    for (std::string word : all_between(text, tag)) {
      // UDUNITS makes a plural of each name; what is none it does not know, and neither does the table.
      const std::string stem = word.substr(0, word.empty() ? 0 : word.size() - 1);
      for (const std::string& form : {word, word + "s", word + "es", stem + "ies"}) write_unit(form, false, written);
    }
  }
  std::puts("};\n\nconstexpr PrefixRow prefixes[] = {");
  const std::regex block("<prefix>([\\s\\S]*?)</prefix>");
  for (std::sregex_iterator match(prefixes.begin(), prefixes.end(), block), end; match != end; ++match) {
    const std::string body = (*match)[1];
    const std::string value = all_between(body, "value").front();
    for (const std::string& name : all_between(body, "name"))
      std::printf("    {\"%s\", false, %s},\n", name.c_str(), value.c_str());
    for (const std::string& symbol : all_between(body, "symbol")) {
      std::printf("    {\"%s\", true, %s},\n", without_references(symbol).c_str(), value.c_str());
    }
  }
  std::puts(
      "};\n\n}  // namespace\n\nstd::span<const UnitRow> unit_table() { return units; }\n"
      "std::span<const PrefixRow> prefix_table() { return prefixes; }\n\n}  // namespace wingbeat::web");
}
