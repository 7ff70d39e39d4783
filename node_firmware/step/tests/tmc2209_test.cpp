// What is said to a TMC2209: datagrams, the wire's bits, settings, and what becomes of answers that do not
// come.

#include "node_firmware/step/tmc2209.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "node_firmware/step/driver_chain.hpp"
#include "node_firmware/step/one_wire.hpp"
#include "node_firmware/step/soldered_driver.hpp"

namespace kinebus::tmc2209 {
namespace {

using namespace std::chrono_literals;
using step::DriverState;

// By hand, with the algorithm of the datasheet.
TEST(Tmc2209Datagram, HasTheCrcOfTheDatasheet) {
  const Datagram read = read_of(reg::kIfcnt);
  EXPECT_EQ(read.length, 4);
  EXPECT_EQ(read.bytes[3], 0x8F) << "05 00 02 8F";
  const Datagram write = write_of(reg::kGconf, 0x1C0);
  EXPECT_EQ(write.length, 8);
  EXPECT_EQ(write.bytes[2], 0x80);
  EXPECT_EQ(write.bytes[5], 0x01);
  EXPECT_EQ(write.bytes[6], 0xC0);
}

TEST(Tmc2209Datagram, AnAnswerWithAnyBitWrongIsNone) {
  std::array<std::uint8_t, 8> answer{kSync, kMaster, reg::kIoin, 0x21, 0, 0, 0x41, 0};
  answer[7] = crc8(std::span(answer).first(7));
  EXPECT_EQ(answer_of(answer, reg::kIoin), 0x2100'0041u);
  EXPECT_FALSE(answer_of(answer, reg::kGstat));
  EXPECT_FALSE(answer_of(std::span(answer).first(7), reg::kIoin));
  for (std::size_t bit = 0; bit < 64; ++bit) {
    auto wrong = answer;
    wrong[bit / 8] = static_cast<std::uint8_t>(wrong[bit / 8] ^ 1u << (bit % 8));
    EXPECT_FALSE(answer_of(wrong, reg::kIoin)) << "bit " << bit;
  }
}

TEST(OneWire, BytesComeBackWhateverTheClocksAndTheRiseOfTheLine) {
  constexpr std::uint32_t kPin = 1u << 11;
  for (const double clock : {0.98, 1.0, 1.02})
    for (const double rise : {0.0, 0.2})
      for (const double phase : {0.0, 0.3, 0.9}) {
        // Bit times of the sender, as the receiver samples them.
        const std::array<std::uint8_t, 4> sent{0x05, 0xFF, 0x00, 0xA6};
        std::vector<std::pair<double, bool>> edges;
        double at = 3 + phase / step::kSamples;
        bool level = true;
        for (const std::uint8_t byte : sent) {
          const unsigned bits = 1u << 9 | static_cast<unsigned>(byte) << 1;
          for (int bit = 0; bit < 10; ++bit, at += clock) {
            const bool next = (bits >> bit & 1) != 0;
            if (next != level) edges.emplace_back(at + (next ? rise : 0), next);
            level = next;
          }
        }
        std::vector<std::uint16_t> samples;
        level = true;
        std::size_t edge = 0;
        for (double t = 0; t < at + 3; t += 1.0 / step::kSamples) {
          while (edge < edges.size() && edges[edge].first <= t) level = edges[edge++].second;
          samples.push_back(level ? kPin : 0);
        }
        std::array<std::uint8_t, 4> heard{};
        EXPECT_EQ(step::take_bytes(samples, kPin, heard), 4u) << clock << ' ' << rise << ' ' << phase;
        EXPECT_EQ(heard, sent);
      }
}

TEST(OneWire, ALineThatIsStuckSaysNothing) {
  std::array<std::uint8_t, 4> heard{};
  EXPECT_EQ(step::take_bytes(std::vector<std::uint16_t>(500, 0), 1, heard), 0u);
  EXPECT_EQ(step::take_bytes(std::vector<std::uint16_t>(500, 1), 1, heard), 0u);
  EXPECT_EQ(step::take_bytes({}, 1, heard), 0u);
}

TEST(Tmc2209Settings, CurrentsAreNeverMoreThanAskedForAndWithinAStepOfIt) {
  for (std::uint32_t ma = 80; ma <= 2500; ++ma) {
    const step::CurrentScale scale = scale_of(ma, ma / 2);
    const double full = scale.fine ? 180 / 0.13 : 325 / 0.13;
    const double run = (scale.run + 1) * full / 32;
    EXPECT_LE(run, ma + 1.0);
    EXPECT_GT(run, ma - full / 32 - 2);
    EXPECT_LE(scale.hold, scale.run);
  }
  EXPECT_EQ(scale_of(5000, 5000).run, 31) << "the most that it can";
  EXPECT_EQ(scale_of(0, 0).run, 0);
}

/// The wire and a chip that keeps what it is told.
struct FakeWire {
  void begin(std::size_t, const step::Exchange& exchange) {
    heard.clear();
    if (exchange.bus != step::DriverBus::kUart) return;
    const std::span<const std::uint8_t> said = exchange.said();
    const std::size_t answer_bytes = exchange.hears - said.size();
    ++exchanges;
    heard.assign(said.begin(), said.end());
    if (!there) return;
    if (deaf_writes > 0 && said.size() == 8) {
      --deaf_writes;
      return;
    }
    const std::uint8_t address = said[2] & 0x7F;
    if (answer_bytes == 0) {
      registers[address] =
          std::uint32_t{said[3]} << 24 | std::uint32_t{said[4]} << 16 | std::uint32_t{said[5]} << 8 | said[6];
      if (address == reg::kGstat) registers[address] = gstat &= ~registers[address];
      ++count;
      return;
    }
    std::uint32_t value = registers[address];
    if (address == reg::kIfcnt) value = count;
    if (address == reg::kIoin) value = version << 24;
    if (address == reg::kGstat) value = gstat;
    Datagram answer = write_of(address, value, kMaster);
    answer.bytes[2] = address;
    answer.bytes[7] = crc8(std::span(answer.bytes).first(7));
    if (garbled > 0) --garbled, answer.bytes[4] ^= 1;
    heard.insert(heard.end(), answer.bytes.begin(), answer.bytes.end());
  }
  bool done() const { return true; }
  std::size_t take(std::span<std::uint8_t> bytes) const {
    const std::size_t n = std::min(bytes.size(), heard.size());
    std::copy_n(heard.begin(), n, bytes.begin());
    return n;
  }
  bool there = true;
  int deaf_writes = 0, garbled = 0, exchanges = 0;
  std::uint32_t version = kVersion, gstat = 1;
  std::uint8_t count = 250;
  std::map<std::uint8_t, std::uint32_t> registers;
  std::vector<std::uint8_t> heard;
};

struct Chain : testing::Test {
  void run(LocalTime time) {
    for (const LocalTime end = now + time; now < end; now += 1ms) chain.serve(now);
  }
  FakeWire wire;
  step::DriverChain<FakeWire, 1> chain{wire};
  step::DriverSocket& driver = chain.driver(0);
  LocalTime now{0};
};

TEST_F(Chain, ADriverGetsItsSettingsAndEachWriteIsCounted) {
  driver.set({.run_ma = 1200, .hold_ma = 600});
  run(50ms);
  EXPECT_TRUE(chain.settled());
  EXPECT_EQ(driver.state(), DriverState::kConfigured);
  EXPECT_EQ(wire.registers[reg::kIholdIrun] >> 8 & 31, 26u);  // 27/32 of 1384 mA
  EXPECT_EQ(wire.registers[reg::kChopconf] >> 24 & 15, 4u) << "16 microsteps";
  EXPECT_EQ(wire.gstat, 0u);
  driver.set({.run_ma = 2000, .hold_ma = 600});
  EXPECT_TRUE(driver.usable());
  run(20ms);
  EXPECT_EQ(driver.state(), DriverState::kConfigured);
  EXPECT_EQ(wire.registers[reg::kIholdIrun] >> 8 & 31, 24u);
  EXPECT_EQ(wire.registers[reg::kChopconf] >> 17 & 1, 0u);
}

TEST_F(Chain, AWriteThatDidNotArriveIsFoundAndMadeAgain) {
  wire.deaf_writes = 1;
  run(80ms);
  EXPECT_EQ(driver.state(), DriverState::kConfigured);
  EXPECT_NE(wire.registers[reg::kGconf], 0u) << "the first of them was lost";
}

TEST_F(Chain, GarbledAnswersAreAskedForAgainAndSilenceIsSilence) {
  wire.garbled = 3;
  run(80ms);
  EXPECT_EQ(driver.state(), DriverState::kConfigured);
  wire.there = false;
  run(500ms);
  EXPECT_EQ(driver.state(), DriverState::kSilent);
  EXPECT_FALSE(driver.usable());
  wire.there = true;
  wire.registers.clear();
  run(1s);
  EXPECT_EQ(driver.state(), DriverState::kConfigured);
  EXPECT_NE(wire.registers[reg::kChopconf], 0u);
}

TEST_F(Chain, AnotherChipIsNotTakenForOne) {
  wire.version = 0x20;
  run(2s);
  EXPECT_EQ(driver.state(), DriverState::kSilent);
  EXPECT_EQ(wire.count, 250) << "nothing is written into it";
  EXPECT_LT(wire.exchanges, 20) << "it is not asked all the time";
}

TEST_F(Chain, ASupplyThatWasGoneIsSeenAndTheSettingsComeBack) {
  run(80ms);
  wire.gstat = gstat::kReset;
  wire.registers.clear();
  run(200ms);
  EXPECT_TRUE(driver.chip().lost_settings());
  EXPECT_EQ(driver.state(), DriverState::kConfigured);
  EXPECT_NE(wire.registers[reg::kChopconf], 0u);
  driver.acknowledge();
  run(200ms);
  EXPECT_FALSE(driver.chip().lost_settings());
}

TEST_F(Chain, AnOpenPhaseCountsInSlowMotionOnly) {
  run(80ms);
  wire.registers[reg::kDrvStatus] = drv_status::kOpenLoad;
  run(1s);
  EXPECT_FALSE(driver.chip().open_load());
  driver.set_slow_motion(true);
  run(60ms);
  EXPECT_FALSE(driver.chip().open_load());
  run(200ms);
  EXPECT_TRUE(driver.chip().open_load());
}

TEST_F(Chain, OneThatStandsAloneIsLeftAlone) {
  driver.set_spoken_to(false);
  run(1s);
  EXPECT_EQ(wire.exchanges, 0);
  EXPECT_TRUE(driver.usable());
  driver.set_spoken_to(true);
  EXPECT_FALSE(driver.usable());
  run(80ms);
  EXPECT_TRUE(driver.usable());
}

/// The same wire, and a chip that is always there.
struct Soldered : testing::Test {
  void run(LocalTime time) {
    for (const LocalTime end = now + time; now < end; now += 1ms) chain.serve(now);
  }
  FakeWire wire;
  step::DriverChain<FakeWire, 1, step::SolderedDriver> chain{wire};
  step::SolderedDriver& driver = chain.driver(0);
  LocalTime now{0};
};

TEST_F(Soldered, GetsItsSettingsAndIsAskedHowItIs) {
  driver.set({.run_ma = 1200, .hold_ma = 600});
  run(50ms);
  EXPECT_TRUE(chain.settled());
  EXPECT_EQ(driver.state(), DriverState::kConfigured);
  EXPECT_EQ(driver.chip().found(), 2209);
  EXPECT_EQ(wire.registers[reg::kIholdIrun] >> 8 & 31, 26u);
  wire.registers[reg::kDrvStatus] = drv_status::kPreWarning;
  run(200ms);
  EXPECT_EQ(driver.chip().findings() & step::finding::kPreWarning, step::finding::kPreWarning);
}

TEST_F(Soldered, ThatDoesNotAnswerIsSilentAtOnceAndAskedNowAndThen) {
  wire.there = false;
  run(50ms);
  EXPECT_TRUE(chain.settled());
  EXPECT_EQ(driver.state(), DriverState::kSilent);
  EXPECT_FALSE(driver.usable());
  const int asked = wire.exchanges;
  run(2s);
  EXPECT_LE(wire.exchanges - asked, 5);
  wire.there = true;
  run(1s);
  EXPECT_TRUE(driver.usable());
}

TEST_F(Soldered, ThatStandsAloneIsLeftAloneAndToldAllWhenItNoLongerDoes) {
  driver.set({.run_ma = 1200, .hold_ma = 600});
  run(80ms);
  driver.set_spoken_to(false);
  const int asked = wire.exchanges;
  driver.set({.run_ma = 900, .hold_ma = 600});
  run(1s);
  EXPECT_EQ(wire.exchanges, asked);
  EXPECT_EQ(driver.state(), DriverState::kStandsAlone);
  EXPECT_TRUE(driver.usable());
  wire.registers.clear();
  driver.set_spoken_to(true);
  EXPECT_FALSE(driver.usable());
  run(80ms);
  EXPECT_TRUE(driver.usable());
  EXPECT_EQ(wire.registers[reg::kIholdIrun] >> 8 & 31, 19u);  // 20/32 of 1384 mA
  EXPECT_NE(wire.registers[reg::kChopconf], 0u);
}

}  // namespace
}  // namespace kinebus::tmc2209
