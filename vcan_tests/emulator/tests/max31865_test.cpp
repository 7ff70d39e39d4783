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
      const bool hit = rig.every_bad_byte != 0 && ++rig.bytes % rig.every_bad_byte == 0;
      return static_cast<std::uint8_t>(rig.chip.exchange(byte, rig.now) ^ (hit ? 0x20 : 0));
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
  unsigned every_bad_byte = 0, bytes = 0;  ///< one of so many comes with a wrong bit
  Max31865Chip chip;
  Bus bus{*this};
  heat::RtdWiring wiring;
  Max31865<Bus> part{bus};
};

double share(const std::optional<std::uint32_t>& ratio) {
  return ratio ? static_cast<double>(*ratio) / heat::kFullRatio : -1;
}
constexpr double kStep = 1.0 / 32768;

TEST(Max31865, MeasuresWithinAStepOfItsConverterFrom80MsOnAndNeverMisusesTheChip) {
  for (const bool slow : {false, true}) {
    Rig rig;
    rig.wiring.mains_60hz = !slow;
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
  for (const Wires wires : {Wires::kElementOpen, Wires::kElementShort, Wires::kForceOpen, Wires::kGrounded}) {
    Rig rig;
    rig.after(300ms);
    rig.chip.state = wires;
    rig.chip.indeterminate = 0.5;
    const bool open = wires == Wires::kElementOpen || wires == Wires::kForceOpen;
    const auto told = [&](const std::optional<std::uint32_t>& ratio) {
      return open ? share(ratio) > 0.999 : ratio == 0u;
    };
    EXPECT_LE(rig.samples_until(told), 115);
    for (int n = 0; n < 300; ++n) EXPECT_TRUE(told(rig.sample())) << static_cast<int>(wires) << " " << n;
    // At whatever moment of its cycles it is mended.
    for (int moment = 0; moment < 12; ++moment) {
      rig.chip.state = Wires::kWhole;
      for (int n = 0; n < 40; ++n)
        if (const auto ratio = rig.sample(); ratio && !told(ratio)) {
          EXPECT_NEAR(share(ratio), 100 / 430.0, 2.5 * kStep) << "what it measured before is nothing";
        }
      EXPECT_NEAR(share(rig.sample()), 100 / 430.0, 2.5 * kStep);
      rig.chip.state = wires;
      EXPECT_LE(rig.samples_until(told), 115);
      for (int n = 0; n < 30 + moment; ++n) rig.sample();
    }
    EXPECT_EQ(rig.chip.mistakes(), 0u);
  }
  Rig rig;
  rig.after(300ms);
  rig.chip.voltage = true;
  EXPECT_LE(rig.samples_until([](const auto& ratio) { return !ratio; }), 2);
  for (int n = 0; n < 300; ++n) EXPECT_FALSE(rig.sample()) << "it converts no more";
  rig.chip.voltage = false;
  EXPECT_NEAR(share(rig.after(400ms)), 100 / 430.0, 2.5 * kStep);
}

TEST(Max31865, DoesNotBelieveWhatIsNoMax31865) {
  for (const bool low : {false, true}) {
    Rig absent;
    absent.chip.absent = true;
    absent.chip.line_low = low;
    for (int n = 0; n < 200; ++n) EXPECT_FALSE(absent.sample());
    absent.chip.absent = false;
    EXPECT_NEAR(share(absent.after(300ms)), 100 / 430.0, 2.5 * kStep) << "plugged in";
    absent.chip.absent = true;
    EXPECT_FALSE(absent.sample()) << "at once";
    absent.chip.absent = false;
    absent.after(300ms);
    absent.chip.reset();
    EXPECT_FALSE(absent.sample()) << "its supply has sagged";
    EXPECT_NEAR(share(absent.after(300ms)), 100 / 430.0, 2.5 * kStep) << "set up again";
    absent.bus_stands = true;
    for (int n = 0; n < 50; ++n) EXPECT_FALSE(absent.sample());
  }
}

TEST(Max31865, NoReadingIsOlderThanItSays) {
  for (const bool slow : {false, true})
    for (const bool restarts : {false, true}) {
      Rig rig;
      rig.wiring.mains_60hz = !slow;
      rig.chip.writes_restart = restarts;
      rig.after(300ms);
      for (int n = 0; n < 500; ++n) EXPECT_TRUE(rig.sample()) << "a cycle for broken wires leaves no gap";
      // What it answers is right in every bit but one thing: nothing of it is new.
      rig.chip.stands = true;
      constexpr int kMost = Max31865<Rig::Bus>::kOldest / 10ms + 1;
      EXPECT_LE(rig.samples_until([](const auto& ratio) { return !ratio; }), kMost);
      for (int n = 0; n < 300; ++n) EXPECT_FALSE(rig.sample()) << n;
      rig.chip.stands = false;
      EXPECT_NEAR(share(rig.after(400ms)), 100 / 430.0, 2.5 * kStep);
      EXPECT_EQ(rig.chip.mistakes(), 0u);
    }
}

// The bus has no check of its own.
TEST(Max31865, AWrongBitIsNoReadingAndOneNowAndThenCostsNone) {
  Rig rig;
  rig.after(300ms);
  rig.every_bad_byte = 997;
  for (int n = 0; n < 3000; ++n) EXPECT_NEAR(share(rig.sample()), 100 / 430.0, 2.5 * kStep) << n;
  rig.every_bad_byte = 5;
  rig.after(100ms);
  for (int n = 0; n < 3000; ++n) EXPECT_FALSE(rig.sample()) << n;
}

TEST(Max31865, OtherWiringIsTakenUpWithoutAWrongReading) {
  Rig rig;
  rig.chip.lead_ohm = 2;
  rig.chip.wires = 3;
  rig.after(300ms);
  rig.wiring = {.three_wires = true, .mains_60hz = true};
  for (int n = 0; n < 50; ++n)
    if (const auto ratio = rig.sample()) {
      EXPECT_NEAR(share(ratio), 100 / 430.0, 2.5 * kStep) << n;
    }
  EXPECT_NEAR(share(rig.sample()), 100 / 430.0, 2.5 * kStep);
  EXPECT_EQ(rig.chip.mistakes(), 0u);
}

}  // namespace
}  // namespace kinebus::emulator
