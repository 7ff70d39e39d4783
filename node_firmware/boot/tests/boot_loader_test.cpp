#include "node_firmware/boot/tests/boot_bench.hpp"

namespace kinebus {
namespace {

struct Boot : BootBench {};

TEST_F(Boot, TheBoardIsRecordedForGoodAndTheLastWholeRecordCounts) {
  ASSERT_FALSE(reset());
  const auto record = [&](std::uint32_t revision) {
    std::array<std::uint8_t, 4> bytes{};
    put_u32_le(bytes, revision);
    return transfer([&](SdoClient& c) { c.download(now, 7, kRecordedRevision, bytes); });
  };
  EXPECT_EQ(read(0x2124, 1), 0u) << "blank";
  EXPECT_TRUE(board_record::is_own(flash.record_memory, kBootBoard.hardware)) << "a board that says nothing";
  EXPECT_EQ(record(0), AbortCode::kInvalidValue);
  EXPECT_EQ(record(kHighestRevision + 1), AbortCode::kInvalidValue);
  // The power went in the middle of the first slot: it is lost, and read by nobody.
  put_u32_le(flash.record_memory, board_record::kMagic);
  EXPECT_EQ(read(0x2124, 1), 0u);
  EXPECT_EQ(record(kHighestRevision), AbortCode::kNone);
  EXPECT_EQ(read(0x2124, 1), kBootBoard.hardware);
  EXPECT_EQ(read(0x2124, 2), kHighestRevision);
  EXPECT_EQ(read(0x2124, 3), kBootIdentity[3]);
  EXPECT_TRUE(board_record::is_own(flash.record_memory, kBootBoard.hardware));
  EXPECT_FALSE(board_record::is_own(flash.record_memory, kBootBoard.hardware + 1));
  EXPECT_EQ(record(13), AbortCode::kHardware) << "no slot is left";
  EXPECT_EQ(read(0x2124, 2), kHighestRevision);
}

TEST_F(Boot, TheChipIsProtectedByASignatureAndNothingElse) {
  ASSERT_FALSE(reset());
  const auto protect = [&](std::uint32_t signature, std::size_t length = 4) {
    std::array<std::uint8_t, 4> bytes{};
    put_u32_le(bytes, signature);
    return transfer([&](SdoClient& c) { c.download(now, 7, {0x2122, 0}, std::span(bytes).first(length)); });
  };
  EXPECT_EQ(read(0x2122, 0), 3u) << "brown-out level and boot loader";
  EXPECT_EQ(protect(0x6576'6173), AbortCode::kCannotStore);
  EXPECT_EQ(protect(kProtectSignature, 2), AbortCode::kLength);
  EXPECT_EQ(read(0x2122, 0), 3u);
  flash.locks = false;
  EXPECT_EQ(protect(kProtectSignature), AbortCode::kHardware) << "a chip that says so and does not take it";
  flash.locks = true;
  flash.says_that_it_locks = false;
  EXPECT_EQ(protect(kProtectSignature), AbortCode::kHardware);
  flash.says_that_it_locks = true;
  EXPECT_EQ(protect(kProtectSignature), AbortCode::kNone);
  EXPECT_EQ(read(0x2122, 0), 0u);
}

TEST_F(Boot, ABlankBoardAnswersTakesAProgramAndStartsIt) {
  ASSERT_FALSE(reset());
  EXPECT_EQ(read(0x1018, 2), kProductCode);
  EXPECT_EQ(read(0x1F57, 1), 2u) << "no valid program";
  EXPECT_EQ(control(program_control::kStart), AbortCode::kDeviceState);
  const auto image = make_image(5000, 1);
  EXPECT_EQ(control(program_control::kClear), AbortCode::kNone);
  EXPECT_EQ(download(image), AbortCode::kNone);
  EXPECT_EQ(read(0x1F57, 1), 0u);
  EXPECT_EQ(read(0x1F56, 1), decode_image_header(image).crc);
  EXPECT_FALSE(boot->start_requested());
  EXPECT_EQ(control(program_control::kStart), AbortCode::kNone);
  EXPECT_TRUE(boot->start_requested());
  EXPECT_TRUE(reset());
}

TEST_F(Boot, ASegmentedDownloadDoesAsWell) {
  ASSERT_FALSE(reset());
  EXPECT_EQ(download(make_image(3004, 1), SdoClient::Method::kSegmented), AbortCode::kNone);
  EXPECT_TRUE(reset());
}

TEST_F(Boot, AnImageForSomethingElseLeavesTheProgramAlone) {
  ASSERT_FALSE(reset());
  ASSERT_EQ(download(make_image(5000, 1)), AbortCode::kNone);
  const int erasures = flash.erasures;
  ImageHeader other = image_header_for(kBootBoard);
  other.product_code = kProductCode + 1;
  EXPECT_EQ(download(make_image(4000, 2, other)), AbortCode::kCannotStore);
  EXPECT_EQ(read(0x1F57, 1), static_cast<std::uint32_t>(ProgramStatus::kFormatError) << 1);
  other = image_header_for(kBootBoard);
  other.hardware = 1;
  EXPECT_EQ(download(make_image(4000, 2, other)), AbortCode::kCannotStore);
  EXPECT_EQ(download(std::vector<std::uint8_t>(2000, 0x55)), AbortCode::kCannotStore);
  auto too_long = make_image(4000, 2);
  ImageHeader header = decode_image_header(too_long);
  header.length = kBootRoom + 4;
  encode_image_header(header, too_long);
  EXPECT_EQ(download(too_long), AbortCode::kTooLong);
  EXPECT_EQ(flash.erasures, erasures);
  EXPECT_TRUE(reset());
}

TEST_F(Boot, ADamagedImageIsNotStarted) {
  ASSERT_FALSE(reset());
  auto image = make_image(5000, 1);
  image[3000] ^= 4;
  EXPECT_EQ(download(image), AbortCode::kCrc);
  EXPECT_EQ(control(program_control::kStart), AbortCode::kDeviceState);
  EXPECT_FALSE(reset());
}

TEST_F(Boot, TheProgramGivesWayWhenAsked) {
  ASSERT_FALSE(reset());
  ASSERT_EQ(download(make_image(5000, 1)), AbortCode::kNone);
  ASSERT_TRUE(reset());
  handover.stay = 1;
  EXPECT_FALSE(reset());
  EXPECT_EQ(read(0x1F51, 1), 0u);
}

TEST_F(Boot, AProgramThatNeverProvesItselfIsNotStartedForEver) {
  ASSERT_FALSE(reset());
  ASSERT_EQ(download(make_image(5000, 1)), AbortCode::kNone);
  for (std::uint32_t i = 0; i < Handover::kMostStarts; ++i) EXPECT_TRUE(reset()) << i;
  ASSERT_FALSE(reset()) << "the boot loader answers instead";
  ASSERT_EQ(download(make_image(5000, 2)), AbortCode::kNone);
}

TEST_F(Boot, ANodeWithoutIdGetsOneByLss) {
  boot = std::make_unique<BootLoader>(kBootBoard, kBootIdentity, 0, flash, now);
  EXPECT_FALSE(boot->next_frame().has_value());
  LssMaster master;
  const auto finish = [&] {
    while (master.status() == LssMaster::Status::kBusy) {
      now += std::chrono::milliseconds{1};
      while (const auto frame = master.next_frame()) boot->on_frame(now, *frame);
      while (const auto frame = boot->next_frame()) master.on_frame(*frame);
      master.on_time(now);
    }
    return master.status();
  };
  master.select(now, kBootIdentity);
  EXPECT_EQ(finish(), LssMaster::Status::kDone);
  master.configure_node_id(now, 7);
  EXPECT_EQ(finish(), LssMaster::Status::kDone);
  master.switch_all(now, false);
  finish();
  EXPECT_EQ(read(0x1F51, 1), 0u);
}

// A thousand updates, each cut at any byte that is erased or programmed: every time the node answers, with a
// program or with the boot loader, and a further update makes it whole.
TEST_F(Boot, PowerMayGoAtAnyByteOfAnUpdate) {
  const std::array images{make_image(6000, 1), make_image(7004, 2)};
  std::mt19937 random(302);
  int old_kept = 0, answered_by_loader = 0;
  for (std::size_t round = 0; round < 1000; ++round) {
    const std::vector<std::uint8_t>& next = images[round % 2];
    handover.stay = 1;
    ASSERT_FALSE(reset());
    flash.model.cut_after(static_cast<std::int64_t>(random() % (kBootRoom + next.size())));
    try {
      static_cast<void>(control(program_control::kClear));
      static_cast<void>(download(next));
    } catch (const PowerCut&) {
    }
    flash.model.cut_after(-1);
    handover = Handover{.magic = static_cast<std::uint32_t>(random())};
    if (reset()) {
      const bool whole = std::equal(next.begin(), next.end(), flash.bytes().begin());
      const std::vector<std::uint8_t>& before = images[1 - round % 2];
      const bool old = std::equal(before.begin(), before.end(), flash.bytes().begin());
      ASSERT_TRUE(whole || old) << "round " << round << ": started neither the old nor the new program";
      old_kept += old ? 1 : 0;
      handover.stay = 1;
      ASSERT_FALSE(reset());
    } else {
      ++answered_by_loader;
    }
    handover.stay = 0;
    ASSERT_EQ(download(next), AbortCode::kNone) << "round " << round;
    ASSERT_TRUE(reset()) << "round " << round;
  }
  EXPECT_GT(answered_by_loader, 500);
  RecordProperty("old_kept", old_kept);
}

}  // namespace
}  // namespace kinebus
