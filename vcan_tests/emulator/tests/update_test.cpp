// Three emulated boards with boot loader and program get a new program over the modelled bus, while a fourth
// device talks.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "node_firmware/boot/boot_loader.hpp"
#include "node_firmware/boot/image_header.hpp"
#include "node_firmware/port/stm32f405/board.hpp"
#include "protocol/canopen/lss.hpp"
#include "protocol/canopen/object_addresses.hpp"
#include "tools/flash/program_update.hpp"
#include "vcan_tests/emulator/emulated_machine.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

/// Boot loader and program, as they lie in flash.
ElfImage both() {
  ElfImage program = load_elf(KINEBUS_FIRMWARE_IMAGE);
  const std::string path = KINEBUS_FIRMWARE_IMAGE;
  const ElfImage boot = load_elf(path.substr(0, path.rfind('/')) + "/kinebus-boot.elf");
  program.pieces.insert(program.pieces.end(), boot.pieces.begin(), boot.pieces.end());
  return program;
}

std::vector<std::uint8_t> program_in(Board& board) {
  const auto room =
      board.cpu().flash().subspan(board::kProgramAddress - board::kBootAddress, board::kProgramBytes);
  const std::size_t length = decode_image_header(room).length;
  return {room.begin(), room.begin() + static_cast<std::ptrdiff_t>(length)};
}

struct EmulatedUpdate : testing::Test {
  ElfImage image = both();
  EmulatedMachine machine{image, nodes(), 3};
  BusTime now{0};
  std::uint32_t spoken = 0;

  static std::vector<EmulatedNodeOptions> nodes() {
    std::vector<EmulatedNodeOptions> options;
    for (std::uint8_t id = 1; id <= 3; ++id)
      options.push_back({.board = {.unique_id = {id, 2, 3}}, .node_id = id});
    return options;
  }
  template <typename OnFrame>
  void pass(OnFrame on_frame) {
    // The fourth device: 200 frames a second, urgent ones too.
    if (now.count() / 5'000'000 > spoken && machine.can_send())
      machine.send(now, CanFrame::make(0x0C0 + (++spoken % 2) * 0x300, {1, 2, 3, 0, 5, 6, 7, 8}));
    now += 200us;
    for (bool done = false; !done;) {
      done = machine.advance(now);
      while (const auto got = machine.receive())
        if (!got->own) on_frame(got->frame);
    }
  }
  /// False: it failed. `cut_at`: at so many percent the node's power goes.
  bool update(std::uint8_t node, std::span<const std::uint8_t> bytes, int cut_at = 101,
              bool protect = false) {
    ProgramUpdate work(node, bytes, now,
                       {.answer = 6s, .attempts = cut_at > 100 ? 3 : 1, .protect = protect});
    std::optional<CanFrame> unsent;
    while (work.status() == ProgramUpdate::Status::kBusy) {
      while (machine.can_send() && (unsent || (unsent = work.next_frame()))) {
        machine.send(now, *unsent);
        unsent.reset();
      }
      pass([&](const CanFrame& frame) { work.on_frame(now, frame); });
      work.on_time(now);
      if (work.percent() >= cut_at && work.percent() < 100) {
        machine.board(node - 1).power_cycle();
        cut_at = 101;
      }
    }
    fmt::print("node {}: {} at {} s\n", node, work.message(), to_seconds(now));
    return work.status() == ProgramUpdate::Status::kDone;
  }
  /// The node keeps its id through power-off.
  void keep_id(std::uint8_t id) {
    LssMaster master;
    const auto finish = [&] {
      while (master.status() == LssMaster::Status::kBusy) {
        while (machine.can_send()) {
          const auto frame = master.next_frame();
          if (!frame) break;
          machine.send(now, *frame);
        }
        pass([&](const CanFrame& frame) { master.on_frame(frame); });
        master.on_time(now);
      }
      EXPECT_EQ(master.status(), LssMaster::Status::kDone);
    };
    master.select(now, {kVendorId, kProductCode, kRevisionNumber, serial(id)});
    finish();
    master.store(now);
    finish();
    master.switch_all(now, false);
    finish();
  }
  static std::uint32_t serial(std::uint8_t id) {
    Crc32 crc;
    for (const std::uint32_t word : {std::uint32_t{id}, 2u, 3u}) {
      std::array<std::uint8_t, 4> bytes{};
      put_u32_le(bytes, word);
      crc.add(bytes);
    }
    return crc.value();
  }
};

TEST_F(EmulatedUpdate, AllNodesGetTheNewProgramAndACutIsRepairedByRunningItAgain) {
  std::vector<std::uint8_t> next = program_in(machine.board(0));
  ImageHeader header = decode_image_header(next);
  header.reserved = 0x0000'0002;  // another image that does the same
  encode_image_header(header, next);
  header.crc = image_crc(next);
  encode_image_header(header, next);

  keep_id(2);
  EXPECT_TRUE(update(1, next));
  EXPECT_FALSE(update(2, next, 40)) << "its power went";
  EXPECT_TRUE(update(2, next)) << "run again";
  EXPECT_TRUE(update(3, next));
  for (int node = 0; node < 3; ++node) {
    EXPECT_EQ(program_in(machine.board(node)), next) << node + 1;
    EXPECT_EQ(machine.board(node).watchdog_resets(), 0u);
    EXPECT_TRUE(machine.board(node).strange_accesses().empty());
  }
}

// Both of the program's sectors hold something, as after a larger program: each takes 2 s to erase.
TEST_F(EmulatedUpdate, AProgramOfTwoSectorsGoesInIsCutOffAndGoesInAgain) {
  Board& board = machine.board(0);
  const std::vector<std::uint8_t> small = program_in(board);
  const auto padded_to = [&](std::size_t bytes) {
    std::vector<std::uint8_t> padded = small;
    for (std::size_t i = padded.size(); i < bytes; ++i)
      padded.push_back(static_cast<std::uint8_t>(i * i / 7));
    ImageHeader header = decode_image_header(padded);
    header.length = static_cast<std::uint32_t>(bytes);
    encode_image_header(header, padded);
    header.crc = image_crc(padded);
    encode_image_header(header, padded);
    return padded;
  };
  keep_id(1);
  const std::vector<std::uint8_t> large = padded_to(150'000);
  ASSERT_GT(large.size(), kFirstProgramRoom);
  const std::uint64_t erases = board.flash().erases();
  EXPECT_TRUE(update(1, large));
  EXPECT_EQ(board.flash().erases() - erases, 2u) << "once each, also what reads as blank";
  EXPECT_EQ(program_in(board), large);
  EXPECT_FALSE(update(1, padded_to(150'004), 95)) << "its power went in the second sector";
  EXPECT_TRUE(update(1, large));
  EXPECT_EQ(program_in(board), large);
  EXPECT_FALSE(update(1, padded_to(board::kProgramBytes + 4))) << "more than there is room for";
  EXPECT_EQ(program_in(board), large) << "and nothing was erased";
  EXPECT_TRUE(update(1, small));
  const auto flash =
      board.cpu().flash().subspan(board::kProgramAddress - board::kBootAddress, board::kProgramBytes);
  EXPECT_TRUE(std::ranges::all_of(flash.subspan(small.size()), [](auto byte) { return byte == 0xFF; }))
      << "nothing is left of the larger one";
  EXPECT_EQ(board.watchdog_resets(), 0u);
  EXPECT_TRUE(board.strange_accesses().empty());
}

TEST_F(EmulatedUpdate, TheChipIsProtectedAndTakesProgramsAllTheSame) {
  Board& board = machine.board(0);
  const std::vector<std::uint8_t> program = program_in(board);
  constexpr std::uint32_t kBefore = 0x0FFFAAEC, kAfter = 0x0FFCAAE0;
  ASSERT_EQ(board.flash().options(), kBefore);
  EXPECT_TRUE(update(1, program, 101, true));
  EXPECT_EQ(board.flash().options(), kAfter) << "brown-out level 3, sectors 0 and 1, and nothing else";
  keep_id(1);
  machine.power_cycle(0);
  for (const BusTime end = now + 100ms; now < end;) pass([](const CanFrame&) {});
  EXPECT_EQ(board.flash().options(), kAfter);
  const std::uint64_t erases = board.flash().erases();
  EXPECT_TRUE(update(1, program, 101, true)) << "again: nothing to do";
  EXPECT_EQ(board.flash().erases(), erases);
  EXPECT_EQ(machine.board(1).flash().options(), kBefore) << "who was not asked";
  EXPECT_EQ(board.watchdog_resets(), 0u);
}

}  // namespace
}  // namespace kinebus::emulator
