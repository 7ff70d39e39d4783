#include "node_firmware/usb/gs_usb_device.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <vector>

#include "protocol/bytes.hpp"

namespace kinebus {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr GsUsbFacts kFacts{.clock_hz = 42'000'000, .bit_rate = 1'000'000};

struct GsUsb : testing::Test {
  GsUsb() {
    device.on_reset();
    EXPECT_TRUE(command(0x00, 5, 9, 0, {}));
    EXPECT_TRUE(command(0x00, 9, 1, 0, {}));
  }
  void setup(std::uint8_t type, std::uint8_t request, unsigned value, unsigned index, std::size_t length) {
    std::array<std::uint8_t, 8> bytes{type, request};
    put_u16_le(std::span(bytes).subspan(2), static_cast<std::uint16_t>(value));
    put_u16_le(std::span(bytes).subspan(4), static_cast<std::uint16_t>(index));
    put_u16_le(std::span(bytes).subspan(6), static_cast<std::uint16_t>(length));
    device.on_setup(bytes, 123'456);
  }
  /// False: stalled.
  bool command(std::uint8_t type, std::uint8_t request, unsigned value, unsigned index, const Bytes& data) {
    setup(type, request, value, index, data.size());
    if (!data.empty() && !device.control().stalled()) device.on_control_data(data);
    return device.control().next_packet().has_value() && !device.control().stalled();
  }
  Bytes read(std::uint8_t request, std::size_t length, unsigned value = 0) {
    setup(0xC1, request, value, 0, length);
    Bytes all;
    while (const auto packet = device.control().next_packet())
      all.insert(all.end(), packet->begin(), packet->end());
    return all;
  }
  static Bytes words(std::initializer_list<std::uint32_t> list) {
    Bytes bytes(4 * list.size());
    std::size_t at = 0;
    for (const std::uint32_t word : list) put_u32_le(std::span(bytes).subspan(4 * at++), word);
    return bytes;
  }
  bool mode(std::uint32_t mode, std::uint32_t flags) { return command(0x41, 2, 0, 0, words({mode, flags})); }
  static Bytes frame(std::uint32_t echo, std::uint32_t id, std::initializer_list<std::uint8_t> data) {
    Bytes bytes = words({echo, id, static_cast<std::uint32_t>(data.size()), 0, 0});
    std::ranges::copy(data, bytes.begin() + 12);
    return bytes;
  }

  GsUsbDevice device{kFacts};
};

TEST_F(GsUsb, SaysWhatTheDriverAsksWhenItBinds) {
  EXPECT_TRUE(command(0x41, 0, 1, 0, words({0xBEEF})));
  EXPECT_FALSE(command(0x41, 0, 1, 0, words({0xEFBE0000}))) << "the other byte order";
  EXPECT_EQ(read(5, 12, 1), words({0, 2, 1}));
  EXPECT_EQ(read(4, 40), words({1u << 4 | 1u << 13, 42'000'000, 1, 16, 1, 8, 4, 1, 1024, 1}));
  EXPECT_EQ(read(6, 4), words({123'456}));
  EXPECT_EQ(read(14, 12), words({4, 0, 0})) << "stopped";
}

TEST_F(GsUsb, TakesTheBitRateOfTheNodesAndNoOther) {
  struct Case {
    std::initializer_list<std::uint32_t> words;
    bool good;
  };
  for (const Case& c : std::initializer_list<Case>{{{7, 8, 5, 1, 2}, true},
                                                   {{6, 7, 2, 1, 42'000'000 / 16'000'000}, false},
                                                   {{7, 8, 5, 1, 4}, false},  // 500 kbit/s
                                                   {{7, 8, 5, 1, 0}, false},
                                                   {{7, 8, 5, 1, 2000}, false},
                                                   {{0xFFFF'FFF0, 30, 5, 1, 2}, false}})
    EXPECT_EQ(command(0x41, 1, 0, 0, words(c.words)), c.good);
}

TEST_F(GsUsb, StallsWhatItDoesNotKnowOrCannot) {
  EXPECT_FALSE(mode(1, 1)) << "listen only was not offered";
  EXPECT_FALSE(mode(2, 0));
  EXPECT_FALSE(device.started());
  EXPECT_FALSE(command(0x41, 2, 1, 0, words({1, 0}))) << "there is one channel";
  EXPECT_FALSE(command(0x41, 2, 0, 1, words({1, 0}))) << "and one interface";
  EXPECT_FALSE(command(0x41, 2, 0, 0, words({1}))) << "too short";
  EXPECT_FALSE(command(0x41, 10, 0, 0, words({1, 2, 3, 4, 5}))) << "no data phase";
  EXPECT_TRUE(read(11, 72).empty());
  EXPECT_TRUE(device.control().stalled());
}

TEST_F(GsUsb, EchoesAFrameWhenItWasSentAndNotBefore) {
  ASSERT_TRUE(mode(1, 1u << 4));
  device.on_data(frame(3, 0x123, {1, 2, 3}));
  device.on_data(frame(4, 0x80000000 | 0x1ABCDEF0, {9}));
  const auto* next = device.next_frame();
  ASSERT_NE(next, nullptr);
  EXPECT_EQ(next->frame, CanFrame::make(0x123, {1, 2, 3}));
  EXPECT_FALSE(device.next_data());
  device.on_sent(next->ticket, next->frame, 777);
  device.drop_frame();
  Bytes expected = frame(3, 0x123, {1, 2, 3});
  const Bytes stamp = words({777});
  expected.insert(expected.end(), stamp.begin(), stamp.end());
  const auto packet = device.next_data();
  ASSERT_TRUE(packet);
  EXPECT_EQ(Bytes(packet->begin(), packet->end()), expected);
  next = device.next_frame();
  ASSERT_NE(next, nullptr);
  EXPECT_TRUE(next->frame.extended);
  EXPECT_EQ(next->frame.id, 0x1ABCDEF0u);
}

TEST_F(GsUsb, FramesOfTheBusHaveNoEchoIdAndNoStampUnlessAskedFor) {
  device.on_received(CanFrame::make(0x181, {5}), 1);
  ASSERT_TRUE(mode(1, 0));
  EXPECT_FALSE(device.next_data()) << "before the start nothing is kept";
  device.on_received(CanFrame::make(0x181, {5}), 1);
  const auto packet = device.next_data();
  ASSERT_TRUE(packet);
  EXPECT_EQ(Bytes(packet->begin(), packet->end()), frame(0xFFFF'FFFF, 0x181, {5}));
}

TEST_F(GsUsb, ANewStartKnowsNothingOfTheOneBefore) {
  ASSERT_TRUE(mode(1, 0));
  device.on_data(frame(0, 0x100, {}));
  device.on_data(frame(1, 0x101, {}));
  const GsUsbDevice::HostFrame first = *device.next_frame();
  device.drop_frame();
  device.on_received(CanFrame::make(0x181, {}), 0);
  ASSERT_TRUE(mode(0, 0));
  EXPECT_FALSE(device.started());
  ASSERT_TRUE(mode(1, 0));
  EXPECT_EQ(device.next_frame(), nullptr);
  device.on_sent(first.ticket, first.frame, 0);
  EXPECT_FALSE(device.next_data());
  device.on_reset();
  EXPECT_FALSE(device.started()) << "a bus reset stops it, too";
}

TEST_F(GsUsb, HoldsTheHostOffAndTellsWhatWasLostButKeepsRoomForEchoes) {
  ASSERT_TRUE(mode(1, 0));
  int taken = 0;
  for (; device.takes_data() && taken < 100; ++taken)
    device.on_data(frame(static_cast<std::uint32_t>(taken), 0x100, {}));
  EXPECT_GE(taken, 10) << "as many as the driver has under way";
  EXPECT_LE(taken, 16);
  for (int i = 0; i < 60; ++i) device.on_received(CanFrame::make(0x181, {}), 0);
  EXPECT_GT(device.lost(), 0u);
  const std::uint32_t lost = device.lost();
  for (int i = 0; i < 10; ++i) {
    const auto* next = device.next_frame();
    ASSERT_NE(next, nullptr);
    device.on_sent(next->ticket, next->frame, 0);
    device.drop_frame();
  }
  EXPECT_EQ(device.lost(), lost);
  int echoes = 0, overflows = 0;
  while (const auto packet = device.next_data()) {
    echoes += get_u32_le(*packet) != 0xFFFF'FFFF ? 1 : 0;
    overflows += (*packet)[10] & 1;
  }
  EXPECT_EQ(echoes, 10);
  EXPECT_EQ(overflows, 1);
}

TEST_F(GsUsb, CountsPacketsThatAreNoFrames) {
  ASSERT_TRUE(mode(1, 0));
  device.on_data(Bytes(19));
  device.on_data(frame(0, 0x800, {}));         // eleven bits
  device.on_data(frame(0, 1u << 29 | 4, {}));  // an error frame
  Bytes long_one = frame(0, 0x100, {});
  long_one[8] = 9;
  device.on_data(long_one);
  Bytes other = frame(0, 0x100, {});
  other[9] = 1;
  device.on_data(other);
  EXPECT_EQ(device.malformed(), 5u);
  EXPECT_EQ(device.next_frame(), nullptr);
  Bytes three = frame(0, 0x100, {1});
  for (const std::uint32_t id : {0x101u, 0x102u}) {
    const Bytes more = frame(1, id, {2});
    three.insert(three.end(), more.begin(), more.end());
  }
  device.on_data(three);
  int count = 0;
  for (; device.next_frame() != nullptr; ++count) device.drop_frame();
  EXPECT_EQ(count, 3) << "several in a packet";
}

TEST_F(GsUsb, TellsTheControllersStateOnceForEachChange) {
  ASSERT_TRUE(mode(1, 0));
  const auto classes = [&] {
    const auto packet = device.next_data();
    return packet ? std::pair{get_u32_le(packet->subspan(4)), int{(*packet)[13]}} : std::pair{0u, 0};
  };
  device.on_state({CanState::kPassive, 0, 128}, 0);
  device.on_state({CanState::kPassive, 0, 136}, 0);
  EXPECT_EQ(classes(), (std::pair{1u << 29 | 0x204, 0x30}));
  EXPECT_EQ(classes().first, 0u);
  EXPECT_EQ(read(14, 12), words({2, 0, 136}));
  device.on_state({CanState::kBusOff, 0, 255}, 0);
  EXPECT_EQ(classes().first, 1u << 29 | 0x240);
  device.on_state({CanState::kActive, 0, 0}, 0);
  EXPECT_EQ(classes().first, 1u << 29 | 0x300);
  device.on_alone(0);
  EXPECT_EQ(classes().first, 1u << 29 | 0x220);
}

}  // namespace
}  // namespace kinebus
