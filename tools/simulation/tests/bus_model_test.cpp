#include "tools/simulation/bus/bus_model.hpp"

#include <gtest/gtest.h>

#include "protocol/can/bit_length.hpp"

namespace kinebus {
namespace {

using std::chrono::microseconds;

BusModel::Delivery next(BusModel& bus) {
  const auto delivery = bus.advance(bus.next_event());
  EXPECT_TRUE(delivery.has_value());
  return delivery.value_or(BusModel::Delivery{});
}

TEST(BusModel, FrameEndsAfterItsStuffedBits) {
  BusModel bus;
  const auto port = bus.add_port(1);
  const CanFrame frame = CanFrame::make(0x555, {0xAA, 0x55});
  bus.send(port, microseconds{100}, frame);
  EXPECT_EQ(bus.next_event(), BusTime{microseconds{100 + bit_length_to_end_of_frame(frame)}});
  EXPECT_EQ(next(bus).frame, frame);
  EXPECT_EQ(bus.next_event(), BusTime::max());
}

TEST(BusModel, LowestIdentifierWinsWhenTheBusGetsFree) {
  BusModel bus;
  const auto a = bus.add_port(3), b = bus.add_port(1);
  bus.send(a, microseconds{0}, CanFrame::make(0x700, {}));  // has begun before the others come
  bus.send(a, microseconds{1}, CanFrame::make(0x401, {1}));
  bus.send(b, microseconds{2}, CanFrame::make(0x080, {1}));
  EXPECT_EQ(next(bus).frame.id, 0x700u);
  EXPECT_EQ(next(bus).frame.id, 0x080u);
  EXPECT_EQ(next(bus).frame.id, 0x401u);
}

TEST(BusModel, EqualIdentifiersOfOnePortKeepTheirOrder) {
  BusModel bus;
  const auto port = bus.add_port(3);
  bus.send(port, microseconds{0}, CanFrame::make(0x100, {}));
  bus.send(port, microseconds{0}, CanFrame::make(0x401, {1}));
  bus.send(port, microseconds{0}, CanFrame::make(0x401, {2}));
  next(bus);
  EXPECT_EQ(next(bus).frame.data[0], 1);
  EXPECT_EQ(next(bus).frame.data[0], 2);
}

TEST(BusModel, StandardDataBeatsRemoteBeatsExtendedOfTheSameBase) {
  BusModel bus;
  const auto a = bus.add_port(1), b = bus.add_port(1), c = bus.add_port(1), d = bus.add_port(1);
  bus.send(d, microseconds{0}, CanFrame::make(0x001, {}));
  CanFrame extended{.id = 0x123u << 18, .extended = true};
  CanFrame remote{.id = 0x123, .remote = true};
  bus.send(a, microseconds{0}, extended);
  bus.send(b, microseconds{0}, remote);
  bus.send(c, microseconds{0}, CanFrame::make(0x123, {}));
  next(bus);
  EXPECT_EQ(next(bus).from, c);
  EXPECT_EQ(next(bus).from, b);
  EXPECT_EQ(next(bus).from, a);
}

TEST(BusModel, BackToBackFramesFillTheBus) {
  BusModel bus;
  const auto port = bus.add_port(3);
  BusTime now{0};
  for (int i = 0; i < 1000; ++i) {
    while (bus.has_room(port)) bus.send(port, now, CanFrame::make(0x401, {1, 2, 3, 4, 5, 6, 7, 8}));
    now = next(bus).end;
  }
  EXPECT_NEAR(to_seconds(now), static_cast<double>(bus.statistics().bits) * 1e-6, 300e-6);
}

}  // namespace
}  // namespace kinebus
