#include "protocol/can/candump.hpp"

#include <gtest/gtest.h>

#include <random>

namespace kinebus {
namespace {

TEST(Candump, SdoRequestReadsAsCanUtilsWriteIt) {
  const auto frame = parse_frame("601#4041600000000000");
  ASSERT_TRUE(frame);
  EXPECT_EQ(*frame, CanFrame::make(0x601, {0x40, 0x41, 0x60, 0, 0, 0, 0, 0}));
  EXPECT_EQ(to_text(*frame).view(), "601#4041600000000000");
}

TEST(Candump, ExtendedRemoteAndEmptyFramesRoundTrip) {
  for (const char* text : {"1F334455#112233", "080#", "123#R", "123#R5", "00000001#R8", "7FF#00"}) {
    const auto frame = parse_frame(text);
    ASSERT_TRUE(frame) << text;
    EXPECT_EQ(to_text(*frame).view(), text);
  }
}

TEST(Candump, LowerCaseDotsAndBlanksAreRead) {
  EXPECT_EQ(parse_frame("  1a2#de.ad.be.ef\n"), CanFrame::make(0x1A2, {0xDE, 0xAD, 0xBE, 0xEF}));
}

TEST(Candump, LogLineCarriesTimeAndInterface) {
  const auto line = parse_candump("(1436509052.249713) vcan0 044#2A366C2BBA");
  ASSERT_TRUE(line);
  EXPECT_EQ(line->time, std::chrono::microseconds{1436509052249713});
  EXPECT_EQ(line->interface, "vcan0");
  EXPECT_EQ(line->frame.id, 0x44u);
  EXPECT_EQ(to_candump(*line).view(), "(1436509052.249713) vcan0 044#2A366C2BBA");
  EXPECT_TRUE(parse_candump("can0 7FF#01"));
  EXPECT_TRUE(parse_candump("(0000000001.000002) can0 701#05 T"));
}

TEST(Candump, MalformedTextIsRefused) {
  for (const char* text : {"", "#", "12#00", "1234#00", "800#00", "20000000#00", "123#0", "123#0g",
                           "123##1AA", "123#112233445566778899", "123#R9", "123#R11", "12x#00", "123#.00"})
    EXPECT_FALSE(parse_frame(text)) << text;
  for (const char* text : {"(1.5) can0 123#00", "(x) can0 123#00", "can0", "can0 123#00 more", "a b 123#00"})
    EXPECT_FALSE(parse_candump(text)) << text;
}

TEST(Candump, RandomFramesRoundTrip) {
  std::mt19937 generator(7);
  const auto random = [&] { return static_cast<std::uint32_t>(generator()); };
  for (int i = 0; i < 2000; ++i) {
    CanFrame frame;
    frame.extended = (random() & 1) != 0;
    frame.remote = (random() & 7) == 0;
    frame.id = random() & (frame.extended ? 0x1FFFFFFFu : 0x7FFu);
    frame.length = static_cast<std::uint8_t>(random() % 9);
    if (!frame.remote)
      for (int b = 0; b < frame.length; ++b)
        frame.data[static_cast<std::size_t>(b)] = static_cast<std::uint8_t>(random());
    EXPECT_EQ(parse_frame(to_text(frame).view()), frame) << to_text(frame).view();
  }
}

}  // namespace
}  // namespace kinebus
