// Lists of motors, gearboxes and batteries: CSV files with a part in each line, as manufacturers and collections write
// them.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/bench_table.hpp"
#include "files/column_headers.hpp"

namespace wingbeat::detail {

/// A header without unit of a collection whose numbers are SI, and the column that it is.
struct PlainHeader {
  std::string_view header, name;
};

/// What a list of one kind of part may have.
struct PartColumns {
  std::string section;                   ///< of the study: "motors"
  std::vector<NamedColumn> columns;      ///< others are passed over
  std::span<const ColumnAlias> aliases;  ///< what manufacturers and collections call them
  std::span<const PlainHeader> plain;    ///< of the Motor-Gearbox Database (MGDB), whose tables have a column `key`
  std::vector<std::string_view> required;
};

class PartList {
 public:
  /// Throws InputError, naming the file, for a header that cannot be understood or lacks a required column.
  PartList(std::string_view utf8, const std::string& file_name, const StatedTable& stated, const PartColumns& kind);

  const std::vector<TableLine>& rows() const { return table_.rows; }
  bool has(std::string_view column) const { return places_.count(column) > 0; }
  std::string text(const TableLine& row, std::string_view column) const;
  /// SI; nothing where the column or the value is missing. Throws InputError for what is no finite number.
  std::optional<double> number(const TableLine& row, std::string_view column) const;
  /// Of a limit, which may be stated as infinite: nothing then.
  std::optional<double> limit(const TableLine& row, std::string_view column) const;
  [[noreturn]] void refuse(int line, int column, const std::string& key, const std::string& message) const;

 private:
  /// Which cell of a row a column is, and the factor to SI.
  struct Place {
    std::size_t cell = 0;
    double factor = 1.0;
    std::string header;
    bool alias = false;
  };

  void place(std::size_t n);
  /// The column of a header of the MGDB; null where it is none, or the table is not one of those.
  const NamedColumn* plain_column(const std::string& header) const;

  std::string name_;
  const StatedTable& stated_;
  const PartColumns& kind_;
  BenchTable table_;
  std::vector<const NamedColumn*> known_;
  std::map<std::string, Place, std::less<>> places_;
};

}  // namespace wingbeat::detail
