// The Octopus behind its boot loader: five nodes, one program, one update. By the SD card and by DFU from a
// blank chip; power that goes at any moment; what is for another board.

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <random>

#include "node_firmware/boot/board_record.hpp"
#include "node_firmware/boot/handover.hpp"
#include "node_firmware/port/stm32f446_octopus/board.hpp"
#include "protocol/canopen/boards/heat.hpp"
#include "protocol/canopen/boards/stm32f405.hpp"
#include "protocol/canopen/boards/stm32f446_octopus.hpp"
#include "protocol/canopen/heartbeat.hpp"
#include "vcan_tests/emulator/octopus_board.hpp"
#include "vcan_tests/emulator/tests/update_bench.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

constexpr std::uint8_t kId = 7;
constexpr std::uint32_t kDeviceF429 = 0x1000'0419;

std::string beside_the_image(const std::string& name) {
  const std::string image = KINEBUS_OCTOPUS_IMAGE;
  return image.substr(0, image.rfind('/') + 1) + name;
}
std::vector<std::uint8_t> file(const std::string& name) {
  std::ifstream in(beside_the_image(name), std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
/// What a chip holds whose flash was blank, when this file has been written to an address.
ElfImage flashed(const std::string& name, std::uint32_t address) {
  ElfImage image;
  image.pieces.push_back({address, file(name)});
  return image;
}

struct OctopusUpdate : UpdateBench {
  explicit OctopusUpdate(ElfImage flash = with_boot_loader(KINEBUS_OCTOPUS_IMAGE,
                                                           "kinebus-octopus-f446-boot.elf"),
                         BoardMaker make = &make_board<OctopusBoard>, bool keeps_id = true)
      : UpdateBench(
            std::move(flash),
            {{.board = {.unique_id = {7, 8, 9}}, .node_id = kId, .keeps_node_id = keeps_id, .make = make}}) {}
  OctopusBoard& board() { return machine.board<OctopusBoard>(0); }
  std::vector<std::uint8_t> program() {
    return program_at(board(), octopus::kProgramAddress, octopus::kProgramBytes);
  }
  std::optional<std::uint32_t> read(std::uint8_t id, ObjectAddress address) {
    machine.send(now, sdo::frame_of(cob_id::kSdoRequest + id, 0x40, address));
    std::optional<std::uint32_t> value;
    for (const BusTime end = now + 50ms; now < end && !value;)
      pass([&](const CanFrame& frame) {
        if (frame.id == cob_id::kSdoReply + id && sdo::address_in(frame) == address &&
            sdo::specifier(frame) == sdo::kReplyInitiateUpload)
          value = get_u32_le(frame.bytes().subspan(4));
      });
    return value;
  }
  /// All five nodes are there, with what they are.
  void expect_all_run() {
    wait(board().boot_time() + 300ms);
    for (std::uint8_t n = 0; n < 4; ++n)
      EXPECT_EQ(read(kId + n, {0x1018, 2}), Stm32f446OctopusBoard::kFacts.product_code) << int{n};
    EXPECT_EQ(read(kId + 4, {0x1018, 2}), HeatBoard::kFacts.product_code);
    EXPECT_EQ(read(kId, {0x1F56, 1}), decode_image_header(program()).crc);
    EXPECT_EQ(board().watchdog_resets(), 0u);
    EXPECT_TRUE(board().strange_accesses().empty());
    EXPECT_TRUE(board().lost_accesses().empty());
  }
};

// What the maker's loader takes from the card lies behind it; what DFU writes at the start of flash needs no
// other loader.
TEST(OctopusUpdateTest, ABlankChipRunsByTheSdCardOrByDfuAndTakesUpdatesOverCan) {
  struct Way {
    const char* name;
    std::uint32_t address;
  };
  for (const Way& way : {Way{"kinebus-octopus-f446-sd.bin", octopus::kBootAddress},
                         Way{"kinebus-octopus-f446-dfu.bin", CortexM4::kFlash}}) {
    SCOPED_TRACE(way.name);
    OctopusUpdate octopus(flashed(way.name, way.address));
    EXPECT_EQ(octopus.program(), file("kinebus-octopus-f446.bin"));
    octopus.expect_all_run();
    const auto next = another(octopus.program());
    EXPECT_TRUE(octopus.update(0, kId, next)) << octopus.message;
    EXPECT_EQ(octopus.program(), next);
    octopus.expect_all_run();
    const std::uint64_t erases = octopus.board().flash().erases();
    EXPECT_TRUE(octopus.update(0, kId, next));
    EXPECT_EQ(octopus.message, "runs this program already");
    EXPECT_EQ(octopus.board().flash().erases(), erases);
  }
}

TEST(OctopusUpdateTest, PowerThatGoesAtAnyMomentLeavesABoardThatCanBeUpdated) {
  OctopusUpdate octopus;
  std::mt19937 random(446);
  const auto original = octopus.program();
  // Two sectors are erased in 4 s, and some 160 KiB written in 6 s more: 12 s until the new program runs.
  for (std::uint32_t round = 0; round < 20; ++round) {
    const auto next = another(original, 100 + round);
    const BusTime cut = octopus.now + std::chrono::milliseconds{random() % 12'000};
    octopus.update(0, kId, next, {.attempts = 1}, [&](const ProgramUpdate&) { return octopus.now >= cut; });
    EXPECT_FALSE(octopus.board().anything_on());
    EXPECT_TRUE(octopus.update(0, kId, next)) << "round " << round << ": " << octopus.message;
    EXPECT_EQ(octopus.program(), next);
  }
  octopus.expect_all_run();
}

// The whole image, but sealed for another board: nothing is erased for it, whoever asks.
TEST(OctopusUpdateTest, AnImageForAnotherBoardIsRefusedByToolAndLoaderAndTheProgramRunsOn) {
  OctopusUpdate octopus;
  const auto before = octopus.program();
  auto foreign = before;
  ImageHeader header = decode_image_header(foreign);
  const ImageTarget target = image_target(Stm32f405Board::kFacts);
  header.product_code = target.product_code;
  header.hardware = target.hardware;
  encode_image_header(header, foreign);
  header.crc = image_crc(foreign);
  encode_image_header(header, foreign);
  EXPECT_FALSE(octopus.update(0, kId, foreign));
  EXPECT_NE(octopus.message.find("Kinebus two-axis node on an Octopus"), std::string::npos)
      << octopus.message;
  EXPECT_EQ(octopus.program(), before);
  octopus.expect_all_run();
}

// The record is in memory that nothing erases: whatever is written to the board later finds it.
TEST(OctopusUpdateTest, ABoardThatIsRecordedAsAnotherIsNotDriven) {
  OctopusUpdate octopus;
  const auto program = octopus.program();
  EXPECT_GT(octopus.board().outputs(), 0);
  const auto none = [](const ProgramUpdate&) { return false; };
  EXPECT_TRUE(octopus.update(0, kId, program, {.record_revision = 11}, none)) << octopus.message;
  EXPECT_EQ(octopus.message, "recorded");
  octopus.expect_all_run();
  const auto memory = octopus.board().cpu().system_memory().first(CortexM4::kOneTimeMemorySize);
  const auto own = board_record::find(memory);
  ASSERT_TRUE(own);
  EXPECT_EQ(own->hardware, Stm32f446OctopusBoard::kFacts.hardware);
  EXPECT_EQ(own->revision, 11u);
  EXPECT_EQ(own->serial, octopus.read(kId, {0x1018, 4}));
  EXPECT_EQ(board_record::free_slot(memory), BoardRecord::kSlot) << "one slot is taken";
  EXPECT_TRUE(octopus.update(0, kId, program, {.record_revision = 11}, none));
  EXPECT_EQ(board_record::free_slot(memory), BoardRecord::kSlot) << "it says so already";

  // Another board with the same chip, recorded by its own loader; this one's loader and program came by DFU.
  const auto words = board_record::encode({Stm32f405Board::kFacts.hardware, 10, 1});
  for (std::size_t i = 0; i < words.size(); ++i)
    put_u32_le(memory.subspan(BoardRecord::kSlot + 4 * i), words[i]);
  octopus.machine.power_cycle(0);
  octopus.wait(300ms);
  EXPECT_EQ(octopus.read(kId, {0x1018, 2}), Stm32f446OctopusBoard::kFacts.product_code) << "it speaks";
  EXPECT_EQ(octopus.board().outputs(), 0) << "and drives nothing";
  EXPECT_FALSE(octopus.update(0, kId, another(program)));
  EXPECT_NE(octopus.message.find("recorded as STM32F405, and the image is for Octopus STM32F446"),
            std::string::npos)
      << octopus.message;
  EXPECT_EQ(octopus.program(), program) << "nothing was written";
  octopus.wait(300ms);
  EXPECT_EQ(octopus.read(kId, {0x1F51, 1}), 1u) << "the program that was there goes on";
  EXPECT_EQ(octopus.board().outputs(), 0);
}

// The loader of the F446 on another chip: it speaks, and drives nothing.
TEST(OctopusUpdateTest, OnAnotherChipNothingButTheBusIsTouched) {
  ElfImage loader = load_elf(beside_the_image("kinebus-octopus-f446-boot.elf"));
  const BoardMaker on_another_chip = [](const ElfImage& image, const BoardOptions& options) {
    return std::unique_ptr<Chip>(std::make_unique<OctopusBoard>(image, options, kDeviceF429));
  };
  OctopusUpdate octopus(std::move(loader), on_another_chip, false);
  EXPECT_EQ(octopus.read(kId, {0x1018, 2}), Stm32f446OctopusBoard::kFacts.product_code);
  EXPECT_EQ(octopus.board().outputs(), 0);
}

// The maker's loader runs first after each reset and takes the RAM: what is to be known then is in the backup
// registers. A crystal that stops ends the program.
TEST(OctopusUpdateTest, AProgramThatKeepsFailingIsNotStartedForEver) {
  OctopusUpdate octopus;
  for (std::uint32_t start = 1; start <= Handover::kMostStarts; ++start) {
    octopus.wait(octopus.board().boot_time() + 50ms);
    ASSERT_EQ(octopus.read(kId, {0x1F51, 1}), 1u) << "start " << start << ": the program runs";
    octopus.board().set_crystal(false);
    octopus.wait(1ms);
    octopus.board().set_crystal(true);
    octopus.wait(20ms);
  }
  octopus.wait(300ms);
  EXPECT_EQ(octopus.read(kId, {0x1F51, 1}), 0u) << "the boot loader waits";
  EXPECT_FALSE(octopus.board().anything_on());
  EXPECT_TRUE(octopus.update(0, kId, another(octopus.program())));
  octopus.expect_all_run();
}

}  // namespace
}  // namespace kinebus::emulator
