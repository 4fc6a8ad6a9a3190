#include "wingbeat/files/bench_file.hpp"

#include <gmock/gmock.h>

#include <algorithm>
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
  EXPECT_EQ(
      log_error("current_mA\n180\n", request),
      "air.csv:1:1: crank_angle: missing column: a waveform needs crank_angle_deg, phase_deg (equal steps in time) or "
      "time_s");
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
  EXPECT_EQ(log_error("voltage_V,current_mean_mA\n2,120\n3,-180\n"),
            "air.csv:3:3: current_mean: must not be negative, got -180");
  EXPECT_EQ(log_error("voltage_V,frequency_Hz\n-3,22\n"), "air.csv:2:1: voltage: must be > 0, got -3");
  EXPECT_EQ(log_error("voltage_V,frequency_Hz\n3,fast\n"), "air.csv:2:3: frequency: expected a number, got \"fast\"");
  EXPECT_EQ(log_error("voltage_V,frequency_Hz\n3,1e999\n"), "air.csv:2:3: frequency: expected a number, got \"1e999\"");
  EXPECT_EQ(log_error("voltage_V,frequency_Hz,lift_mean_mN\n3,22,\n4,30,nan\n"),
            "air.csv: lift_mean: the column \"lift_mean_mN\" holds no numbers");
  EXPECT_EQ(log_error("voltage_V,frequency_Hz\n3\n"), "air.csv:2:1: expected 2 values, got 1");
  EXPECT_EQ(log_error("voltage_V,frequency_Hz\n"), "air.csv:1:1: holds no rows");
  EXPECT_THAT(log_error(""), HasSubstr("air.csv: is empty"));
}

// A file as benches, spreadsheets and loggers write it, and the same file as the program would.
class MessyLog : public testing::Test {
 protected:
  void expect_same(const std::string& text, const LogRequest& request = {}) {
    BenchLog log;
    notes = {};
    ASSERT_NO_THROW(log = parse_log(text, "messy.csv", request, &notes)) << log_error(text, request);
    ASSERT_EQ(log.columns, plain.columns);
    ASSERT_EQ(log.rows.size(), plain.rows.size());
    for (std::size_t r = 0; r < log.rows.size(); ++r) {
      EXPECT_NEAR(log.rows[r].given, plain.rows[r].given, 1e-12);
      for (std::size_t c = 0; c < log.columns.size(); ++c) {
        EXPECT_NEAR(log.rows[r].values[c], plain.rows[r].values[c], 1e-12 * plain.rows[r].values[c]);
      }
    }
  }
  const BenchLog plain = parse_log(
      "voltage_V,frequency_Hz,current_mean_mA,lift_mean_mN\n2,15.25,120.5,4.903325\n3,22,180,9.80665\n", "p.csv", {});
  LogNotes notes;
};

TEST_F(MessyLog, Separators) {
  expect_same("voltage_V;frequency_Hz;current_mean_mA;lift_mean_mN\n2;15.25;120.5;4.903325\n3;22;180;9.80665\n");
  EXPECT_EQ(notes.separator, ';');
  expect_same("voltage_V\tfrequency_Hz\tcurrent_mean_mA\tlift_mean_mN\n2\t15.25\t120.5\t4.903325\n3\t22\t180\t9.80665");
  EXPECT_EQ(notes.separator, '\t');
  expect_same("sep=;\nvoltage_V;frequency_Hz;current_mean_mA;lift_mean_mN\n2;15.25;120.5;4.903325\n3;22;180;9.80665\n");
  expect_same(
      "\"voltage_V\",\"frequency_Hz\",\"current_mean_mA\",\"lift_mean_mN\"\n\"2\",\"15.25\",\"120.5\",\"4.903325\"\n"
      "\"3\",22,180,9.80665\n");
}

TEST_F(MessyLog, DecimalComma) {
  expect_same("voltage_V;frequency_Hz;current_mean_mA;lift_mean_mN\n2,0;15,25;120,5;4,903325\n3;22;180;9,80665\n");
  EXPECT_TRUE(notes.decimal_comma);
  expect_same(
      "voltage_V,frequency_Hz,current_mean_mA,lift_mean_mN\n2,\"15,25\",\"120,5\",\"4,903325\"\n"
      "3,22,180,\"9,80665\"\n");
  EXPECT_TRUE(notes.decimal_comma);
  EXPECT_THAT(log_error("voltage_V,frequency_Hz\n2,0,15,25\n3,0,22,0\n"),
              HasSubstr("decimal commas between commas are ambiguous"));
}

TEST_F(MessyLog, AGuessThatMayBeWrongIsAQuestion) {
  const std::string open = "voltage_V;current_mean_mA\n2;1,204\n3;1,801\n";
  EXPECT_EQ(log_error(open),
            "air.csv:2:3: is \"1,204\" a decimal fraction or a number of thousands? Say decimal = \",\" or \".\" in "
            "[[log]]");
  LogRequest request;
  request.decimal = ',';
  EXPECT_NEAR(parse_log(open, "a.csv", request).rows[0].values[0], 1.204e-3, 1e-15);
  request.decimal = '.';
  EXPECT_THAT(log_error(open, request), HasSubstr("expected a number, got \"1,204\""));
  EXPECT_THAT(log_error("voltage_V;current_mean_mA\n2.5;1,2\n"), HasSubstr("which is the decimal sign?"));
  const std::string either = "voltage_V;lift_mean_mN,current_mean_mA\n2;3,4\n";
  EXPECT_THAT(log_error(either), HasSubstr("are the cells separated by a comma or by a semicolon?"));
  EXPECT_THAT(log_error("voltage_V,current_mean_A,I (A)\n3,0.18,0.19\n"),
              HasSubstr("current_mean: is given twice, as \"current_mean_A\" and as \"I (A)\"; columns = { \"I (A)\" = "
                        "\"ignore\" }"));
  EXPECT_THAT(log_error("voltage_V,force_N\n3,0.18\n"), HasSubstr("unknown column \"force_N\""));
  EXPECT_THAT(log_error("voltage_V,F (N)\n3,0.18\n"), HasSubstr("unknown column \"F (N)\""));
}

TEST_F(MessyLog, NamesAndUnitsInUse) {
  expect_same("Voltage (V),Frequency [Hz],current_mA,Lift (g)\n2,15.25,120.5,0.5\n3,22,180,1\n");
  EXPECT_TRUE(notes.columns[2].renamed);
  EXPECT_EQ(notes.columns[3].name, "lift_mean");
  expect_same("U [mV];f [rpm];I / A;Thrust_gf\n2000;915;0.1205;0.5\n3000;1320;0.18;1\n");
  expect_same(
      "Supply Voltage [V],Flapping frequency (1/min),Mean current (mA),mean lift [mgf]\n2,915,120.5,500\n"
      "3,1320,180,1000\n");
  expect_same(
      "voltage_V,freq_Hz,Average current (\xC2\xB5"
      "A),lift_kgf\n2,15.25,120500,0.0005\n3,22,180000,0.001\n");
  LogRequest request;
  request.columns = {{"Kraft links (mN)", "lift_mean"}, {"Bemerkung", "ignore"}};
  expect_same(
      "voltage_V,frequency_Hz,current_mA,Kraft links (mN),Bemerkung\n2,15.25,120.5,4.903325,ok\n"
      "3,22,180,9.80665,warm\n",
      request);
  EXPECT_EQ(notes.columns[4].name, "");
  request.columns = {{"Kraft", "lift_mean_mN"}};
  expect_same("voltage_V,frequency_Hz,current_mA,Kraft\n2,15.25,120.5,4.903325\n3,22,180,9.80665\n", request);
  request.columns = {{"Schub", "lift_mean"}};
  EXPECT_THAT(log_error("voltage_V,lift_mN\n2,3\n", request),
              HasSubstr("columns names \"Schub\", which the header has not"));
}

TEST_F(MessyLog, OrderRepeatsAndGaps) {
  expect_same("voltage_V,frequency_Hz,current_mean_mA,lift_mean_mN\n3,22,180,9.80665\n2,15.25,120.5,4.903325\n");
  EXPECT_FALSE(notes.sorted);
  const BenchLog log = parse_log(
      "voltage_V,frequency_Hz,lift_mean_mN\n3,22,8\n2,15,\n3,22.1,NaN\n,30,9\n4,,n/a\n,,\n1,8,1\n", "air.csv", {});
  ASSERT_EQ(log.rows.size(), 4U);
  const int lines[] = {8, 3, 2, 4};
  for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(log.rows[n].line, lines[n]);
  EXPECT_EQ(log.values_left_out, 2);
  EXPECT_EQ(log.rows_left_out, (std::vector<int>{5, 6}));
  EXPECT_TRUE(std::isnan(log.rows[1].values[1]));
}

TEST_F(MessyLog, EncodingsRemarksAndLineEnds) {
  const std::string text =
      "% made by a logger\r\n// second line\r\nvoltage_V,frequency_Hz,current_mean_mA,lift_mean_mN\r\n"
      "2,15.25,120.5,4.903325\r\n"
      "\r\n# half way\r\n3,22,180,9.80665\r\n";
  expect_same("\xEF\xBB\xBF" + text);
  EXPECT_EQ(notes.remarks, 3);
  std::string old = text;
  old.erase(std::remove(old.begin(), old.end(), '\n'), old.end());
  expect_same(old);
  std::string wide = "\xFF\xFE";
  for (const char c : text) wide += {c, '\0'};
  expect_same(wide);
  EXPECT_EQ(notes.encoding, "UTF-16LE");
  expect_same(
      "voltage_V,frequency_Hz,current (\xB5"
      "A),lift_mean_mN\n2,15.25,120500,4.903325\n3,22,180000,9.80665\n");
  EXPECT_EQ(notes.encoding, "WINDOWS-1252");
  EXPECT_THAT(log_error(std::string("\xFF\xFE"
                                    "a")),
              HasSubstr("is marked as UTF-16LE and is not"));
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

TEST_F(BenchFile, SaysHowAFileIsWritten) {
  write("air.csv", "Spannung;Frequenz;Auftrieb (mN);Notiz\n2,5;14,004;1,204;x\n3,1;22,001;8,735;\n");
  write("bench.toml", head + parameter + deviation + log +
                          "separator = \";\"\ndecimal = \",\"\ncolumns = { Spannung = \"voltage_V\", Frequenz = "
                          "\"frequency_Hz\", \"Auftrieb (mN)\" = \"lift_mean\", Notiz = \"ignore\" }\n");
  std::vector<LogNotes> notes;
  const BenchFit fit = read_bench(folder_ / "bench.toml", {}, &notes);
  EXPECT_NEAR(fit.logs[0].rows[0].values[1], 1.204e-3, 1e-15);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].columns[1].name, "frequency");
  EXPECT_THAT(error_of(head + parameter + deviation + log + "separator = \"|\"\n"),
              HasSubstr("log[1].separator: must be \",\", \";\" or \"\\t\", got \"|\""));
  EXPECT_THAT(error_of(head + parameter + deviation + log +
                       "columns = { Spannung = \"voltage_V\", Frequenz = \"frequency_Hz\", "
                       "\"Auftrieb (mN)\" = \"lift_mean\", Notiz = \"remarks\" }\n"),
              HasSubstr("columns names \"remarks\", which is no quantity"));
}

/// Signals of 21 Hz over half a second in two bursts, in columns of mA and deg.
std::string record_text(const char* header, bool times, bool bursts) {
  std::string text = std::string(header) + "\n";
  for (int burst = 0; burst < 2; ++burst) {
    for (int n = 0; n < 300; ++n) {
      const double t = n / 600.0, turns = (21.0 + burst) * t;
      const std::string place = (bursts ? std::to_string(burst + 3) + "," : "") +
                                (times ? std::to_string(1e3 * (t + 0.5 * burst)) + "," : "");
      const double current = 200.0 + 30.0 * std::cos(two_pi * turns) + 20.0 * std::sin(2.0 * two_pi * turns);
      text += place + std::to_string(2.9 + 0.1 * burst) + "," + std::to_string(current) + "," +
              std::to_string(40.0 * std::sin(two_pi * turns)) + "\n";
    }
  }
  return text;
}

TEST_F(BenchFile, RecordsOfSignalsBecomeMeanCycles) {
  const std::string of_record = "[[log]]\nfile = \"signals.csv\"\ncondition = \"air\"\n";
  write("signals.csv", record_text("burst,Time (ms),U (V),I (mA),stroke_deg", true, true));
  write("bench.toml", head + parameter + of_record + "unknown_zero = [\"stroke_angle\"]\n");
  std::vector<LogNotes> notes;
  const BenchFit fit = read_bench(folder_ / "bench.toml", {}, &notes);
  const BenchLog& log = fit.logs.at(0);
  EXPECT_TRUE(log.waveform && log.in_time && !log.phase_known && !log.frequency_stated);
  ASSERT_EQ(log.columns.size(), 3U);
  EXPECT_EQ(name_of(log.columns[0]), "instantaneous current");
  EXPECT_EQ(name_of(log.columns[1]), "instantaneous stroke_angle");
  EXPECT_EQ(name_of(log.columns[2]), "frequency_hz");
  ASSERT_EQ(notes[0].bursts.size(), 2U);
  EXPECT_EQ(notes[0].bursts[1].line, 302);
  EXPECT_NEAR(notes[0].bursts[1].frequency, 22.0, 1e-4);
  EXPECT_NEAR(notes[0].bursts[0].given, 2.9, 1e-9);
  EXPECT_NEAR(log.rows.front().values[2], 21.0, 1e-4);
  EXPECT_TRUE(std::isnan(log.rows[1].values[2]));
  EXPECT_NEAR(log.rows.back().given, 3.0, 1e-9);
  EXPECT_EQ(log.rows.front().burst, 3);
  for (const BenchRow& row : log.rows) {
    const double turns = row.crank_angle / two_pi;
    EXPECT_NEAR(row.values[0], 0.2 + 0.03 * std::cos(two_pi * turns) + 0.02 * std::sin(2.0 * two_pi * turns), 1e-6);
    EXPECT_GT(row.deviations[0], 0.0);
  }
  EXPECT_EQ(fit.deviations.at({true, {}, WaveformQuantity::current}).kind, Deviation::Kind::scatter);

  // Without times and bursts, cut by duration; stated deviations replace those of the scatter.
  write("signals.csv", record_text("U (V),I (mA),stroke_deg", false, false));
  write("bench.toml", head + parameter + "[deviation]\ncurrent = { absolute = \"1 mA\" }\n" + of_record +
                          "sampling_rate = \"600 Hz\"\nburst = \"0.5 s\"\ntriggered = true\n");
  const BenchFit stated = read_bench(folder_ / "bench.toml");
  EXPECT_EQ(stated.logs[0].rows.back().burst, 2);
  EXPECT_TRUE(stated.logs[0].phase_known);
  EXPECT_TRUE(std::isnan(stated.logs[0].rows[0].deviations[0]));
  EXPECT_EQ(stated.deviations.at({true, {}, WaveformQuantity::current}).value, 1e-3);
  EXPECT_EQ(stated.deviations.at({true, {}, WaveformQuantity::stroke_angle}).kind, Deviation::Kind::scatter);
}

// A direct drive under a sine whose frequency rises: each burst has its amplitude and frequency from the voltage.
TEST_F(BenchFile, BurstsOfARampHaveTheirOwnFrequency) {
  std::string text = "t [s];U [V];I [mA]\n";
  const double rate = 2.0;
  for (int n = 0; n <= 6000; ++n) {
    const double t = n / 2000.0, turns = (20.0 + 0.5 * rate * t) * t;
    text += std::to_string(t) + ";" + std::to_string(2.5 * std::sin(two_pi * turns)) + ";" +
            std::to_string(80.0 * std::sin(two_pi * turns - 0.4)) + "\n";
  }
  write("signals.csv", text);
  write(
      "bench.toml",
      "[bench]\nvehicle = \"two-wing-direct.toml\"\n[[parameter]]\nkey = \"motor.viscous_damping\"\nlower = 0\nupper "
      "= \"1e-4 N m s/rad\"\n[[log]]\nfile = \"signals.csv\"\ncondition = \"air\"\nsprings = true\nburst = \"1 s\"\n");
  std::vector<LogNotes> notes;
  const BenchFit fit = read_bench(folder_ / "bench.toml", {}, &notes);
  ASSERT_EQ(notes[0].bursts.size(), 3U);
  for (int n = 0; n < 3; ++n) {
    EXPECT_NEAR(notes[0].bursts[std::size_t(n)].frequency, 20.0 + rate * (n + 0.5), 2e-3) << n;
    EXPECT_NEAR(notes[0].bursts[std::size_t(n)].rate, rate, 1e-2) << n;
    EXPECT_NEAR(notes[0].bursts[std::size_t(n)].given, 2.5, 2.5e-3) << n;
  }
  const BenchLog& log = fit.logs.at(0);
  ASSERT_EQ(log.columns.size(), 2U);  // the voltage shows the phase
  EXPECT_NEAR(log.rows.back().drive_frequency, 25.0, 2e-3);
}

TEST_F(BenchFile, AveragedWaveformsHaveTheirScatter) {
  write("cycle.csv", "phase_deg,current_mA,current_std_mA\n0,200,4\n90,210,8\n180,190,4\n");
  write("bench.toml",
        head + parameter + "[[log]]\nfile = \"cycle.csv\"\ncondition = \"air\"\nvoltage = \"3 V\"\ncycles = 16\n");
  const BenchFit fit = read_bench(folder_ / "bench.toml");
  ASSERT_EQ(fit.logs[0].columns.size(), 1U);
  EXPECT_TRUE(fit.logs[0].in_time);
  EXPECT_NEAR(fit.logs[0].rows[1].deviations[0], 2e-3, 1e-15);
  EXPECT_EQ(fit.deviations.at({true, {}, WaveformQuantity::current}).kind, Deviation::Kind::scatter);
}

TEST_F(BenchFile, ReadsABalance) {
  const std::string balance = "[balance]\nmass = \"8 g\"\nstiffness = \"2 kN/m\"\ndamping = \"0.2 N s/m\"\n";
  const std::string of_balance = "[[parameter]]\nkey = \"balance.damping\"\nlower = \"0 N s/m\"\nupper = \"1 N s/m\"\n";
  write("bench.toml", head + balance + of_balance + deviation + log);
  const BenchFit fit = read_bench(folder_ / "bench.toml");
  EXPECT_NEAR(fit.balance->stiffness, 2e3, 1e-9);
  ASSERT_EQ(fit.parameters.size(), 1U);
  EXPECT_EQ(fit.parameters[0].start, 0.2);
  EXPECT_EQ(fit.parameters[0].of_bench->of_balance->number, &Balance::damping);
  EXPECT_THAT(error_of(head + of_balance + deviation + log), HasSubstr("balance.damping needs the section [balance]"));
  EXPECT_THAT(
      error_of(head + "[balance]\nmass = \"0 g\"\nstiffness = \"2 kN/m\"\ndamping = 0\n" + parameter + deviation + log),
      HasSubstr("balance.mass: must be > 0"));
}

TEST_F(BenchFile, RecordsThatCannotBeUsedAreRefused) {
  const std::string of_record = "[[log]]\nfile = \"signals.csv\"\ncondition = \"air\"\n";
  write("signals.csv", "time_s,current_mA\n0,1\n0.1,2\n0.2,1\n");
  EXPECT_THAT(error_of(head + parameter + of_record), HasSubstr("voltage: missing: give voltage = \"3 V\""));
  EXPECT_THAT(error_of(head + parameter + of_record + "voltage = \"3 V\"\n"),
              HasSubstr("signals.csv:2:1: time: a mean cycle needs at least 32 samples, got 3"));
  EXPECT_THAT(error_of(head + parameter + of_record + "voltage = \"3 V\"\nburst = \"1 ns\"\n"),
              HasSubstr("burst: 1e-09 s cuts the record into more bursts than it has rows"));
  EXPECT_THAT(error_of(head + parameter + of_record + "voltage = \"3 V\"\nunknown_zero = [\"lift\"]\n"),
              HasSubstr("needs at least 32 samples"));
  EXPECT_THAT(error_of(head + parameter + deviation + log + "burst = \"1 s\"\n"),
              HasSubstr("log[1].burst: is of a record in time, and the file has no times"));
  EXPECT_THAT(error_of(head + parameter + deviation + log + "unknown_zero = [\"lift\"]\n"),
              HasSubstr("the log has no waveform of lift"));
  EXPECT_THAT(error_of(head + parameter + deviation + log + "unknown_zero = [\"weight\"]\n"),
              HasSubstr("expected a list of quantities"));
  write("signals.csv", "crank_angle_deg,current_std_mA\n0,1\n90,2\n");
  EXPECT_THAT(error_of(head + parameter + of_record + "voltage = \"3 V\"\n"),
              HasSubstr("is the scatter of a column that the file has not"));
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
              HasSubstr("air.csv:2:1: lift_mean: is 0: give an absolute standard deviation"));
}

}  // namespace
}  // namespace wingbeat
