#include "wingbeat/files/units.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <thread>
#include <vector>

#include "wingbeat/core/math.hpp"

namespace wingbeat {
namespace {

std::string refusal(std::string_view text, std::string_view unit) {
  try {
    return "accepted as " + std::to_string(parse_quantity(text, unit));
  } catch (const UnitError& error) {
    return error.what();
  }
}

TEST(Units, DecimalPrefixesAreExact) {
  EXPECT_EQ(parse_quantity("5 mm", "m"), 0.005);
  EXPECT_EQ(parse_quantity("29 mH", "H"), 0.029);
  EXPECT_EQ(parse_quantity("3.34 g", "kg"), 0.00334);
  EXPECT_EQ(parse_quantity("0.1e3 um", "m"), 0.0001);
  EXPECT_EQ(parse_quantity("2.5 cm4", "m4"), 2.5e-8);
  EXPECT_EQ(parse_quantity("-5e-1 mm", "m"), -0.0005);
  EXPECT_EQ(parse_quantity("0e99 mm", "m"), 0.0);
}

TEST(Units, AnSiUnitIsTheNumberItself) {
  EXPECT_EQ(parse_quantity("1.377e-3 N m/rad", "N m/rad"), 1.377e-3);
  EXPECT_EQ(parse_quantity("22 Hz", "Hz"), 22.0);
  EXPECT_EQ(parse_quantity("9 ohm", "ohm"), 9.0);
  EXPECT_EQ(parse_quantity("7.205e-8 kg m2", "kg m2"), 7.205e-8);
  EXPECT_EQ(parse_quantity("1.225 kg/m3", "kg/m3"), 1.225);
  EXPECT_EQ(parse_quantity("2.457e-6 m4", "m4"), 2.457e-6);
  EXPECT_EQ(parse_quantity("3e-9 N m s2/rad2", "N m s2/rad2"), 3e-9);
  EXPECT_EQ(parse_quantity("0.005", "m"), 0.005);
  EXPECT_EQ(parse_quantity("+.5", "1"), 0.5);
}

TEST(Units, SpellingsOfWordProcessors) {
  EXPECT_EQ(parse_quantity("5\u00a0mm", "m"), 0.005);
  EXPECT_EQ(parse_quantity("2 m⁴", "m4"), 2.0);
  EXPECT_EQ(parse_quantity("9 Ω", "ohm"), 9.0);
  EXPECT_EQ(parse_quantity("1.5e-7 kg·m²", "kg m2"), 1.5e-7);
  EXPECT_DOUBLE_EQ(parse_quantity("2°", "rad"), 2.0 / degrees_per_radian);
}

TEST(Units, Angles) {
  EXPECT_DOUBLE_EQ(parse_quantity("9.82 deg", "rad"), 9.82 / degrees_per_radian);
  EXPECT_DOUBLE_EQ(parse_quantity("0.25 rev", "rad"), pi / 2.0);
  EXPECT_DOUBLE_EQ(parse_quantity("1000 rpm", "rad/s"), 1000.0 * two_pi / 60.0);
  EXPECT_DOUBLE_EQ(parse_quantity("1320 rpm", "Hz"), 22.0);
  EXPECT_DOUBLE_EQ(parse_quantity("1 rad/s", "Hz"), 1.0 / two_pi);
  EXPECT_DOUBLE_EQ(parse_quantity("1 mV/rpm", "N m/A"), 60e-3 / two_pi);
  EXPECT_EQ(parse_quantity("0.01 V s/rad", "N m/A"), 0.01);
  EXPECT_EQ(parse_quantity("1.4 N m", "N m/rad"), 1.4);
  EXPECT_EQ(refusal("5 Hz", "rad"), "expected an angle such as \"40 deg\", got \"5 Hz\"");
  EXPECT_EQ(refusal("5 %", "rad"), "expected an angle such as \"40 deg\", got \"5 %\"");
  EXPECT_EQ(refusal("5 Hz", "rad/s"),
            "expected an angular speed such as \"100 rad/s\", got \"5 Hz\"; name the angle, as in rad/s, deg/s or rpm");
  EXPECT_EQ(refusal("1 V/Hz", "N m/A"),
            "expected a torque constant such as \"0.01 N m/A\", got \"1 V/Hz\"; a cycle is 2 pi rad, so write s or "
            "rad/s instead of Hz");
  EXPECT_EQ(refusal("1 N m/rad", "N m"), "expected a torque such as \"0.1 mN m\", got \"1 N m/rad\"");
  EXPECT_EQ(refusal("5 deg", "1"), "expected a number such as 2, got \"5 deg\"");
}

TEST(Units, TemperaturesHaveAZero) {
  EXPECT_DOUBLE_EQ(parse_quantity("25 degC", "K"), 298.15);
  EXPECT_DOUBLE_EQ(parse_quantity("-40 degF", "K"), 233.15);
  EXPECT_EQ(parse_quantity("300 K", "K"), 300.0);
  EXPECT_EQ(parse_quantity("300", "K"), 300.0);
  EXPECT_DOUBLE_EQ(parse_quantity("373.15 K", "degC"), 100.0);
  EXPECT_EQ(parse_quantity("100", "degC"), 100.0);
  EXPECT_EQ(parse_quantity("20 K/W", "K/W"), 20.0);
  EXPECT_EQ(parse_quantity("-0.001 K-1", "1/K"), -0.001);
  EXPECT_THROW(parse_quantity("25 degC 2", "K"), UnitError);
  EXPECT_THROW(parse_quantity("25 mm", "K"), UnitError);
  EXPECT_THROW(parse_quantity("25 degC", "1/K"), UnitError);
}

TEST(Units, RefusesWhatIsNotTheQuantity) {
  EXPECT_EQ(refusal("5 kg", "m"), "expected a length such as \"5 mm\", got \"5 kg\"");
  EXPECT_EQ(refusal("5 s", "Hz"), "expected a frequency such as \"22 Hz\", got \"5 s\"");
  EXPECT_EQ(refusal("5 furlog", "m"),
            "expected a length such as \"5 mm\", got \"5 furlog\" with the unknown unit \"furlog\"");
  EXPECT_EQ(refusal("5 degC", "K/W"),
            "expected a thermal resistance such as \"20 K/W\", got \"5 degC\"; \"degC\" has an offset or a logarithm");
  for (const char* text : {"mm", "nan mm", "inf", "-inf", "", " ", "+-5 mm", "five mm"}) {
    EXPECT_THAT(refusal(text, "m"), testing::HasSubstr(", which does not begin with a number")) << text;
  }
  for (const char* text : {"5 2 mm", "5 m 2", "5 m.5", "5 mm - 3", "5 3", "5 3/m"}) {
    EXPECT_THAT(refusal(text, "m"), testing::HasSubstr(", which holds a second number")) << text;
  }
  EXPECT_EQ(refusal("5,3 mm", "m"),
            "expected a length such as \"5 mm\", got \"5,3 mm\"; write a decimal point, not a comma");
  for (const char* text : {"1e400 m", "1e308 km", "1e-400 m"}) {
    EXPECT_THAT(refusal(text, "m"), testing::HasSubstr(", a number too large or too small to store")) << text;
  }
  EXPECT_EQ(parse_quantity("0.2 1/s", "Hz"), 0.2);
  EXPECT_EQ(parse_quantity("0.2 s-1", "Hz"), 0.2);
}

TEST(Units, ANumberAfterTheUnitIsNeverAFactor) {
  for (const char* text : {"1 mm·5", "1 mm²·5", "1 mm·5e0", "1 mm·-5", "1 m° 5", "1 m*5", "1 m.5", "5·2 mm", "1 m×5"}) {
    EXPECT_THAT(refusal(text, "m"), testing::HasSubstr(", which holds a second number")) << text;
  }
  EXPECT_THAT(refusal("1 mm²5", "m2"), testing::HasSubstr(", which holds a second number"));
  EXPECT_EQ(parse_quantity("2 mΩ2/ohm", "ohm"), 2e-6);
}

TEST(Units, WordsOfCatalogues) {
  EXPECT_EQ(parse_quantity("50 mAh", "C"), 180.0);
  EXPECT_EQ(parse_quantity("0.05Ah", "C"), 180.0);
  EXPECT_EQ(parse_quantity("0.1 mNm", "N m"), 1e-4);
  EXPECT_EQ(parse_quantity("0.1 Nm", "N m"), 0.1);
  EXPECT_EQ(parse_quantity("100 uNm", "N m"), 1e-4);
  EXPECT_EQ(parse_quantity("100 µNm", "N m"), 1e-4);
  EXPECT_EQ(parse_quantity("2 Nmm", "N m"), 0.002);
  EXPECT_EQ(parse_quantity("2 Ncm", "N m"), 0.02);
  EXPECT_EQ(parse_quantity("7.6 mNm/A", "N m/A"), 0.0076);
  EXPECT_EQ(parse_quantity("1.4 mNm/rad", "N m/rad"), 0.0014);
  EXPECT_EQ(parse_quantity("3.6e-6 Nms/rad", "N m s/rad"), 3.6e-6);
  EXPECT_EQ(parse_quantity("3 mVs/rad", "N m/A"), 0.003);
  EXPECT_DOUBLE_EQ(parse_quantity("1320 RPM", "Hz"), 22.0);
  for (const char* text : {"0.12 gcm2", "0.12 gcm²", "0.12 gcm^2", "0.12 gcm**2", "0.12 g cm2", "0.12 g·cm²", "12 gmm2",
                           "12e3 mgmm2", "1.2e-2 kgmm2", "1.2e-8 kgm2", "1.2e-4 kgcm2"}) {
    EXPECT_DOUBLE_EQ(parse_quantity(text, "kg m2"), 1.2e-8) << text;
  }
  // Still no other dimension, and no longer word.
  EXPECT_EQ(refusal("1 Nm", "N m/A"), "expected a torque constant such as \"0.01 N m/A\", got \"1 Nm\"");
  EXPECT_EQ(refusal("1 gcm2", "N m"), "expected a torque such as \"0.1 mN m\", got \"1 gcm2\"");
  EXPECT_EQ(refusal("1 nm", "N m"), "expected a torque such as \"0.1 mN m\", got \"1 nm\"");
  EXPECT_THAT(refusal("1 mAh", "A"), testing::HasSubstr("expected a current"));
  EXPECT_THAT(refusal("1 gcm3", "kg m2"), testing::HasSubstr("unknown unit \"gcm3\""));
  EXPECT_THAT(refusal("1 gcm25", "kg m2"), testing::HasSubstr("unknown unit \"gcm25\""));
}

TEST(Units, SpeedConstantsAreTorqueConstantsWhereAskedFor) {
  const auto torque_constant = [](const char* text) { return parse_quantity(text, "N m/A", SpeedConstant::inverted); };
  EXPECT_DOUBLE_EQ(torque_constant("1000 rpm/V"), 60.0 / (two_pi * 1000.0));
  EXPECT_DOUBLE_EQ(torque_constant("1 krpm/V"), 60.0 / (two_pi * 1000.0));
  EXPECT_DOUBLE_EQ(torque_constant("100 rad/s/V"), 0.01);
  EXPECT_EQ(torque_constant("0.01 N m/A"), 0.01);
  EXPECT_EQ(torque_constant("10 mV s/rad"), 0.01);
  EXPECT_THROW(torque_constant("0 rpm/V"), UnitError);
  EXPECT_THROW(torque_constant("-5 rpm/V"), UnitError);
  EXPECT_THROW(torque_constant("1000 rpm"), UnitError);
  EXPECT_EQ(refusal("1000 rpm/V", "N m/A"),
            "expected a torque constant such as \"0.01 N m/A\", got \"1000 rpm/V\"; a speed constant is the reciprocal "
            "of a torque constant: write 0.0095493 N m/A");
  EXPECT_EQ(
      refusal("1000 min-1/V", "N m/A"),
      "expected a torque constant such as \"0.01 N m/A\", got \"1000 min-1/V\"; a speed constant names the angle, "
      "as in rpm/V or rad/s/V");
  EXPECT_THROW(unit_factor("rpm/V", "N m/A"), UnitError);
  EXPECT_THROW(parse_quantity("1000 rpm/V", "kg m2", SpeedConstant::inverted), UnitError);
}

TEST(Units, MessagesStayOnOneLine) {
  EXPECT_EQ(in_quotes("a\nb\x01"), "\"a\\nb\\u0001\"");
  EXPECT_EQ(in_quotes(std::string(59, 'a') + "éb"), "\"" + std::string(59, 'a') + "...\"");
}

TEST(Units, ThreadsShareTheDatabase) {
  std::vector<std::thread> threads;
  std::vector<double> results(4, 0.0);
  for (double& result : results) {
    threads.emplace_back([&result] {
      for (int n = 0; n < 200; ++n) result += parse_quantity("1 N m s/rad", "N m s/rad");
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(results, testing::Each(200.0));
}

}  // namespace
}  // namespace wingbeat
