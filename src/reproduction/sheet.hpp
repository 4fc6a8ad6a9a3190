// A figure of a reproduced paper: the drawing, the data behind it, and what is said about it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "report/style.hpp"
#include "reproduction/further_physics.hpp"
#include "wingbeat/files/netcdf.hpp"
#include "wingbeat/report/plot.hpp"
#include "wingbeat/reproduction/claims.hpp"

namespace wingbeat::reproduction {

/// How a curve is drawn: the colour says what of, the dash which formulation.
struct CurveStyle {
  const char* colour = style::ink;
  const char* dash = style::solid;  ///< as gnuplot writes it
  double weight = style::curve_width;
};
/// The style of a curve for the formulation virtual-work.
CurveStyle of_virtual_work(CurveStyle style);

struct ChartCurve {
  std::vector<double> x, y;
  CurveStyle style;
  std::string name;                    ///< read out in the report: "with springs, rod-force"
  const char* formulation = "";        ///< the report can hide the curves of one
  std::string label = {};              ///< beside its right end; in gnuplot's marks for symbols
  const char* label_colour = nullptr;  ///< where it is not the curve's
};
/// The area between a curve and zero: above and below in two fills.
struct ChartArea {
  std::vector<double> x, y;
  const char *above, *below;
};
struct ChartLevel {
  double y;
  std::string name;
};
/// A published value; without y a place along the axis.
struct ChartMark {
  double x, y = absent;
  std::string name;
  const char* colour = style::ink;
  bool calibrated = false;  ///< used in the calibration: drawn hollow
};
/// A published range along the axis.
struct ChartSpan {
  double from, to;
  std::string name;
  const char* colour;
};
struct ChartPanel {
  std::string y;  ///< quantity and unit
  std::string title;
  std::vector<ChartCurve> curves;
  std::vector<ChartArea> areas;
  std::vector<ChartLevel> levels;
  std::vector<ChartMark> marks;
  std::vector<ChartSpan> spans;
  bool from_zero = true;
};
struct ChartKey {
  std::string name;
  CurveStyle style;
  const char* fill = nullptr;  ///< a box of that fill instead of a line
  int mark = 0;                ///< gnuplot's point type instead of a line
};
/// Panels over the same axis: below each other, or in two columns over the width of a page.
struct Chart {
  std::string x;  ///< quantity and unit
  std::vector<ChartPanel> panels;
  std::vector<ChartKey> key;   ///< of what has no label; published values are added
  double panel_height = 1.45;  ///< [in]
  int columns = 1;
};
void draw(const Chart& chart, PlotFormat format, const std::filesystem::path& file);

struct TableColumn {
  std::string name, unit, long_name;
  std::vector<double> values;
};
/// The data behind a figure: columns over the first one.
struct Table {
  std::vector<TableColumn> columns;
  void add(std::string name, std::string unit, std::string long_name, std::vector<double> values);
};
std::string csv(const Table& table);
void write_netcdf(const Table& table, const Provenance& provenance, const std::filesystem::path& file);

struct Sheet {
  std::string id;       ///< of its files: "figure-04"
  std::string heading;  ///< "Figure 4: electrical input power against flapping frequency"
  std::string caption;  ///< plain text: what is seen, and how it compares with the paper
  Table table;
  std::function<void(PlotFormat, const std::filesystem::path&)> draw;
  std::string animation;  ///< an SVG that moves, beside the figure; may be empty
  std::string section;    ///< of the report
  bool wide = false;      ///< of the width of a page
};

/// What all figures are made from.
struct Material {
  const PublishedFile& file;
  const SpringPair& pair;
  const Reproduction& computed;
  const Assessment& assessment;
  const std::vector<FurtherVariant>& further;
};

std::vector<Sheet> summary_sheets(const Material& m);
std::vector<Sheet> further_sheets(const Material& m);
std::vector<Sheet> mechanism_sheets(const Material& m);
std::vector<Sheet> paper_sheets(const Material& m);
std::vector<Sheet> section5_sheets(const Material& m);
std::vector<Sheet> friction_sheets(const Material& m);
std::vector<Sheet> energy_sheets(const Material& m);

/// The whole report; `svg_of` gives the drawing of a sheet.
std::string report_html(const Material& m, const std::vector<Sheet>& sheets, const std::string& version,
                        const std::function<std::string(const Sheet&)>& svg_of);

/// A cycle among those computed; nullptr where the vehicle does not flap there.
const CycleCase* cycle_of(const std::vector<CycleCase>& cycles, Formulation formulation, bool springs);

}  // namespace wingbeat::reproduction
