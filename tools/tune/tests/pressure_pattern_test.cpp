// The pattern's values, the table of widths, and the advance chosen from it.

#include <gtest/gtest.h>

#include <random>

#include "tools/tune/pressure_pattern.hpp"
#include "tools/tune/pressure_widths.hpp"

namespace kinebus {
namespace {

std::vector<LineWidths> widths_for(double truth_s, double noise_mm, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 1);
  std::vector<LineWidths> widths;
  for (int i = 0; i <= 10; ++i) {
    const double k = 0.01 * i, lacks = truth_s - k;
    const double a = noise_mm * noise(random), b = noise_mm * noise(random);
    widths.push_back({k, 0.45 - 1.5 * lacks + a, 0.45 + 1.5 * lacks + b});
  }
  return widths;
}

TEST(PressureWidths, TheAdvanceIsWhereBothWidthsAreTheSame) {
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const auto choice = choose_advance(widths_for(0.043, 0.01, seed));
    ASSERT_TRUE(choice) << choice.error();
    EXPECT_NEAR(choice->advance_s, 0.043, 4 * choice->sigma_s + 1e-4);
    EXPECT_LE(choice->sigma_s, 0.004);
  }
  // One line that is spoilt does not count.
  auto spoilt = widths_for(0.043, 0, 1);
  spoilt[8].slower_mm = 0.9;
  ASSERT_TRUE(choose_advance(spoilt));
  EXPECT_NEAR(choose_advance(spoilt)->advance_s, 0.043, 0.003);
}

TEST(PressureWidths, SaysWhatIsWrongWithATable) {
  const auto words = [](const std::vector<LineWidths>& widths) {
    const auto choice = choose_advance(widths);
    return choice ? std::string("chosen") : choice.error();
  };
  EXPECT_NE(words({{0, 0.4, 0.5}, {0.1, 0.5, 0.4}}).find("at least three lines"), std::string::npos);
  EXPECT_NE(words(widths_for(0.15, 0, 1)).find("print lines above it"), std::string::npos);
  EXPECT_NE(words(widths_for(-0.02, 0, 1)).find("print lines below it"), std::string::npos);
  auto exchanged = widths_for(0.05, 0, 1);
  for (LineWidths& w : exchanged) std::swap(w.faster_mm, w.slower_mm);
  EXPECT_NE(words(exchanged).find("exchanged"), std::string::npos);
  EXPECT_NE(words({{0.1, 0.4, 0.5}, {0.1, 0.5, 0.4}, {0.1, 0.5, 0.4}}).find("differ"), std::string::npos);
  const auto table = read_widths("advance_s,faster_um,slower_mm\n0.02,430,0.47\n");
  ASSERT_TRUE(table) << table.error();
  EXPECT_NEAR((*table)[0].faster_mm, 0.43, 1e-12);
  EXPECT_FALSE(read_widths("advance_s,faster_mm\n0.02,0.43\n"));
  EXPECT_FALSE(read_widths("advance_s,faster_mm,slower_mm,slower_near_mm\n0.02,0.43,0.45,0.5\n"));
  const auto near =
      read_widths("advance_s,faster_mm,slower_mm,faster_near_mm,slower_near_mm\n0.02,0.43,0.45,0.4,0.5\n");
  ASSERT_TRUE(near);
  EXPECT_TRUE(near->front().near());
  EXPECT_FALSE(read_widths("advance_s,faster_mm,slower_mm\n0.02,wide,0.43\n"));
  EXPECT_FALSE(read_widths("advance_s,faster_mm,slower_mm\n0.02,-1,0.43\n"));
  const auto again = read_widths(write_widths(widths_for(0.05, 0, 1)));
  ASSERT_TRUE(again) << again.error();
  EXPECT_NEAR(choose_advance(*again)->advance_s, 0.05, 1e-3);
}

TEST(PressurePattern, RefusesWhatCannotBePrintedOrRead) {
  EXPECT_TRUE(check(PressurePattern{}));
  const auto refuses = [](auto change) {
    PressurePattern pattern;
    change(pattern);
    return !check(pattern);
  };
  EXPECT_TRUE(refuses([](PressurePattern& p) { p.from_s = p.to_s; }));
  EXPECT_TRUE(refuses([](PressurePattern& p) { p.to_s = 3; }));
  EXPECT_TRUE(refuses([](PressurePattern& p) { p.lines = 2; }));
  EXPECT_TRUE(refuses([](PressurePattern& p) { p.slow_mm_per_s = 80; }));
  EXPECT_TRUE(refuses([](PressurePattern& p) { p.width_mm = 0; }));
  EXPECT_TRUE(refuses([](PressurePattern& p) { p.fast_part_mm = 5; }));
}

}  // namespace
}  // namespace kinebus
