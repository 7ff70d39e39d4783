// The EBB behind its boot loader: by DFU from a blank chip, updates over CAN, power that goes at any moment,
// and what is for another board.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>

#include "node_firmware/boot/handover.hpp"
#include "node_firmware/port/stm32g0b1_ebb/board.hpp"
#include "protocol/canopen/boards/heat.hpp"
#include "protocol/canopen/boards/stm32f446_octopus.hpp"
#include "protocol/canopen/boards/stm32g0b1_ebb.hpp"
#include "vcan_tests/emulator/ebb_board.hpp"
#include "vcan_tests/emulator/tests/update_bench.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

constexpr std::uint8_t kEbbId = 9;

std::string beside_the_ebb_image(const std::string& name) {
  const std::string image = KINEBUS_EBB_IMAGE;
  return image.substr(0, image.rfind('/') + 1) + name;
}
/// What a chip holds whose flash was blank, when this file has been written to its start.
ElfImage flashed_ebb(const std::string& name) {
  std::ifstream in(beside_the_ebb_image(name), std::ios::binary);
  ElfImage image;
  image.pieces.push_back({CortexM4::kFlash, {std::istreambuf_iterator<char>(in), {}}});
  return image;
}
/// Sealed anew, for this board.
std::vector<std::uint8_t> sealed_for(std::vector<std::uint8_t> image, const BoardFacts& board) {
  ImageHeader header = decode_image_header(image);
  const ImageTarget target = image_target(board);
  header.product_code = target.product_code;
  header.hardware = target.hardware;
  encode_image_header(header, image);
  header.crc = image_crc(image);
  encode_image_header(header, image);
  return image;
}

struct EbbUpdate : UpdateBench {
  explicit EbbUpdate(ElfImage flash = with_boot_loader(KINEBUS_EBB_IMAGE, "kinebus-ebb-g0b1-boot.elf"),
                     BoardMaker make = &make_board<EbbBoard>, bool keeps_id = true)
      : UpdateBench(std::move(flash), {{.board = {.unique_id = {9, 8, 7}},
                                        .node_id = kEbbId,
                                        .keeps_node_id = keeps_id,
                                        .make = make}}) {}
  EbbBoard& board() { return machine.board<EbbBoard>(0); }
  std::vector<std::uint8_t> program() {
    return program_at(board(), ebb::kProgramPages.address(), ebb::kProgramPages.bytes());
  }
  std::optional<std::uint32_t> read(ObjectAddress address) {
    machine.send(now, sdo::frame_of(cob_id::kSdoRequest + kEbbId, 0x40, address));
    std::optional<std::uint32_t> value;
    for (const BusTime end = now + 50ms; now < end && !value;)
      pass([&](const CanFrame& frame) {
        if (frame.id == cob_id::kSdoReply + kEbbId && sdo::address_in(frame) == address &&
            sdo::specifier(frame) == sdo::kReplyInitiateUpload)
          value = get_u32_le(frame.bytes().subspan(4));
      });
    return value;
  }
  bool change_kind(std::span<const std::uint8_t> bytes) {
    return update(0, kEbbId, bytes, {.other_kind = true}, [](const ProgramUpdate&) { return false; });
  }
  void expect_runs(const BoardFacts& node = Stm32g0b1EbbBoard::kFacts) {
    wait(board().boot_time() + 300ms);
    EXPECT_EQ(read({0x1018, 2}), node.product_code);
    EXPECT_EQ(read({0x1F56, 1}), decode_image_header(program()).crc);
    EXPECT_EQ(board().watchdog_resets(), 0u);
    EXPECT_TRUE(board().strange_accesses().empty());
    EXPECT_TRUE(board().lost_accesses().empty());
  }
};

TEST(EbbUpdateTest, ABlankChipRunsByDfuAndTakesUpdatesOverCan) {
  EbbUpdate ebb(flashed_ebb("kinebus-ebb-g0b1-dfu.bin"));
  ebb.expect_runs();
  const auto next = another(ebb.program());
  EXPECT_TRUE(ebb.update(0, kEbbId, next)) << ebb.message;
  EXPECT_EQ(ebb.program(), next);
  ebb.expect_runs();
  const std::uint64_t erases = ebb.board().flash().erases();
  EXPECT_TRUE(ebb.update(0, kEbbId, next));
  EXPECT_EQ(ebb.message, "runs this program already");
  EXPECT_EQ(ebb.board().flash().erases(), erases);
  // An odd number of words: the flash takes two at once.
  auto longer = next;
  longer.insert(longer.end(), {1, 2, 3, 4});
  if (longer.size() % 8 == 0) longer.insert(longer.end(), {5, 6, 7, 8});
  ImageHeader header = decode_image_header(longer);
  header.length = static_cast<std::uint32_t>(longer.size());
  encode_image_header(header, longer);
  EXPECT_TRUE(ebb.update(0, kEbbId, sealed_for(longer, Stm32g0b1EbbBoard::kFacts))) << ebb.message;
  ebb.expect_runs();
}

TEST(EbbUpdateTest, PowerThatGoesAtAnyMomentLeavesABoardThatCanBeUpdated) {
  EbbUpdate ebb;
  constexpr std::uint32_t kSeed = 71;
  std::mt19937 random(kSeed);
  const auto original = ebb.program();
  // 50 pages are erased in 2 s, and some 90 KiB written in 5 s more: until the new program runs.
  for (std::uint32_t round = 0; round < 6; ++round) {
    const auto next = another(original, 100 + round);
    const BusTime cut = ebb.now + std::chrono::milliseconds{random() % 8'000};
    ebb.update(0, kEbbId, next, {.attempts = 1}, [&](const ProgramUpdate&) { return ebb.now >= cut; });
    EXPECT_FALSE(ebb.board().anything_on());
    EXPECT_TRUE(ebb.update(0, kEbbId, next))
        << "seed " << kSeed << ", round " << round << ": " << ebb.message;
    EXPECT_EQ(ebb.program(), next);
  }
  ebb.expect_runs();
}

TEST(EbbUpdateTest, AnImageForAnotherBoardIsRefusedAndTheProgramRunsOn) {
  EbbUpdate ebb;
  const auto before = ebb.program();
  EXPECT_FALSE(ebb.update(0, kEbbId, sealed_for(before, Stm32f446OctopusBoard::kFacts)));
  EXPECT_NE(ebb.message.find("Kinebus extruder axis on an EBB"), std::string::npos) << ebb.message;
  EXPECT_EQ(ebb.program(), before);
  ebb.expect_runs();
}

// The same board as a heat node: who says no more than "all" gets no other kind of node by that.
TEST(EbbUpdateTest, BecomesAHeatNodeAndAnAxisAgainOnlyWhenThatIsAskedFor) {
  EbbUpdate ebb;
  const auto axis = ebb.program();
  const auto heat = EbbUpdate(with_boot_loader(KINEBUS_EBB_HEAT_IMAGE, "kinebus-ebb-g0b1-boot.elf"),
                              &make_board<EbbHeatBoard>)
                        .program();
  EXPECT_FALSE(ebb.update(0, kEbbId, heat));
  EXPECT_NE(ebb.message.find("the image is for a Kinebus heat node"), std::string::npos) << ebb.message;
  EXPECT_EQ(ebb.program(), axis);
  EXPECT_TRUE(ebb.change_kind(heat)) << ebb.message;
  ebb.expect_runs(HeatBoard::kFacts);
  EXPECT_TRUE(ebb.update(0, kEbbId, another(heat))) << ebb.message;
  EXPECT_EQ(ebb.program(), another(heat));
  ebb.expect_runs(HeatBoard::kFacts);
  EXPECT_FALSE(ebb.update(0, kEbbId, axis));
  EXPECT_NE(ebb.message.find("it is a Kinebus heat node"), std::string::npos) << ebb.message;
  // A heat node's program for another board, which only the boot loader can tell.
  EXPECT_FALSE(ebb.update(0, kEbbId, sealed_for(heat, Stm32f446OctopusBoard::kFacts)));
  EXPECT_NE(ebb.message.find("Kinebus extruder axis on an EBB"), std::string::npos) << ebb.message;
  EXPECT_EQ(ebb.program(), another(heat));
  ebb.expect_runs(HeatBoard::kFacts);
  EXPECT_TRUE(ebb.change_kind(axis)) << ebb.message;
  ebb.expect_runs();
}

// The loader of the G0B1 on another chip: it speaks, and drives nothing.
TEST(EbbUpdateTest, OnAnotherChipNothingButTheBusIsTouched) {
  EbbUpdate ebb(
      load_elf(beside_the_ebb_image("kinebus-ebb-g0b1-boot.elf")),
      [](const ElfImage& image, const BoardOptions& options) -> std::unique_ptr<Chip> {
        return std::make_unique<EbbBoard>(image, options, EbbBoard::kG071);
      },
      false);
  EXPECT_EQ(ebb.read({0x1018, 2}), Stm32g0b1EbbBoard::kFacts.product_code);
  EXPECT_EQ(ebb.board().outputs(), 0);
}

TEST(EbbUpdateTest, AProgramThatKeepsFailingIsNotStartedForEver) {
  EbbUpdate ebb;
  // As sealed, but it begins where its own hard fault leads: each start ends in a reset.
  const auto good = ebb.program();
  auto broken = good;
  std::copy_n(good.begin() + 12, 4, broken.begin() + 4);
  EXPECT_TRUE(ebb.update(0, kEbbId, another(broken))) << "it is whole, and its CRC is right";
  ebb.wait(3s);
  EXPECT_EQ(ebb.read({0x1F51, 1}), 0u) << "the boot loader waits";
  EXPECT_FALSE(ebb.board().anything_on());
  EXPECT_TRUE(ebb.update(0, kEbbId, good)) << ebb.message;
  ebb.wait(ebb.board().boot_time() + 300ms);
  EXPECT_EQ(ebb.read({0x1F51, 1}), 1u) << "a good one runs";
  EXPECT_EQ(ebb.read({0x1F56, 1}), decode_image_header(good).crc);
}

}  // namespace
}  // namespace kinebus::emulator
