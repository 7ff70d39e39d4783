// What a sensor's table and its input make of a ratio, against the curves themselves in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "node_firmware/heat/sensor_input.hpp"

namespace kinebus::heat {
namespace {

using namespace std::chrono_literals;

double max_error(const SensorSetup& setup, double from, double to,
                 double (*ohm_at)(const SensorSetup&, double)) {
  Linearisation table;
  EXPECT_EQ(table.configure(setup), SetupError::kNone);
  double worst = 0;
  const double reference = setup.reference_mohm / 1000.0;
  for (double t = from; t <= to; t += 0.37) {
    const double r = ohm_at(setup, t);
    const double share = setup.path == SensorPath::kMax31865 ? r / reference : r / (r + reference);
    const auto ratio = static_cast<std::uint32_t>(std::lround(share * kFullRatio));
    worst = std::max(worst, std::abs(table.milli_celsius(ratio) / 1000.0 - t));
  }
  return worst;
}

double rtd_ohm(const SensorSetup& setup, double t) {
  const double nominal = setup.kind == SensorKind::kPt100 ? 100 : 1000;
  return nominal * (1 + 3.9083e-3 * t - 5.775e-7 * t * t);
}
double beta_ohm(const SensorSetup& setup, double t) {
  return setup.nominal_mohm / 1000.0 * std::exp(setup.beta_k * (1 / (t + 273.15) - 1 / 298.15));
}
// The curve through three points, solved here in another way: Newton's method on ln R.
double points_ohm(const std::array<ThermistorPoint, 3>& points, double t) {
  double a[3][4];
  for (int i = 0; i < 3; ++i) {
    const double l = std::log(points[static_cast<std::size_t>(i)].resistance_mohm / 1000.0);
    a[i][0] = 1, a[i][1] = l, a[i][2] = l * l * l;
    a[i][3] = 1 / (points[static_cast<std::size_t>(i)].temperature_mc / 1000.0 + 273.15);
  }
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      if (k == i) continue;
      const double f = a[k][i] / a[i][i];
      for (int j = 0; j < 4; ++j) a[k][j] -= f * a[i][j];
    }
  const double c0 = a[0][3] / a[0][0], c1 = a[1][3] / a[1][1], c2 = a[2][3] / a[2][2];
  double l = std::log(10000.0);
  for (int i = 0; i < 50; ++i) l -= (c0 + c1 * l + c2 * l * l * l - 1 / (t + 273.15)) / (c1 + 3 * c2 * l * l);
  return std::exp(l);
}
double three_points_ohm(const SensorSetup& setup, double t) {
  return points_ohm(setup.points, t);
}

TEST(Thermometry, TablesAreWithinATenthOfAKelvin) {
  SensorSetup setup;
  double worst = 0;
  for (const auto path : {SensorPath::kDivider, SensorPath::kMax31865})
    for (const auto kind : {SensorKind::kPt100, SensorKind::kPt1000}) {
      setup = {.kind = kind, .path = path, .high_mc = 500'000};
      const std::uint32_t nominal = kind == SensorKind::kPt100 ? 100'000 : 1'000'000;
      setup.reference_mohm = path == SensorPath::kMax31865 ? nominal * 43 / 10 : 2'200'000;
      worst = std::max(worst, max_error(setup, 0, 300, rtd_ohm));
    }
  std::printf("resistance thermometers: %.3f K\n", worst);
  EXPECT_LE(worst, 0.1);

  worst = 0;
  for (const std::uint32_t pull_up : {1'000'000u, 2'200'000u, 4'700'000u})
    for (const std::uint32_t beta : {3435u, 3950u, 4267u, 4725u}) {
      setup = {.kind = SensorKind::kCustomBeta, .reference_mohm = pull_up, .beta_k = beta, .low_mc = -5'000};
      worst = std::max(worst, max_error(setup, 0, 300, beta_ohm));
    }
  std::printf("thermistors by beta: %.3f K\n", worst);
  EXPECT_LE(worst, 0.1);

  worst = 0;
  for (const auto& points :
       {std::array<ThermistorPoint, 3>{{{25'000, 100'000'000}, {150'000, 1'770'000}, {250'000, 230'000}}},
        std::array<ThermistorPoint, 3>{{{25'000, 500'000'000}, {200'000, 3'734'000}, {400'000, 240'000}}},
        std::array<ThermistorPoint, 3>{{{20'000, 126'800'000}, {150'000, 1'360'000}, {300'000, 80'650}}}}) {
    setup = {.kind = SensorKind::kCustomThreePoints, .points = points, .low_mc = 0};
    worst = std::max(worst, max_error(setup, 0, 300, three_points_ohm));
  }
  std::printf("thermistors by three points: %.3f K\n", worst);
  EXPECT_LE(worst, 0.1);
}

TEST(Thermometry, KnowsEightThermistorsByName) {
  struct Known {
    std::uint16_t number;
    double ohm_at_25;
  };
  for (const Known known : {Known{10001, 100e3},
                            {10002, 100e3},
                            {10003, 100e3},
                            {10004, 100e3},
                            {10005, 500e3},
                            {10006, 100e3},
                            {10007, 100e3},
                            {10008, 100e3}}) {
    SensorSetup setup{.kind = static_cast<SensorKind>(known.number), .low_mc = 0};
    Linearisation table;
    ASSERT_EQ(table.configure(setup), SetupError::kNone) << known.number;
    const double share = known.ohm_at_25 / (known.ohm_at_25 + 4700);
    EXPECT_NEAR(table.milli_celsius(static_cast<std::uint32_t>(share * kFullRatio)), 25'000, 300)
        << known.number;
    // All of 100 kOhm are hundreds of Ohm at 200 C: a mistyped point would be far off.
    const auto curve = thermistor_curve(setup);
    ASSERT_TRUE(curve.has_value());
    EXPECT_NEAR(std::exp(curve->log_ohm(473.15)), known.number == 10005 ? 3734 : 500, 250) << known.number;
  }
}

TEST(Thermometry, RefusesWhatCannotBe) {
  Linearisation table;
  EXPECT_EQ(table.configure({.kind = static_cast<SensorKind>(7)}), SetupError::kUnknownKind);
  EXPECT_EQ(table.configure({.kind = SensorKind::kGeneric3950, .reference_mohm = 0}), SetupError::kReference);
  EXPECT_EQ(table.configure({.kind = SensorKind::kGeneric3950, .path = SensorPath::kMax31865}),
            SetupError::kReference);
  // 100 kOhm on 10 Ohm: cold cannot be told from open.
  EXPECT_EQ(table.configure({.kind = SensorKind::kGeneric3950, .reference_mohm = 10'000}),
            SetupError::kReference);
  EXPECT_EQ(table.configure({.kind = SensorKind::kGeneric3950, .low_mc = 300'000, .high_mc = 300'000}),
            SetupError::kRange);
  EXPECT_EQ(table.configure({.kind = SensorKind::kGeneric3950, .high_mc = 700'000}), SetupError::kRange);
  SensorSetup rising{.kind = SensorKind::kCustomThreePoints,
                     .points = {{{25'000, 100'000'000}, {150'000, 1'770'000}, {250'000, 2'230'000}}}};
  EXPECT_EQ(table.configure(rising), SetupError::kNotMonotonic);
  rising.points[2] = rising.points[1];
  EXPECT_EQ(table.configure(rising), SetupError::kNotMonotonic);
  EXPECT_EQ(table.kind(), SensorKind::kNone) << "a refused table measures nothing";
}

TEST(Thermometry, AnyRatioGivesAnAnswer) {
  Linearisation table;
  ASSERT_EQ(table.configure({.kind = SensorKind::kGeneric3950, .low_mc = 0}), SetupError::kNone);
  std::int32_t last = table.milli_celsius(0);
  for (std::uint32_t ratio = 0; ratio <= kFullRatio; ratio += 37) {
    const std::int32_t mc = table.milli_celsius(ratio);
    EXPECT_LE(mc, last) << ratio;
    last = mc;
  }
  EXPECT_EQ(table.milli_celsius(~0u), table.milli_celsius(kFullRatio));
}

class Bench {
 public:
  Bench() { EXPECT_EQ(input.configure(setup, now), SetupError::kNone); }
  std::uint32_t ratio_of(double celsius) const {
    const double r = beta_ohm(setup, celsius);
    return static_cast<std::uint32_t>(std::lround(r / (r + 4700) * kFullRatio));
  }
  void sample(std::uint32_t ratio, int times = 1) {
    for (int i = 0; i < times; ++i) {
      now += SensorInput::kSamplePeriod;
      input.on_sample(now, ratio);
      input.on_time(now);
    }
  }
  SensorSetup setup{.kind = SensorKind::kCustomBeta, .low_mc = -5'000};
  SensorInput input;
  LocalTime now{1s};
};

TEST(SensorInput, IsBelievedAfterEightSamples) {
  Bench bench;
  bench.sample(bench.ratio_of(20), 7);
  EXPECT_FALSE(bench.input.good());
  bench.sample(bench.ratio_of(20));
  EXPECT_TRUE(bench.input.good());
  EXPECT_NEAR(bench.input.temperature(), 20'000, 100);
}

TEST(SensorInput, PowerGoesAtTheFirstSuspectSampleAndTheFaultIsTold) {
  struct Case {
    std::uint32_t ratio;
    SensorFault fault;
  };
  for (const Case each : {Case{kFullRatio, SensorFault::kOpen}, Case{0, SensorFault::kShort},
                          Case{Bench().ratio_of(150), SensorFault::kJump}}) {
    Bench bench;
    bench.sample(bench.ratio_of(210), 20);
    ASSERT_TRUE(bench.input.good());
    bench.sample(each.ratio);
    EXPECT_FALSE(bench.input.good()) << "10 ms";
    EXPECT_EQ(bench.input.fault(), SensorFault::kNone);
    bench.sample(each.ratio, 10);
    EXPECT_EQ(bench.input.fault(), each.fault);
    EXPECT_NEAR(bench.input.temperature(), 210'000, 300) << "what is not believed is not shown";
    bench.sample(bench.ratio_of(210), 100);
    EXPECT_FALSE(bench.input.good()) << "a fault stays";
    bench.input.clear(bench.now);
    bench.sample(bench.ratio_of(210), 8);
    EXPECT_TRUE(bench.input.good());
  }
}

TEST(SensorInput, OneDisturbedSampleIsNoFault) {
  Bench bench;
  bench.sample(bench.ratio_of(210), 20);
  for (int i = 0; i < 50; ++i) {
    bench.sample(kFullRatio);
    EXPECT_FALSE(bench.input.good());
    bench.sample(bench.ratio_of(210));
    EXPECT_TRUE(bench.input.good());
  }
  EXPECT_EQ(bench.input.fault(), SensorFault::kNone);
}

TEST(SensorInput, SilenceIsAFault) {
  Bench bench;
  bench.sample(bench.ratio_of(210), 20);
  bench.input.on_time(bench.now + 29ms);
  EXPECT_TRUE(bench.input.good());
  bench.input.on_time(bench.now + 30ms);
  EXPECT_FALSE(bench.input.good());
  bench.input.on_time(bench.now + 100ms);
  EXPECT_EQ(bench.input.fault(), SensorFault::kSilent);
}

}  // namespace
}  // namespace kinebus::heat
