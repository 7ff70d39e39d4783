#include "node_firmware/usb/cdc_device.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "protocol/bytes.hpp"

namespace kinebus {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// The control endpoint as a host uses it.
struct Host {
  Host() { device.control().identify({0x0123'4567, 0x89AB'CDEF, 0x0F1E'2D3C}); }

  void setup(std::uint8_t type, std::uint8_t request, unsigned value, unsigned index, unsigned length) {
    std::array<std::uint8_t, 8> bytes{type, request};
    put_u16_le(std::span(bytes).subspan(2), static_cast<std::uint16_t>(value));
    put_u16_le(std::span(bytes).subspan(4), static_cast<std::uint16_t>(index));
    put_u16_le(std::span(bytes).subspan(6), static_cast<std::uint16_t>(length));
    device.on_setup(bytes);
  }
  /// The data stage; empty optional: stalled.
  std::optional<Bytes> read(std::uint8_t type, std::uint8_t request, unsigned value, unsigned index,
                            unsigned length) {
    setup(type, request, value, index, length);
    Bytes all;
    packets = 0;
    while (const auto packet = device.control().next_packet()) {
      EXPECT_LE(packet->size(), cdc::kPacketBytes);
      all.insert(all.end(), packet->begin(), packet->end());
      ++packets;
    }
    if (device.control().stalled()) return std::nullopt;
    return all;
  }
  /// A request without data: true: its status came.
  bool command(std::uint8_t type, std::uint8_t request, unsigned value, unsigned index = 0) {
    const auto status = read(type, request, value, index, 0);
    return status && status->empty() && packets == 1;
  }
  void open() {
    device.on_reset();
    EXPECT_TRUE(command(0x00, 5, 42));
    EXPECT_TRUE(command(0x00, 9, 1));
    device.control().take_changes();
    device.take_hang_up();
  }
  std::string text(unsigned index, unsigned length = 255) {
    const auto got = read(0x80, 6, 0x0300 + index, 0x0409, length);
    if (!got) return "stalled";
    std::string out;
    for (std::size_t i = 2; i + 1 < got->size(); i += 2) out += static_cast<char>((*got)[i]);
    EXPECT_EQ((*got)[0], got->size());
    return out;
  }

  CdcDevice device;
  int packets = 0;
};

TEST(CdcDevice, EnumeratesAsAHostAsksIt) {
  Host host;
  host.device.on_reset();
  EXPECT_EQ(host.device.control().address(), 0);
  // A host asks for eight bytes first: the packet size is the last of them.
  EXPECT_EQ(host.read(0x80, 6, 0x0100, 0, 8), (Bytes{18, 1, 0, 2, 2, 0, 0, 64}));
  EXPECT_TRUE(host.command(0x00, 5, 42));
  EXPECT_EQ(host.device.control().address(), 42);
  EXPECT_EQ(host.read(0x80, 6, 0x0100, 0, 64)->size(), 18u);
  EXPECT_EQ(host.read(0x80, 6, 0x0200, 0, 9)->at(2), 67);
  EXPECT_EQ(host.read(0x80, 6, 0x0200, 0, 67)->size(), 67u);
  EXPECT_EQ(host.packets, 2);
  EXPECT_EQ(host.text(1), "Kinebus");
  EXPECT_EQ(host.text(2), "Kinebus node");
  EXPECT_EQ(host.text(3), "0123456789ABCDEF0F1E2D3C");
  EXPECT_EQ(host.read(0x80, 6, 0x0300, 0, 255), (Bytes{4, 3, 0x09, 0x04}));
  EXPECT_EQ(host.read(0x80, 8, 0, 0, 1), Bytes{0});
  EXPECT_FALSE(host.device.control().open());
  EXPECT_TRUE(host.command(0x00, 9, 1));
  EXPECT_EQ(host.read(0x80, 8, 0, 0, 1), Bytes{1});
  EXPECT_TRUE(host.device.control().open());
  EXPECT_EQ(host.device.control().take_changes(), 7);
  ASSERT_TRUE(host.device.next_notification());
  EXPECT_FALSE(host.device.next_notification());
}

TEST(CdcDevice, DescriptorsAreWellFormedAndNameEachEndpointOnce) {
  const auto& all = cdc::kConfigurationDescriptor;
  EXPECT_EQ(get_u16_le(std::span(all).subspan(2)), all.size());
  std::vector<int> endpoints, interfaces;
  std::size_t at = 0;
  while (at < all.size()) {
    ASSERT_GE(all[at], 2);
    ASSERT_LE(at + all[at], all.size());
    if (all[at + 1] == cdc::kEndpoint) endpoints.push_back(all[at + 2]);
    if (all[at + 1] == cdc::kInterface) interfaces.push_back(all[at + 2]);
    at += all[at];
  }
  EXPECT_EQ(at, all.size());
  EXPECT_EQ(endpoints, (std::vector<int>{0x82, 0x01, 0x81}));
  EXPECT_EQ(interfaces, (std::vector<int>{0, 1}));
}

TEST(CdcDevice, GivesNoMoreThanWasAskedFor) {
  Host host;
  for (unsigned length = 0; length <= 70; ++length) {
    const auto got = host.read(0x80, 6, 0x0200, 0, length);
    ASSERT_TRUE(got);
    EXPECT_EQ(got->size(), std::min(length, 67u));
  }
  EXPECT_EQ(host.read(0x80, 6, 0x0200, 0, 64)->size(), 64u);
  EXPECT_EQ(host.packets, 1) << "nothing empty after what was asked for";
}

TEST(CdcDevice, StallsWhatItDoesNotKnow) {
  Host host;
  host.open();
  struct Wrong {
    std::uint8_t type, request;
    unsigned value, index, length;
  };
  for (const Wrong& w :
       std::initializer_list<Wrong>{{0x80, 6, 0x0600, 0, 10},   // device qualifier: no high speed
                                    {0x80, 6, 0x0304, 0, 255},  // no such string
                                    {0x80, 6, 0x0101, 0, 18},   // no such device descriptor
                                    {0x00, 7, 0x0100, 0, 18},   // set descriptor
                                    {0x00, 5, 128, 0, 0},       // no such address
                                    {0x00, 9, 2, 0, 0},         // no such configuration
                                    {0x00, 3, 1, 0, 0},         // remote wake-up
                                    {0x00, 3, 2, 0x0100, 0},    // test mode
                                    {0x02, 3, 0, 0x00, 0},      // the control endpoint does not halt
                                    {0x02, 3, 0, 0x83, 0},      // no such endpoint
                                    {0x02, 3, 1, 0x81, 0},      // no such feature
                                    {0x82, 0, 0, 0x05, 2},      // no such endpoint
                                    {0x81, 0, 0, 2, 2},         // no such interface
                                    {0x01, 11, 1, 0, 0},        // no such alternate setting
                                    {0x21, 0x20, 0, 0, 8},      // a line coding has seven bytes
                                    {0x21, 0x20, 0, 0, 0},      // and has them
                                    {0x21, 0x23, 100, 0, 0},    // break
                                    {0x21, 0x22, 1, 0, 3},      // data where none belong
                                    {0x40, 1, 0, 0, 0},         // vendor
                                    {0xFF, 0xFF, 0xFFFF, 0xFFFF, 0xFFFF}}) {
    EXPECT_EQ(host.read(w.type, w.request, w.value, w.index, w.length), std::nullopt)
        << std::hex << int{w.type} << " " << int{w.request} << " " << w.value;
    EXPECT_TRUE(host.command(0x21, 0x22, 1)) << "the next request is answered";
  }
  EXPECT_EQ(host.device.control().address(), 42);
  EXPECT_TRUE(host.device.control().open());
}

TEST(CdcDevice, KeepsTheLineCodingThatItGets) {
  Host host;
  host.open();
  EXPECT_EQ(host.read(0xA1, 0x21, 0, 0, 7), (Bytes{0x00, 0xC2, 0x01, 0, 0, 0, 8}));
  const Bytes coding{0x80, 0x25, 0, 0, 2, 1, 7};
  host.setup(0x21, 0x20, 0, 0, 7);
  EXPECT_FALSE(host.device.control().next_packet()) << "no status before the data";
  host.device.on_control_data(coding);
  ASSERT_TRUE(host.device.control().next_packet());
  EXPECT_EQ(host.read(0xA1, 0x21, 0, 0, 7), coding);
  host.setup(0x21, 0x20, 0, 0, 7);
  host.device.on_control_data(std::span(coding).first(3));
  EXPECT_TRUE(host.device.control().stalled());
  EXPECT_EQ(host.read(0xA1, 0x21, 0, 0, 7), coding);
}

TEST(CdcDevice, ASetupPacketEndsWhateverWasUnderWay) {
  Host host;
  host.open();
  host.setup(0x80, 6, 0x0200, 0, 67);
  EXPECT_EQ(host.device.control().next_packet()->size(), 64u);
  EXPECT_EQ(host.read(0x80, 0, 0, 0, 2), (Bytes{1, 0}));
  host.setup(0x21, 0x20, 0, 0, 7);
  EXPECT_TRUE(host.command(0x21, 0x22, 1));
  host.device.on_control_data(Bytes(7));
  EXPECT_FALSE(host.device.control().next_packet()) << "data of a request that is over";
  EXPECT_EQ(host.read(0xA1, 0x21, 0, 0, 7)->at(1), 0xC2);
}

TEST(CdcDevice, HaltsAndReleasesAnEndpoint) {
  Host host;
  host.open();
  EXPECT_TRUE(host.command(0x02, 3, 0, 0x81));
  EXPECT_TRUE(host.device.control().halted(CdcDevice::kDataIn));
  EXPECT_FALSE(host.device.control().halted(CdcDevice::kDataOut));
  EXPECT_EQ(host.device.control().take_changes(), 1 << CdcDevice::kDataIn);
  EXPECT_EQ(host.read(0x82, 0, 0, 0x81, 2), (Bytes{1, 0}));
  EXPECT_EQ(host.read(0x82, 0, 0, 0x01, 2), (Bytes{0, 0}));
  EXPECT_TRUE(host.command(0x02, 1, 0, 0x81));
  EXPECT_EQ(host.device.control().take_changes(), 1 << CdcDevice::kDataIn);
  EXPECT_EQ(host.read(0x82, 0, 0, 0x81, 2), (Bytes{0, 0}));
  EXPECT_EQ(host.read(0x82, 0, 0, 0, 2), (Bytes{0, 0}));
}

TEST(CdcDevice, GivesCharactersOnlyWhenOpenAndTakesThePacketAfterTheLast) {
  Host host;
  EXPECT_FALSE(host.device.takes_data());
  host.open();
  ASSERT_TRUE(host.device.takes_data());
  host.device.on_data(Bytes{'s', 'v' | 0x80});
  EXPECT_FALSE(host.device.takes_data());
  EXPECT_EQ(host.device.next_char(), 's');
  EXPECT_FALSE(host.device.takes_data());
  EXPECT_EQ(host.device.next_char(), 'v');
  EXPECT_EQ(host.device.next_char(), std::nullopt);
  EXPECT_TRUE(host.device.takes_data());
  host.device.on_data(Bytes(64, 'c'));
  host.device.on_reset();
  EXPECT_EQ(host.device.next_char(), std::nullopt) << "what came before a bus reset is gone";
}

TEST(CdcDevice, HangsUpWhenTheTerminalOrTheBusGoes) {
  Host host;
  host.open();
  EXPECT_TRUE(host.command(0x21, 0x22, 3));
  EXPECT_FALSE(host.device.take_hang_up());
  EXPECT_TRUE(host.command(0x21, 0x22, 0));
  EXPECT_TRUE(host.device.take_hang_up());
  EXPECT_FALSE(host.device.take_hang_up());
  host.device.on_reset();
  EXPECT_TRUE(host.device.take_hang_up());
  EXPECT_FALSE(host.device.control().open());
  EXPECT_EQ(host.device.control().address(), 0);
}

}  // namespace
}  // namespace kinebus
