#include "wingbeat/files/bench_file.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "wingbeat/files/design_file.hpp"

namespace wingbeat {
namespace {

using testing::HasSubstr;

std::string log_error(const std::string& text, const LogRequest& request = {}) {
  try {
    parse_log(text, "air.csv", request);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BenchLog, ReadsColumnsInAnyUnitAndForm) {
  const std::string header[] = {"voltage_V,frequency_Hz,current_mean_mA,lift_mean_mN",
                                "voltage [V],frequency [Hz],current_mean (mA),lift_mean [mN]"};
  for (const std::string& h : header) {
    const BenchLog log = parse_log("# a comment\n" + h + "\n\n2.0, 15, 120, -0.5\n3.0, 22, 180, 8.7\n", "air.csv", {});
    ASSERT_EQ(log.rows.size(), 2U);
    EXPECT_EQ(log.given, Given::voltage);
    EXPECT_EQ(log.rows[1].given, 3.0);
    EXPECT_EQ(log.rows[1].line, 5);
    EXPECT_EQ(log.columns[1].metric, Metric::current_mean);
    EXPECT_NEAR(log.rows[1].values[1], 0.18, 1e-15);
    EXPECT_NEAR(log.rows[0].values[2], -0.5e-3, 1e-15);
  }
}

TEST(BenchLog, TakesTheKeysOfJsonAsSi) {
  const BenchLog log = parse_log(
      "frequency_hz,voltage_v,flapping_velocity_peak_rad_per_s,angle_of_attack_min_deg\n"
      "20,3,90,60\n",
      "air.csv", {.log = {}, .given = Given::frequency, .given_value = {}, .measured = {}});
  EXPECT_EQ(log.given, Given::frequency);
  EXPECT_EQ(log.rows[0].given, 20.0);
  EXPECT_EQ(log.columns[0].metric, Metric::voltage);
  EXPECT_EQ(log.rows[0].values[1], 90.0);
  EXPECT_EQ(log.rows[0].values[2], 60.0);
}

TEST(BenchLog, WaveformsHaveACrankAngle) {
  LogRequest request;
  request.given = Given::voltage;
  request.given_value = 3.0;
  const BenchLog log =
      parse_log("crank_angle_deg,current_mA,crank_speed [rpm]\n0,180,1300\n90,190,1200\n", "w.csv", request);
  EXPECT_TRUE(log.waveform);
  EXPECT_NEAR(log.rows[1].crank_angle, pi / 2.0, 1e-15);
  EXPECT_NEAR(log.rows[1].values[1], 1200.0 * pi / 30.0, 1e-9);
  EXPECT_EQ(log_error("current_mA\n180\n", request),
            "air.csv:1:1: crank_angle: missing column: a waveform needs crank_angle_rad or crank_angle_deg");
}

TEST(BenchLog, MeasuredRestrictsTheColumns) {
  LogRequest request;
  request.measured = {"current_mean"};
  const BenchLog log = parse_log("voltage_V,frequency_Hz,current_mean_mA\n3,22,180\n", "air.csv", request);
  ASSERT_EQ(log.columns.size(), 1U);
  EXPECT_EQ(log.columns[0].metric, Metric::current_mean);
  request.measured = {"lift_mean"};
  EXPECT_EQ(log_error("voltage_V,frequency_Hz\n3,22\n", request),
            "air.csv:1:1: lift_mean: missing column: [[log]] names it as measured");
}

TEST(BenchLog, RefusalsNameFileLineAndReason) {
  EXPECT_THAT(log_error("voltage_V,current_mean_mV\n3,180\n"),
              HasSubstr("air.csv:1:11: current_mean: the unit \"mV\" is wrong: expected "));
  EXPECT_EQ(log_error("voltage_V,current_mean\n3,180\n"),
            "air.csv:1:11: current_mean: names no unit; write current_mean_A or current_mean [A]");
  EXPECT_THAT(log_error("voltage_V,curent_mean_mA\n3,180\n"),
              HasSubstr("unknown column \"curent_mean_mA\"; did you mean"));
  EXPECT_EQ(log_error("current_mean_mA\n180\n"),
            "air.csv:1:1: frequency: missing column: a log needs the voltage or the frequency that was set");
  EXPECT_EQ(log_error("voltage_V,frequency_Hz,frequency_Hz\n3,22,22\n"), "air.csv:1:24: frequency: is given twice");
  EXPECT_EQ(log_error("voltage_V\n3\n"), "air.csv:1:1: no measured column beside what was set");
  EXPECT_EQ(log_error("voltage_V,frequency_Hz\n3,22\n2,15\n"),
            "air.csv:3:1: voltage: rows must be sorted: smaller than in line 2");
  EXPECT_EQ(log_error("voltage_V,frequency_Hz\n3,22\n3,22.1\n"),
            "air.csv:3:1: voltage: the same value as in line 2: a row stands twice");
  EXPECT_EQ(log_error("voltage_V,current_mean_mA\n2,120\n3,-180\n"),
            "air.csv:3:3: current_mean: must not be negative, got -180");
  EXPECT_EQ(log_error("voltage_V,frequency_Hz\n-3,22\n"), "air.csv:2:1: voltage: must be > 0, got -3");
  EXPECT_EQ(log_error("voltage_V,frequency_Hz\n3,\n"), "air.csv:2:3: frequency: expected a number, got \"\"");
  EXPECT_EQ(log_error("voltage_V,frequency_Hz\n3,nan\n"), "air.csv:2:3: frequency: expected a number, got \"nan\"");
  EXPECT_EQ(log_error("voltage_V,frequency_Hz\n3\n"), "air.csv:2:1: expected 2 values, got 1");
  EXPECT_EQ(log_error("voltage_V,frequency_Hz\n"), "air.csv:1:1: holds no rows");
  EXPECT_THAT(log_error(""), HasSubstr("air.csv: is empty"));
}

class BenchFile : public testing::Test {
 protected:
  BenchFile() {
    std::filesystem::create_directories(folder_);
    using Options = std::filesystem::copy_options;
    std::filesystem::copy(std::string(WINGBEAT_DATA) + "/designs", folder_,
                          Options::recursive | Options::overwrite_existing);
    write("air.csv", "voltage_V,frequency_Hz,lift_mean_mN\n2,14,3\n3,22,8.7\n");
  }
  ~BenchFile() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  std::string error_of(const std::string& text) const {
    write("bench.toml", text);
    try {
      read_bench(folder_ / "bench.toml");
    } catch (const InputError& error) {
      const std::string what = error.what();
      const auto position = what.find(folder_.string());
      return position == 0 ? what.substr(folder_.string().size() + 1) : what;
    }
    return "accepted";
  }
  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string("wingbeat-bench-") + testing::UnitTest::GetInstance()->current_test_info()->name());

  const std::string head = "[bench]\nvehicle = \"friction2022.toml\"\n";
  const std::string parameter = "[[parameter]]\nkey = \"friction.radius\"\nlower = \"0 mm\"\nupper = \"8 mm\"\n";
  const std::string deviation = "[deviation]\ndefault = { relative = 0.01 }\n";
  const std::string log = "[[log]]\nfile = \"air.csv\"\ncondition = \"air\"\n";
};

TEST_F(BenchFile, ReadsAFit) {
  write("bench.toml", head + "[fit]\nloss = \"cauchy\"\nstarts = 5\nseed = 9\n" + parameter +
                          "[deviation]\nfrequency = { absolute = \"100 mHz\" }\nlift_mean = \"estimated\"\n" + log);
  const BenchFit fit = read_bench(folder_ / "bench.toml");
  EXPECT_EQ(fit.loss, Loss::cauchy);
  EXPECT_EQ(fit.starts, 5);
  EXPECT_EQ(fit.seed, 9U);
  ASSERT_EQ(fit.parameters.size(), 1U);
  EXPECT_EQ(fit.parameters[0].start, 2.5e-3);
  EXPECT_EQ(fit.parameters[0].upper, 8e-3);
  ASSERT_EQ(fit.logs.size(), 1U);
  EXPECT_EQ(fit.logs[0].condition, Condition::air);
  EXPECT_EQ(fit.deviations.at({false, Metric::frequency, {}}).value, 0.1);
  EXPECT_EQ(fit.deviations.at({false, Metric::lift_mean, {}}).kind, Deviation::Kind::estimated);
}

TEST_F(BenchFile, RefusalsNamePlaceAndReason) {
  EXPECT_EQ(error_of(head + parameter + deviation + "[[log]]\nfile = \"air.csv\"\n"),
            "bench.toml:9:1: log[1].condition: missing; expected one of air, vacuum, wingless");
  EXPECT_THAT(error_of(head + parameter + deviation + "[[log]]\nfile = \"air.csv\"\ncondition = \"water\"\n"),
              HasSubstr("log[1].condition: expected one of air, vacuum, wingless, got \"water\""));
  EXPECT_THAT(error_of(head + parameter + log), HasSubstr("deviation: missing section [deviation]"));
  EXPECT_THAT(error_of(head + parameter + "[deviation]\nfrequency = \"estimated\"\n" + log),
              HasSubstr("deviation.lift_mean: missing: the standard deviation of this column of"));
  EXPECT_THAT(error_of(head + deviation + log), HasSubstr("which parameters are free?"));
  EXPECT_THAT(error_of(head + parameter + parameter + deviation + log), HasSubstr("friction.radius is given twice"));
  EXPECT_THAT(error_of(head + "[[parameter]]\nkey = \"friction.radus\"\n" + deviation + log),
              HasSubstr("did you mean friction.radius?"));
  EXPECT_THAT(error_of(head + "[[parameter]]\nkey = \"friction.radius\"\nlower = \"3 mm\"\nupper = \"8 mm\"\n" +
                       deviation + log),
              HasSubstr("must lie within the bounds"));
  EXPECT_THAT(error_of(head + "[[parameter]]\nkey = \"motor.inertia\"\nlower = 0\nupper = 1e-6\n" + deviation + log),
              HasSubstr("parameter[1].lower: motor.inertia: must be > 0"));
  EXPECT_THAT(error_of(head + parameter + deviation + "[[log]]\nfile = \"none.csv\"\ncondition = \"air\"\n"),
              HasSubstr("none.csv: no such file"));
  EXPECT_THAT(error_of("[bench]\nvehicle = \"friction2022-springs.toml\"\n" + parameter + deviation + log),
              HasSubstr("log[1].springs: missing; the vehicle file has springs"));
  EXPECT_THAT(error_of(head + parameter + "[deviation]\ndefault = { relative = -1 }\n" + log),
              HasSubstr("must be > 0"));
  write("air.csv", "voltage_V,frequency_Hz,lift_mean_mN\n2,14,0\n3,22,8.7\n");
  EXPECT_THAT(error_of(head + parameter + deviation + log),
              HasSubstr("air.csv:2:1: lift_mean: is 0, of which no relative standard deviation can be taken"));
}

}  // namespace
}  // namespace wingbeat
