// The program's part for a MAX31865 against the chip's model.

#include <gtest/gtest.h>

#include "node_firmware/board/max31865.hpp"
#include "vcan_tests/emulator/physics/max31865.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

struct Rig {
  // Bytes at 4 MHz, and 10 ms from sample to sample.
  struct Bus {
    void select(bool on) { rig.chip.select(on, rig.now); }
    std::optional<std::uint8_t> exchange(std::uint8_t byte) {
      if (rig.bus_stands) return std::nullopt;
      rig.now += 8 * kCoreHz / 4'000'000;
      return static_cast<std::uint8_t>(rig.chip.exchange(byte, rig.now));
    }
    void wait_us(unsigned us) { rig.now += static_cast<Cycle>(us) * kCoreHz / 1'000'000; }
    Rig& rig;
  };
  std::optional<std::uint32_t> sample() {
    now = std::max(now, next);
    next += kCoreHz / 100;
    time += 10ms;
    return part.take(time, wiring);
  }
  std::optional<std::uint32_t> after(LocalTime span) {
    std::optional<std::uint32_t> last;
    for (const LocalTime end = time + span; time < end;) last = sample();
    return last;
  }
  /// Samples until `what`, at most a second and a half.
  int samples_until(const std::function<bool(const std::optional<std::uint32_t>&)>& what) {
    for (int n = 1; n < 150; ++n)
      if (what(sample())) return n;
    return 1000;
  }
  Cycle now = 0, next = 0;
  LocalTime time{0};
  bool bus_stands = false;
  Max31865Chip chip;
  Bus bus{*this};
  RtdWiring wiring;
  Max31865<Bus> part{bus};
};

double share(const std::optional<std::uint32_t>& ratio) {
  return ratio ? static_cast<double>(*ratio) / heat::kFullRatio : -1;
}
constexpr double kStep = 1.0 / 32768;

TEST(Max31865, MeasuresWithinAStepOfItsConverterFrom80MsOnAndNeverMisusesTheChip) {
  for (const bool slow : {false, true}) {
    Rig rig;
    rig.wiring.mains_50hz = slow;
    rig.chip.ohm = [] { return 175.86; };  // a PT100 at 200 C
    for (int n = 0; n < 6; ++n) EXPECT_FALSE(rig.sample()) << "nothing is measured yet";
    int there = 0;
    for (int n = 0; n < 500; ++n)
      if (const auto ratio = rig.sample()) {
        EXPECT_NEAR(share(ratio), 175.86 / 430, 2.5 * kStep);
        ++there;
      }
    EXPECT_GE(there, 498);
    EXPECT_GT(rig.chip.conversions(), slow ? 180u : 210u);
    EXPECT_EQ(rig.chip.mistakes(), 0u);
  }
}

TEST(Max31865, TakesOffTheLeadsOfThreeWiresAndOfFour) {
  for (const int wires : {2, 3, 4}) {
    Rig rig;
    rig.chip.lead_ohm = 1.5;
    rig.chip.wires = wires;
    rig.wiring.three_wires = wires == 3;
    EXPECT_NEAR(share(rig.after(300ms)), (100 + (wires == 2 ? 3 : 0)) / 430.0, 2.5 * kStep) << wires;
  }
}

TEST(Max31865, TellsEachFaultForAsLongAsItIsThereAndThenMeasuresAgain) {
  using Wires = Max31865Chip::Wires;
  for (const Wires wires : {Wires::kElementOpen, Wires::kElementShort, Wires::kForceOpen}) {
    Rig rig;
    rig.after(300ms);
    rig.chip.state = wires;
    const bool open = wires != Wires::kElementShort;
    const auto told = [&](const std::optional<std::uint32_t>& ratio) {
      return open ? share(ratio) > 0.999 : ratio == 0u;
    };
    EXPECT_LE(rig.samples_until(told), 115);
    for (int n = 0; n < 300; ++n) EXPECT_TRUE(told(rig.sample())) << static_cast<int>(wires) << " " << n;
    rig.chip.state = Wires::kWhole;
    EXPECT_NEAR(share(rig.after(400ms)), 100 / 430.0, 2.5 * kStep);
    EXPECT_EQ(rig.chip.mistakes(), 0u);
  }
  Rig rig;
  rig.after(300ms);
  rig.chip.voltage = true;
  for (int n = 0; n < 300; ++n) EXPECT_FALSE(rig.sample()) << "it converts no more";
  rig.chip.voltage = false;
  EXPECT_NEAR(share(rig.after(400ms)), 100 / 430.0, 2.5 * kStep);
}

TEST(Max31865, DoesNotBelieveWhatIsNoMax31865) {
  Rig absent;
  absent.chip.absent = true;
  for (int n = 0; n < 200; ++n) EXPECT_FALSE(absent.sample());
  absent.chip.absent = false;
  EXPECT_NEAR(share(absent.after(300ms)), 100 / 430.0, 2.5 * kStep) << "plugged in";
  absent.chip.reset();
  EXPECT_FALSE(absent.sample()) << "its supply has sagged";
  EXPECT_NEAR(share(absent.after(300ms)), 100 / 430.0, 2.5 * kStep) << "set up again";
  absent.bus_stands = true;
  for (int n = 0; n < 50; ++n) EXPECT_FALSE(absent.sample());
}

TEST(Max31865, OtherWiringIsTakenUpWithoutAWrongReading) {
  Rig rig;
  rig.chip.lead_ohm = 2;
  rig.chip.wires = 3;
  rig.after(300ms);
  rig.wiring = {.three_wires = true, .mains_50hz = true};
  for (int n = 0; n < 50; ++n)
    if (const auto ratio = rig.sample()) {
      EXPECT_NEAR(share(ratio), 100 / 430.0, 2.5 * kStep) << n;
    }
  EXPECT_NEAR(share(rig.sample()), 100 / 430.0, 2.5 * kStep);
  EXPECT_EQ(rig.chip.mistakes(), 0u);
}

}  // namespace
}  // namespace kinebus::emulator
