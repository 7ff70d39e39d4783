// The USB core's model without a processor: what a driver writes, what a host sees.

#include <gtest/gtest.h>

#include "vcan_tests/emulator/peripherals/otg_hs.hpp"

namespace kinebus::emulator {
namespace {

using Answer = OtgHs::Answer;
using Bytes = OtgHs::Bytes;

constexpr Cycle kLater = kCoreHz / 10;
constexpr std::array<std::uint8_t, 8> kGetDevice{0x80, 6, 0, 1, 0, 0, 18, 0};
constexpr std::uint32_t kEnable = 1u << 31, kDisable = 1u << 30, kClearNak = 1u << 26, kSetNak = 1u << 27,
                        kStall = 1u << 21, kActive = 1u << 15;

struct Otg : testing::Test, InterruptLines {
  void set_line(int irq, bool level) override {
    EXPECT_EQ(irq, OtgHs::kIrq);
    line = level;
  }
  void write(std::uint32_t offset, std::uint32_t value) { core.write(offset, value, 0); }
  std::uint32_t read(std::uint32_t offset) { return core.read(offset, 0); }
  void bring_up() {
    write(0x0C, 1u << 6 | 1u << 30 | 6u << 10);
    write(0x38, 1u << 16 | 1u << 21);
    write(0x800, 3);
    write(0x24, 128);
    write(0x28, 32u << 16 | 128);
    write(0x104, 32u << 16 | 160);
    core.bus_reset();
    write(0x14, 0xFFFFFFFF);
    write(0xB10, 3u << 29);
  }
  void open_data() {
    write(0x920, kActive | 2u << 18 | 1u << 22 | 64);
    write(0xB20, kActive | 2u << 18 | 64);
  }
  void take(int endpoint) {
    const auto base = 0xB00 + 0x20 * static_cast<std::uint32_t>(endpoint);
    write(base + 0x10, 1u << 19 | 64);
    write(base, read(base) | kEnable | kClearNak);
  }
  void send(int endpoint, const Bytes& bytes) {
    const auto base = 0x900 + 0x20 * static_cast<std::uint32_t>(endpoint);
    write(base + 0x10, 1u << 19 | static_cast<std::uint32_t>(bytes.size()));
    write(base, read(base) | kEnable | kClearNak);
    for (std::size_t at = 0; at < bytes.size(); at += 4) {
      std::uint32_t word = 0;
      for (std::size_t i = at; i < std::min(at + 4, bytes.size()); ++i)
        word |= static_cast<std::uint32_t>(bytes[i]) << 8 * (i - at);
      write(0x1000u * static_cast<std::uint32_t>(endpoint + 1), word);
    }
  }
  std::string first_violation() const { return core.violations().empty() ? "" : core.violations()[0]; }

  bool line = false;
  OtgHs core{*this};
};

TEST_F(Otg, IsSeenOnlyWhenTransceiverSpeedAndModeAreSetAndItIsNotDetached) {
  EXPECT_FALSE(core.pulled_up(kLater));
  bring_up();
  EXPECT_TRUE(core.pulled_up(kLater));
  EXPECT_FALSE(core.pulled_up(kCoreHz / 1000)) << "the mode takes 25 ms";
  write(0x804, 2);
  EXPECT_FALSE(core.pulled_up(kLater));
  EXPECT_EQ(first_violation(), "");
}

TEST_F(Otg, GivesASetupPacketAndTakesTheAnswer) {
  bring_up();
  EXPECT_EQ(core.setup(5, kGetDevice), Answer::kNothing) << "another's address";
  EXPECT_EQ(core.setup(0, kGetDevice), Answer::kAck);
  ASSERT_NE(read(0x14) & 1u << 4, 0u);
  EXPECT_EQ(read(0x20), 6u << 17 | 8u << 4);
  EXPECT_EQ(read(0x1000), 0x01000680u);
  EXPECT_EQ(read(0x1000), 0x00120000u);
  EXPECT_EQ(read(0x20), 4u << 17);
  EXPECT_EQ(read(0x14) & 1u << 4, 0u);
  EXPECT_EQ(core.in(0, 0).answer, Answer::kNak);
  send(0, {18, 1, 0, 2, 0});
  const auto got = core.in(0, 0);
  EXPECT_EQ(got.bytes, (Bytes{18, 1, 0, 2, 0}));
  EXPECT_EQ(got.toggle, 1);
  EXPECT_EQ(read(0x900) & kEnable, 0u);
  EXPECT_EQ(core.out(0, 0, {}, 1), Answer::kNak);
  take(0);
  EXPECT_EQ(core.out(0, 0, {}, 1), Answer::kAck);
  EXPECT_EQ(first_violation(), "");
}

TEST_F(Otg, TakesStallBackWithTheNextSetupPacket) {
  bring_up();
  core.setup(0, kGetDevice);
  write(0x900, read(0x900) | kStall);
  EXPECT_EQ(core.in(0, 0).answer, Answer::kStall);
  write(0x900, 0);
  EXPECT_EQ(core.in(0, 0).answer, Answer::kStall) << "the program cannot";
  core.setup(0, kGetDevice);
  EXPECT_EQ(core.in(0, 0).answer, Answer::kNak);
}

TEST_F(Otg, HoldsTheHostOffUntilAPacketIsTakenAndDropsARepeatedOne) {
  bring_up();
  open_data();
  EXPECT_EQ(core.out(0, 1, {'s'}, 0), Answer::kNak);
  take(1);
  EXPECT_EQ(core.out(0, 1, {'s'}, 0), Answer::kAck);
  EXPECT_EQ(core.out(0, 1, {'t'}, 1), Answer::kNak);
  EXPECT_EQ(read(0x20) >> 17 & 0xF, 2u);
  EXPECT_EQ(read(0x1000), 's');
  EXPECT_EQ(read(0x20) >> 17 & 0xF, 3u);
  take(1);
  EXPECT_EQ(core.out(0, 1, {'s'}, 0), Answer::kAck) << "the host did not hear the ACK";
  EXPECT_EQ(core.untaken(), 0u);
  EXPECT_EQ(core.out(0, 1, {'t'}, 1), Answer::kAck);
  EXPECT_EQ(first_violation(), "");
}

TEST_F(Otg, ABusResetClosesEndpointsAndADisabledOneGivesItsPacketUp) {
  bring_up();
  open_data();
  send(1, {1, 2, 3});
  write(0x920, read(0x920) | kSetNak);
  EXPECT_EQ(core.in(0, 1).answer, Answer::kNak);
  EXPECT_NE(read(0x928) & 1u << 6, 0u);
  write(0x920, read(0x920) | kDisable);
  EXPECT_NE(read(0x928) & 2, 0u);
  write(0x10, 1u << 5 | 1u << 6);
  EXPECT_EQ(read(0x938), 32u);
  core.bus_reset();
  EXPECT_EQ(core.in(0, 1).answer, Answer::kNothing);
  EXPECT_NE(read(0x14) & 1u << 12, 0u);
  EXPECT_EQ(first_violation(), "");
}

TEST_F(Otg, NotesWhatTheManualForbids) {
  bring_up();
  read(0x20);
  EXPECT_EQ(first_violation(), "GRXSTSP read with nothing received");
  write(0x2000, 1);
  EXPECT_EQ(core.violations().back(), "FIFO written while its endpoint is not enabled");
  open_data();
  write(0x930, 1u << 19 | 8);
  write(0x920, read(0x920) | kEnable | kClearNak);
  write(0x2000, 1);
  read(0x908);
  EXPECT_EQ(core.violations().back(), "endpoint register read while a packet is being written");
  write(0x2000, 2);
  write(0x2000, 3);
  EXPECT_EQ(core.violations().back(), "FIFO written beyond the transfer's size");
  write(0x104, 1000u << 16 | 160);
  core.bus_reset();
  EXPECT_EQ(core.violations().back(), "FIFOs larger than the memory");
}

TEST_F(Otg, InterruptsWhenToldTo) {
  bring_up();
  core.bus_reset();
  EXPECT_FALSE(line);
  write(0x18, 1u << 12);
  write(0x08, 1);
  EXPECT_TRUE(line);
  write(0x14, 1u << 12);
  EXPECT_FALSE(line);
}

}  // namespace
}  // namespace kinebus::emulator
