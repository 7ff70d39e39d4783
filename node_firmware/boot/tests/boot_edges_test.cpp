// What a boot loader says to requests that are not an update, and to updates that cannot be.

#include <algorithm>
#include <string>

#include "node_firmware/boot/tests/boot_bench.hpp"

namespace kinebus {
namespace {

struct BootEdges : BootBench {
  void SetUp() override { ASSERT_FALSE(reset()); }

  AbortCode write(ObjectAddress address, std::span<const std::uint8_t> bytes) {
    return transfer([&](SdoClient& c) { c.download(now, 7, address, bytes); });
  }
  std::uint32_t status() { return read(0x1F57, 1) >> 1; }
  void expect_status(ProgramStatus wanted) { EXPECT_EQ(status(), static_cast<std::uint32_t>(wanted)); }

  void send(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
    CanFrame frame{};
    frame.id = static_cast<decltype(frame.id)>(id);
    frame.length = static_cast<decltype(frame.length)>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), frame.data.begin());
    boot->on_frame(now, frame);
  }
  /// Of all that it says the first frame with this id.
  std::optional<CanFrame> said(std::uint32_t id) {
    std::optional<CanFrame> found;
    while (const auto frame = boot->next_frame())
      if (!found && frame->id == id) found = frame;
    return found;
  }
};

TEST_F(BootEdges, AFlashThatIsNotErasedIsToldAndNothingIsWritten) {
  ASSERT_EQ(download(make_image(5000, 1)), AbortCode::kNone);
  EXPECT_EQ(flash.erasures, 0) << "it was blank";
  flash.erases = false;
  EXPECT_EQ(control(program_control::kClear), AbortCode::kHardware);
  expect_status(ProgramStatus::kNotCleared);
  const int before = flash.programmed;
  EXPECT_EQ(download(make_image(5000, 2)), AbortCode::kHardware);
  expect_status(ProgramStatus::kNotCleared);
  EXPECT_EQ(flash.programmed, before);
  flash.erases = true;
  EXPECT_EQ(control(program_control::kClear), AbortCode::kNone);
  expect_status(ProgramStatus::kNoProgram);
  EXPECT_EQ(read(0x1F56, 1), 0U) << "the CRC of no program";
  EXPECT_EQ(download(make_image(5000, 2)), AbortCode::kNone);
  EXPECT_EQ(flash.erasures, 1);
  EXPECT_EQ(download(make_image(5000, 3)), AbortCode::kNone);
  EXPECT_EQ(flash.erasures, 2) << "what is not blank is erased first";
}

TEST_F(BootEdges, AWordThatTheFlashDoesNotTakeEndsTheUpdate) {
  flash.fails_from = 2000;
  EXPECT_EQ(download(make_image(5000, 1)), AbortCode::kHardware);
  expect_status(ProgramStatus::kWriteError);
  EXPECT_EQ(flash.programmed, 501) << "none is tried behind it";
  // The word that only fills the last unit.
  flash.fails_from = 3004;
  EXPECT_EQ(control(program_control::kClear), AbortCode::kNone);
  EXPECT_EQ(download(make_image(3004, 1)), AbortCode::kHardware);
  expect_status(ProgramStatus::kWriteError);
}

TEST_F(BootEdges, TheLastUnitIsFilledAndNoneIsAdded) {
  ASSERT_EQ(download(make_image(3004, 1)), AbortCode::kNone);
  EXPECT_EQ(flash.programmed, 3008 / 4);
  ASSERT_EQ(download(make_image(3008, 1)), AbortCode::kNone);
  EXPECT_EQ(flash.programmed, 2 * 3008 / 4);
}

TEST_F(BootEdges, AnImageMayFillTheRoomAndNotMore) {
  EXPECT_EQ(download(make_image(kBootRoom, 1)), AbortCode::kNone);
  EXPECT_TRUE(reset());
  handover.stay = 1;
  ASSERT_FALSE(reset());
  // Its header says less than comes.
  std::vector<std::uint8_t> longer = make_image(kBootRoom, 1);
  longer.resize(kBootRoom + 100);
  EXPECT_EQ(download(longer), AbortCode::kTooLong);
  expect_status(ProgramStatus::kAddressError);
  handover.stay = 0;
  EXPECT_FALSE(reset());
}

TEST_F(BootEdges, AnUpdateThatIsGivenUpLeavesNoProgram) {
  ASSERT_EQ(download(make_image(5000, 1)), AbortCode::kNone);
  const auto image = make_image(5000, 2);
  SdoClient client;
  client.download(now, 7, {0x1F50, 1}, image, SdoClient::Method::kSegmented);
  for (int i = 0; i < 200; ++i) {
    while (const auto frame = client.next_frame()) boot->on_frame(now, *frame);
    while (const auto frame = boot->next_frame()) client.on_frame(now, *frame);
  }
  client.cancel();
  while (const auto frame = client.next_frame()) boot->on_frame(now, *frame);
  expect_status(ProgramStatus::kNoProgram);
  EXPECT_EQ(control(program_control::kStart), AbortCode::kDeviceState);
  EXPECT_EQ(download(image), AbortCode::kNone) << "from its beginning";
}

TEST_F(BootEdges, ATransferThatStopsIsEndedAfterTenSeconds) {
  send(0x607, {0x21, 0x50, 0x1F, 1, 0x88, 0x13, 0, 0});
  ASSERT_TRUE(said(0x587));
  boot->on_time(now += std::chrono::seconds{9});
  EXPECT_FALSE(said(0x587));
  boot->on_time(now += std::chrono::seconds{2});
  const auto end = said(0x587);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->data[0], 0x80);
}

TEST_F(BootEdges, HeadersAreReadToTheirLastByte) {
  const std::vector<std::uint8_t> image = make_image(ImageHeader::kOffset + ImageHeader::kBytes, 1);
  EXPECT_EQ(check_image(image, kBootBoard), ImageCheck::kGood);
  EXPECT_EQ(check_header(std::span(image).first(image.size() - 1), kBootRoom, kBootBoard), ImageCheck::kNone);
  EXPECT_EQ(check_header({}, kBootRoom, kBootBoard), ImageCheck::kNone);
  const auto check = [&](auto change) {
    ImageHeader header = decode_image_header(image);
    change(header);
    std::vector<std::uint8_t> changed = image;
    encode_image_header(header, changed);
    return check_header(changed, kBootRoom, kBootBoard);
  };
  EXPECT_EQ(check([](ImageHeader& h) { h.format = ImageHeader::kFormat + 1; }), ImageCheck::kOtherDevice);
  EXPECT_EQ(check([](ImageHeader& h) { h.length -= 4; }), ImageCheck::kLength) << "shorter than its header";
  EXPECT_EQ(check([](ImageHeader& h) { h.length += 2; }), ImageCheck::kLength) << "no whole words";
  EXPECT_EQ(check([](ImageHeader& h) { h.length = kBootRoom; }), ImageCheck::kGood);
  EXPECT_EQ(check([](ImageHeader& h) { h.length = kBootRoom + 4; }), ImageCheck::kLength);
}

TEST_F(BootEdges, WritesOfTheWrongLengthOrPlaceChangeNothing) {
  ASSERT_EQ(download(make_image(5000, 1)), AbortCode::kNone);
  const std::array<std::uint8_t, 4> four{program_control::kStart, 0, 0, 0};
  EXPECT_EQ(write({0x1F51, 1}, std::span(four).first(2)), AbortCode::kLength);
  EXPECT_FALSE(boot->start_requested());
  EXPECT_EQ(control(9), AbortCode::kInvalidValue);
  EXPECT_EQ(write(kRecordedRevision, std::span(four).first(2)), AbortCode::kLength);
  EXPECT_EQ(write(kRecordedRevision, std::array<std::uint8_t, 8>{1}), AbortCode::kLength);
  EXPECT_EQ(read(0x2124, 2), 0U);
  EXPECT_EQ(write(kRecordedHardware, four), AbortCode::kReadOnly);
  EXPECT_EQ(write({0x1018, 2}, four), AbortCode::kReadOnly);
  EXPECT_EQ(write({0x6040, 0}, four), AbortCode::kNoObject);
}

TEST_F(BootEdges, ObjectsHaveTheirLengths) {
  // The answer's first byte says how many of its four bytes are none.
  const auto length = [&](std::uint16_t index, std::uint8_t sub) {
    send(0x607, {0x40, static_cast<std::uint8_t>(index & 0xFF), static_cast<std::uint8_t>(index >> 8), sub, 0,
                 0, 0, 0});
    const auto answer = said(0x587);
    return !answer || answer->data[0] == 0x80 ? 0 : 4 - (answer->data[0] >> 2 & 3);
  };
  for (const auto& [index, sub] : std::initializer_list<std::pair<std::uint16_t, std::uint8_t>>{{0x1001, 0},
                                                                                                {0x1018, 0},
                                                                                                {0x1F50, 0},
                                                                                                {0x1F51, 0},
                                                                                                {0x1F56, 0},
                                                                                                {0x1F57, 0},
                                                                                                {0x1F51, 1},
                                                                                                {0x2122, 0},
                                                                                                {0x2124, 0}})
    EXPECT_EQ(length(index, sub), 1) << std::hex << index << ":" << int{sub};
  for (const auto& [index, sub] : std::initializer_list<std::pair<std::uint16_t, std::uint8_t>>{{0x1000, 0},
                                                                                                {0x1018, 1},
                                                                                                {0x1018, 4},
                                                                                                {0x1F56, 1},
                                                                                                {0x1F57, 1},
                                                                                                {0x2123, 0},
                                                                                                {0x2124, 1},
                                                                                                {0x2124, 3}})
    EXPECT_EQ(length(index, sub), 4) << std::hex << index << ":" << int{sub};
  EXPECT_EQ(length(0x1F50, 1), 0) << "what was written is not read back";
  EXPECT_EQ(length(0x6040, 0), 0) << "that is the program's";
  EXPECT_EQ(read(0x2123, 0), kBootRoom);

  std::array<std::uint8_t, 40> room{};
  std::size_t received = 0;
  SdoClient client;
  client.upload(now, 7, {0x1008, 0}, room);
  while (client.status() == SdoClient::Status::kBusy) {
    while (const auto frame = client.next_frame()) boot->on_frame(now, *frame);
    while (const auto frame = boot->next_frame()) client.on_frame(now, *frame);
  }
  received = client.received();
  EXPECT_EQ(std::string(room.begin(), room.begin() + static_cast<std::ptrdiff_t>(received)),
            "Kinebus boot loader");
}

TEST_F(BootEdges, SaysThatItIsThereAndGoesOnSayingSo) {
  const auto boot_up = said(0x707);
  ASSERT_TRUE(boot_up);
  EXPECT_EQ(boot_up->length, 1);
  EXPECT_EQ(boot_up->data[0], 0);
  int heartbeats = 0;
  for (int ms = 0; ms < 5000; ms += 10) {
    boot->on_time(now += std::chrono::milliseconds{10});
    if (const auto beat = said(0x707)) {
      ++heartbeats;
      EXPECT_EQ(beat->data[0], 0x7F) << "pre-operational";
    }
  }
  EXPECT_EQ(heartbeats, 10);
}

TEST_F(BootEdges, NmtResetsBeginItAnewAndNothingElseDoes) {
  static_cast<void>(said(0x707));
  for (const auto reset_by : std::array<std::uint8_t, 2>{0x81, 0x82}) {
    send(0x000, {reset_by, 7});
    const auto boot_up = said(0x707);
    ASSERT_TRUE(boot_up) << int{reset_by};
    EXPECT_EQ(boot_up->data[0], 0);
  }
  for (const auto other : std::array<std::uint8_t, 3>{0x01, 0x02, 0x80}) {
    send(0x000, {other, 7});
    EXPECT_FALSE(said(0x707)) << int{other};
  }
  send(0x000, {0x81, 8});
  EXPECT_FALSE(said(0x707)) << "another node's";
  EXPECT_EQ(read(0x1F51, 1), 0U) << "stopped, it still answers";
}

TEST_F(BootEdges, AnotherIdCountsFromTheResetOnAndIsNotKept) {
  static_cast<void>(said(0x707));
  send(0x7E5, {4, 1, 0, 0, 0, 0, 0, 0});
  send(0x7E5, {17, 9, 0, 0, 0, 0, 0, 0});
  const auto set = said(0x7E4);
  ASSERT_TRUE(set);
  EXPECT_EQ(set->data[1], 0);
  send(0x7E5, {23, 0, 0, 0, 0, 0, 0, 0});
  const auto kept = said(0x7E4);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->data[0], 23);
  EXPECT_NE(kept->data[1], 0) << "what outlives it belongs to the program";
  send(0x7E5, {4, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_FALSE(said(0x709));
  send(0x000, {0x82, 0});
  EXPECT_TRUE(said(0x709));
}

TEST_F(BootEdges, WithoutAnIdAResetChangesNothingAndNobodyIsAnswered) {
  boot = std::make_unique<BootLoader>(kBootBoard, kBootIdentity, 0, flash, now);
  send(0x000, {0x81, 0});
  send(0x600, {0x40, 0x18, 0x10, 1, 0, 0, 0, 0});
  EXPECT_FALSE(boot->next_frame());
  // Switched back to waiting with an id it boots at once: heard by what is no NMT command.
  send(0x7E5, {4, 1, 0, 0, 0, 0, 0, 0});
  send(0x7E5, {17, 9, 0, 0, 0, 0, 0, 0});
  static_cast<void>(said(0x7E4));
  send(0x7E5, {4, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_TRUE(said(0x709));
}

}  // namespace
}  // namespace kinebus
