// Three emulated boards get a new program over the modelled bus, while a fourth device talks.

#include <gtest/gtest.h>

#include <algorithm>

#include "node_firmware/boot/boot_loader.hpp"
#include "node_firmware/port/stm32f405/board.hpp"
#include "vcan_tests/emulator/tests/update_bench.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

std::vector<std::uint8_t> program_in(Board& board) {
  return program_at(board, board::kProgramAddress, board::kProgramBytes);
}

struct EmulatedUpdate : testing::Test, UpdateBench {
  EmulatedUpdate() : UpdateBench(with_boot_loader(KINEBUS_FIRMWARE_IMAGE, "kinebus-boot.elf"), nodes()) {}

  static std::vector<EmulatedNodeOptions> nodes() {
    std::vector<EmulatedNodeOptions> options;
    for (std::uint8_t id = 1; id <= 3; ++id)
      options.push_back({.board = {.unique_id = {id, 2, 3}}, .node_id = id});
    return options;
  }
  bool update(std::uint8_t node, std::span<const std::uint8_t> bytes, bool protect = false) {
    return UpdateBench::update(node - 1, node, bytes, protect);
  }
  bool cut_update(std::uint8_t node, std::span<const std::uint8_t> bytes, int percent) {
    return UpdateBench::cut_update(node - 1, node, bytes, percent);
  }
  void keep_id(std::uint8_t id) {
    UpdateBench::keep_id({kVendorId, kProductCode, kRevisionNumber, serial(id)});
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
  const std::vector<std::uint8_t> next = another(program_in(machine.board(0)));

  keep_id(2);
  EXPECT_TRUE(update(1, next));
  EXPECT_FALSE(cut_update(2, next, 40)) << "its power went";
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
  EXPECT_FALSE(cut_update(1, padded_to(150'004), 95)) << "its power went in the second sector";
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
  EXPECT_TRUE(update(1, program, true));
  EXPECT_EQ(board.flash().options(), kAfter) << "brown-out level 3, sectors 0 and 1, and nothing else";
  keep_id(1);
  machine.power_cycle(0);
  wait(100ms);
  EXPECT_EQ(board.flash().options(), kAfter);
  const std::uint64_t erases = board.flash().erases();
  EXPECT_TRUE(update(1, program, true)) << "again: nothing to do";
  EXPECT_EQ(board.flash().erases(), erases);
  EXPECT_EQ(machine.board(1).flash().options(), kBefore) << "who was not asked";
  EXPECT_EQ(board.watchdog_resets(), 0u);
}

}  // namespace
}  // namespace kinebus::emulator
