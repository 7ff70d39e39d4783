#include "tools/flash/program_update.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "node_firmware/boot/tests/boot_bench.hpp"
#include "node_firmware/core/node.hpp"
#include "protocol/canopen/boards/stm32f446_octopus.hpp"

namespace kinebus {
namespace {

constexpr std::size_t kRoom = 16'384;

// A whole node: boot loader or program (the real core), whichever its flash and handover say. A frame takes
// 130 us.
struct Board {
  ModelFlash flash{kRoom, 11};
  ImageTarget takes = kBootBoard;
  Handover handover{.magic = 0};
  std::unique_ptr<BootLoader> boot;
  std::unique_ptr<LoneNode> node;
  LocalTime now{0};
  std::uint32_t downloads = 0;
  std::uint8_t unprotected = 0;
  bool knows_room = true;  ///< else its boot loader is of before 2123h
  std::optional<CanFrame> answer;

  void reset() {
    boot.reset();
    node.reset();
    if (start_program(handover, check_image(flash.bytes(), takes))) {
      const NodeOptions options{
          .identity = {.serial = 9}, .node_id = 3, .program_crc = decode_image_header(flash.bytes()).crc};
      node = std::make_unique<LoneNode>(options, now);
    } else {
      boot = std::make_unique<BootLoader>(takes, kBootIdentity, 3, flash, now);
    }
  }
  void power_cycle() {
    handover.magic = 0;
    reset();
  }
  void on_frame(const CanFrame& frame) {
    if (boot && !knows_room && frame == CanFrame::make(0x603, {0x40, 0x23, 0x21, 0, 0, 0, 0, 0})) {
      answer = sdo::abort_frame(0x583, kProgramRoom, AbortCode::kNoObject);
      return;
    }
    boot ? boot->on_frame(now, frame) : node->on_frame(now, frame);
  }
  std::optional<CanFrame> next_frame() {
    if (answer) return std::exchange(answer, std::nullopt);
    if (boot) {
      boot->on_time(now);
      if (auto frame = boot->next_frame()) return frame;
      if (boot->start_requested()) {
        handover = Handover{};
        reset();
      }
      return std::nullopt;
    }
    node->on_time(now);
    if (auto frame = node->next_frame()) return frame;
    if (node->program_stop_requested()) {
      handover = Handover{.stay = 1, .node_id = 3};
      reset();
    }
    return std::nullopt;
  }
  ProgramUpdate::Status update(std::span<const std::uint8_t> image, std::string* message = nullptr,
                               const std::function<bool(const CanFrame&)>& lose = {}, bool protect = false) {
    ProgramUpdate work(3, image, now, {.answer = std::chrono::seconds{1}, .protect = protect});
    int last_percent = 0;
    while (work.status() == ProgramUpdate::Status::kBusy) {
      now += std::chrono::microseconds{130};
      if (const auto frame = work.next_frame(); frame && !(lose && lose(*frame))) on_frame(*frame);
      if (const auto frame = next_frame(); frame && !(lose && lose(*frame))) work.on_frame(now, *frame);
      work.on_time(now);
      EXPECT_TRUE(work.percent() >= last_percent || work.percent() == 0);
      last_percent = work.percent();
    }
    if (message != nullptr) *message = work.message();
    unprotected = work.unprotected();
    return work.status();
  }
};
using Status = ProgramUpdate::Status;

TEST(ProgramUpdate, BlankBoardThenUpdateThenNothingToDo) {
  Board board;
  board.reset();
  const auto first = make_image(9000, 1), second = make_image(12'004, 2);
  std::string message;
  EXPECT_EQ(board.update(first, &message), Status::kDone) << message;
  ASSERT_TRUE(board.node);
  EXPECT_EQ(board.update(second, &message), Status::kDone) << message;
  ASSERT_TRUE(board.node);
  EXPECT_TRUE(std::equal(second.begin(), second.end(), board.flash.bytes().begin()));
  const int erasures = board.flash.erasures;
  EXPECT_EQ(board.update(second, &message), Status::kDone);
  EXPECT_EQ(message, "runs this program already");
  EXPECT_EQ(board.flash.erasures, erasures);
}

TEST(ProgramUpdate, TheChipIsProtectedWhenAskedWithANewProgramOrWithoutOne) {
  Board board;
  board.reset();
  const auto image = make_image(9000, 1);
  std::string message;
  EXPECT_EQ(board.update(image, &message), Status::kDone);
  EXPECT_EQ(board.unprotected, 3) << "told";
  EXPECT_EQ(board.flash.missing, 3) << "and not set";
  const int erasures = board.flash.erasures;
  EXPECT_EQ(board.update(image, &message, {}, true), Status::kDone) << message;
  EXPECT_EQ(message, "protected");
  EXPECT_EQ(board.flash.missing, 0);
  EXPECT_EQ(board.flash.erasures, erasures) << "the program stays";
  ASSERT_TRUE(board.node) << "and runs";
  board.flash.missing = ProgramFlash::kNoBrownOut;
  EXPECT_EQ(board.update(make_image(9000, 2), &message, {}, true), Status::kDone) << message;
  EXPECT_EQ(message, "updated");
  EXPECT_EQ(board.flash.missing, 0);
  board.flash.missing = ProgramFlash::kNoBrownOut;
  board.flash.locks = false;
  EXPECT_EQ(board.update(make_image(9000, 3), &message, {}, true), Status::kFailed);
  EXPECT_EQ(message.rfind("protecting: ", 0), 0u) << message;
}

TEST(ProgramUpdate, WrongFilesAndPoweredDrivesAreRefusedWithTheReason) {
  Board board;
  board.reset();
  std::string message;
  EXPECT_EQ(board.update(std::vector<std::uint8_t>(3000, 1), &message), Status::kFailed);
  EXPECT_EQ(message, "the file is no node image: give kinebus-node.bin");
  auto damaged = make_image(9000, 1);
  damaged[5000] ^= 1;
  EXPECT_EQ(board.update(damaged, &message), Status::kFailed);
  EXPECT_EQ(message, "the image's CRC is wrong: the file is damaged");
  ASSERT_EQ(board.update(make_image(9000, 1)), Status::kDone);
  for (const std::uint8_t word : std::array<std::uint8_t, 2>{0x06, 0x07}) {
    board.on_frame(CanFrame::make(0x603, {0x2B, 0x40, 0x60, 0, word, 0, 0, 0}));
    while (board.next_frame()) {
    }
  }
  ASSERT_TRUE(board.node->drive(0).power);
  EXPECT_EQ(board.update(make_image(9000, 2), &message), Status::kFailed);
  EXPECT_TRUE(board.node) << "the program goes on";
}

TEST(ProgramUpdate, WhatDoesNotFitIsRefusedBeforeAnythingIsErased) {
  Board board;
  board.reset();
  std::string message;
  ASSERT_EQ(board.update(make_image(9000, 1)), Status::kDone);
  const int erasures = board.flash.erasures;
  EXPECT_EQ(board.update(make_image(kRoom + 4, 2), &message), Status::kFailed);
  EXPECT_EQ(message.rfind("its boot loader has room for programs of 16384 bytes and this one has 16388: ", 0),
            0u)
      << message;
  board.knows_room = false;
  EXPECT_EQ(board.update(make_image(140'000, 2), &message), Status::kFailed);
  EXPECT_EQ(message.rfind("its boot loader has room for programs of 131072 bytes", 0), 0u) << message;
  EXPECT_EQ(board.flash.erasures, erasures);
  EXPECT_TRUE(board.node) << "the program goes on";
  EXPECT_EQ(board.update(make_image(12'000, 3), &message), Status::kDone)
      << message << " (an old boot loader takes what it has room for)";
}

// The loader looks for itself: same product, but another chip or pin map.
TEST(ProgramUpdate, ABootLoaderThatRefusesAnImageIsQuotedInWords) {
  Board board;
  board.takes = image_target(Stm32f446OctopusBoard::kFacts);
  board.takes.product_code = kBootBoard.product_code;
  board.reset();
  std::string message;
  EXPECT_EQ(board.update(make_image(9000, 2), &message), Status::kFailed);
  EXPECT_EQ(message, "its boot loader refuses the image: it is for another board or chip");
}

TEST(ProgramUpdate, LostFramesAreRepeated) {
  Board board;
  board.reset();
  int frames = 0;
  std::string message;
  const auto lose = [&](const CanFrame&) { return ++frames % 701 == 700; };
  EXPECT_EQ(board.update(make_image(12'000, 1), &message, lose), Status::kDone) << message;
}

TEST(ProgramUpdate, ATransferThatAToolLeftOpenIsEndedFirst) {
  Board board;
  board.reset();
  const auto image = make_image(12'000, 1);
  ProgramUpdate dies(3, image, board.now, {.answer = std::chrono::seconds{1}});
  while (dies.percent() < 50) {
    board.now += std::chrono::microseconds{130};
    if (const auto frame = dies.next_frame()) board.on_frame(*frame);
    if (const auto frame = board.next_frame()) dies.on_frame(board.now, *frame);
    dies.on_time(board.now);
    ASSERT_EQ(dies.status(), Status::kBusy);
  }
  const LocalTime began = board.now;
  std::string message;
  EXPECT_EQ(board.update(image, &message), Status::kDone) << message;
  EXPECT_LT(board.now - began, std::chrono::seconds{1}) << "without waiting for anybody's timeout";
}

TEST(ProgramUpdate, ACutIsRepairedByRunningItAgain) {
  std::mt19937 random(77);
  Board board;
  board.reset();
  ASSERT_EQ(board.update(make_image(9000, 1)), Status::kDone);
  for (std::uint8_t round = 0; round < 30; ++round) {
    const auto image = make_image(9000, static_cast<std::uint8_t>(round + 2));
    board.flash.model.cut_after(static_cast<std::int64_t>(random() % (kRoom + 9000)));
    try {
      static_cast<void>(board.update(image));
    } catch (const PowerCut&) {
    }
    board.flash.model.cut_after(-1);
    board.power_cycle();
    std::string message;
    ASSERT_EQ(board.update(image, &message), Status::kDone) << "round " << int{round} << ": " << message;
    ASSERT_TRUE(board.node);
  }
}

}  // namespace
}  // namespace kinebus
