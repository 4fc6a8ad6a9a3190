#include "files/part_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat::detail {
namespace {

bool is_infinite(std::string_view cell) {
  std::string small(cell);
  std::transform(small.begin(), small.end(), small.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return small == "inf" || small == "infinity" || small == "infinite" || small == "∞";
}

}  // namespace

PartList::PartList(std::string_view utf8, const std::string& file_name, const StatedTable& stated,
                   const PartColumns& kind)
    : name_(file_name), stated_(stated), kind_(kind), table_(read_bench_table(utf8, file_name, stated.form)) {
  for (const NamedColumn& c : kind.columns) known_.push_back(&c);
  for (std::size_t n = 0; n < table_.header.cells.size(); ++n) place(n);
  for (const auto& [header, meaning] : stated.columns) {
    const auto has = [&, &h = header](const TableCell& cell) { return cell.text == h; };
    if (std::none_of(table_.header.cells.begin(), table_.header.cells.end(), has)) {
      refuse(table_.header.number, 1, "",
             fmt::format("{}.columns names {}, which the header has not", kind.section, in_quotes(header)));
    }
  }
  for (const std::string_view needed : kind.required) {
    if (has(needed)) continue;
    refuse(
        table_.header.number, 1, std::string(needed),
        fmt::format("missing; expected a column of that name, or {}.columns to name the one that it is", kind.section));
  }
}

std::string PartList::text(const TableLine& row, std::string_view column) const {
  const auto found = places_.find(column);
  return found == places_.end() ? "" : row.cells[found->second.cell].text;
}

std::optional<double> PartList::number(const TableLine& row, std::string_view column) const {
  const auto found = places_.find(column);
  if (found == places_.end()) return std::nullopt;
  const TableCell& cell = row.cells[found->second.cell];
  if (is_missing(cell.text)) return std::nullopt;
  std::string content = cell.text;
  if (table_.decimal_comma) std::replace(content.begin(), content.end(), ',', '.');
  try {
    return found->second.factor * parse_quantity(content, "1");
  } catch (const UnitError&) {
    refuse(row.number, cell.column, found->second.header, "expected a number, got " + in_quotes(cell.text));
  }
}

std::optional<double> PartList::limit(const TableLine& row, std::string_view column) const {
  const auto found = places_.find(column);
  if (found != places_.end() && is_infinite(row.cells[found->second.cell].text)) return std::nullopt;
  const std::optional<double> value = number(row, column);
  if (value && !(*value > 0.0)) {
    const TableCell& cell = row.cells[found->second.cell];
    refuse(row.number, cell.column, found->second.header, "expected a limit > 0, got " + in_quotes(cell.text));
  }
  return value;
}

void PartList::refuse(int line, int column, const std::string& key, const std::string& message) const {
  throw InputError(name_, line, column, key, message);
}

const NamedColumn* PartList::plain_column(const std::string& header) const {
  const auto& cells = table_.header.cells;
  if (std::none_of(cells.begin(), cells.end(), [](const TableCell& c) { return c.text == "key"; })) return nullptr;
  for (const PlainHeader& plain : kind_.plain) {
    if (plain.header != header) continue;
    for (const NamedColumn* c : known_) {
      if (c->name == plain.name) return c;
    }
  }
  return nullptr;
}

void PartList::place(std::size_t n) {
  const TableCell& cell = table_.header.cells[n];
  RecognisedHeader found;
  bool mapped = false;
  for (const auto& [header, meaning] : stated_.columns) {
    if (header != cell.text) continue;
    if (meaning == "ignore") return;
    mapped = true;
    found = recognise_stated(meaning, header, known_, kind_.aliases);
    if (found.column) continue;
    std::string names;
    for (const NamedColumn* c : known_) names += (names.empty() ? "" : ", ") + c->name;
    refuse(table_.header.number, cell.column, "",
           fmt::format("{}.columns names {}, which is none of {}", kind_.section, in_quotes(meaning), names));
  }
  if (!mapped) {
    const NamedColumn* plain = plain_column(cell.text);
    found = plain ? RecognisedHeader{plain, 1.0, plain->unit, false, ""}
                  : recognise_header(cell.text, known_, kind_.aliases);
  }
  if (!found.column) return;
  if (!found.complaint.empty()) {
    if (found.renamed && !mapped) return;  // something else of that name
    refuse(table_.header.number, cell.column, cell.text,
           fmt::format("{}; {}.columns = {{ {} = \"{} [{}]\" }} says which", found.complaint, kind_.section,
                       in_quotes(cell.text), found.column->name, found.column->unit));
  }
  // A column's own name goes before what others call it.
  const Place here{n, found.factor, cell.text, found.renamed && !mapped};
  const auto [before, fresh] = places_.try_emplace(found.column->name, here);
  if (fresh || (here.alias && !before->second.alias)) return;
  if (before->second.alias && !here.alias) {
    before->second = here;
    return;
  }
  refuse(table_.header.number, cell.column, cell.text,
         fmt::format("{} is given twice, as {} and as {}; {}.columns = {{ {} = \"ignore\" }} leaves one out",
                     found.column->name, in_quotes(before->second.header), in_quotes(cell.text), kind_.section,
                     in_quotes(cell.text)));
}

}  // namespace wingbeat::detail
