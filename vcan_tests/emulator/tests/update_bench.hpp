#pragma once
// Emulated boards with boot loader and program that get a new program over the modelled bus by what
// kinebus-flash does, while another device talks.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "node_firmware/boot/image_header.hpp"
#include "protocol/canopen/lss.hpp"
#include "protocol/canopen/object_addresses.hpp"
#include "tools/flash/program_update.hpp"
#include "vcan_tests/emulator/emulated_machine.hpp"

namespace kinebus::emulator {

/// The image and another one of the same build, as they lie in flash. `file`: with its path.
inline ElfImage with_boot_loader(const std::string& file, const std::string& boot) {
  ElfImage program = load_elf(file);
  const ElfImage loader = load_elf(file.substr(0, file.rfind('/') + 1) + boot);
  program.pieces.insert(program.pieces.end(), loader.pieces.begin(), loader.pieces.end());
  return program;
}
/// Another image that does the same: the word between its vectors and its header differs.
inline std::vector<std::uint8_t> another(std::vector<std::uint8_t> image, std::uint32_t which = 2) {
  ImageHeader header = decode_image_header(image);
  put_u32_le(std::span(image).subspan(ImageHeader::kOffset - 4), which);
  header.crc = image_crc(image);
  encode_image_header(header, image);
  return image;
}
inline std::vector<std::uint8_t> program_at(Chip& board, std::uint32_t address, std::uint32_t bytes) {
  const auto room = board.cpu().flash().subspan(address - CortexM4::kFlash, bytes);
  const std::size_t length = decode_image_header(room).length;
  return {room.begin(), room.begin() + static_cast<std::ptrdiff_t>(length)};
}

struct UpdateBench {
  UpdateBench(ElfImage flashed, const std::vector<EmulatedNodeOptions>& nodes)
      : image(std::move(flashed)), machine(image, nodes, 3) {}

  ElfImage image;
  EmulatedMachine machine;
  BusTime now{0};
  std::uint32_t spoken = 0;
  std::string message;  ///< of the last update

  template <typename OnFrame>
  void pass(OnFrame on_frame) {
    // The other device: 200 frames a second, urgent ones too.
    if (now.count() / 5'000'000 > spoken && machine.can_send())
      machine.send(now, CanFrame::make(0x0C0 + (++spoken % 2) * 0x300, {1, 2, 3, 0, 5, 6, 7, 8}));
    now += std::chrono::microseconds{200};
    for (bool done = false; !done;) {
      done = machine.advance(now);
      while (const auto got = machine.receive())
        if (!got->own) on_frame(got->frame);
    }
  }
  void wait(BusTime span) {
    for (const BusTime end = now + span; now < end;) pass([](const CanFrame&) {});
  }
  /// False: it failed. `cut`: told how far it is, whether the power of `board` goes now, which ends it.
  template <typename Cut>
  bool update(int board, std::uint8_t node, std::span<const std::uint8_t> bytes,
              const ProgramUpdate::Options& options, Cut&& cut) {
    ProgramUpdate work(node, bytes, now, options);
    std::optional<CanFrame> unsent;
    bool is_cut = false;
    while (work.status() == ProgramUpdate::Status::kBusy) {
      while (machine.can_send() && (unsent || (unsent = work.next_frame()))) {
        machine.send(now, *unsent);
        unsent.reset();
      }
      pass([&](const CanFrame& frame) { work.on_frame(now, frame); });
      work.on_time(now);
      if (is_cut || !cut(work)) continue;
      machine.power_cycle(board);
      is_cut = true;
    }
    message = work.message();
    fmt::print("node {}: {} at {} s\n", node, message, to_seconds(now));
    return work.status() == ProgramUpdate::Status::kDone;
  }
  bool update(int board, std::uint8_t node, std::span<const std::uint8_t> bytes, bool protect = false) {
    return update(board, node, bytes, {.protect = protect}, [](const ProgramUpdate&) { return false; });
  }
  /// The power goes at so many percent of the download.
  bool cut_update(int board, std::uint8_t node, std::span<const std::uint8_t> bytes, int percent) {
    return update(board, node, bytes, {.attempts = 1}, [percent](const ProgramUpdate& work) {
      return work.percent() >= percent && work.percent() < 100;
    });
  }
  /// The node keeps its id through power-off.
  void keep_id(const LssIdentity& identity) {
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
    master.select(now, identity);
    finish();
    master.store(now);
    finish();
    master.switch_all(now, false);
    finish();
  }
};

}  // namespace kinebus::emulator
