// Figures of flights.
#include "wingbeat/flight/flight_vehicle.hpp"
#include "wingbeat/report/fly_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace wingbeat {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A flight with rows at these times, at a power of 2 W but for the last row's 7 kW.
std::string drawn_flight(const std::vector<double>& times) {
  FlightVehicle vehicle;
  FlyReport report;
  report.title = "a flight";
  report.vehicle = &vehicle;
  for (const double t : times) {
    FlightRow row;
    row.time = t;
    row.electrical = 2.0;
    report.flight.rows.push_back(row);
  }
  report.flight.rows.back().electrical = 7000.0;
  std::string folder = (std::filesystem::temp_directory_path() / "wingbeat-figure-XXXXXX").string();
  if (!mkdtemp(folder.data())) return {};
  const std::filesystem::path file = std::filesystem::path(folder) / "flight.svg";
  plot_fly(report, PlotFormat::svg, file);
  std::ifstream in(file);
  std::string svg(std::istreambuf_iterator<char>(in), {});
  std::filesystem::remove_all(folder);
  return svg;
}

TEST(FlyPlot, ALastRowWithinAWingbeatOfTheOneBeforeIsNotDrawn) {
  EXPECT_THAT(drawn_flight({0.0, 0.1, 0.2, 0.3}), HasSubstr(">5000<"));
  const std::string cut_short = drawn_flight({0.0, 0.1, 0.2, 0.24});
  EXPECT_THAT(cut_short, HasSubstr("Electrical power"));
  EXPECT_THAT(cut_short, Not(HasSubstr(">5000<")));
}

}  // namespace
}  // namespace wingbeat
