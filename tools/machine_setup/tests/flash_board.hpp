#pragma once
// An EBB with its boot loader, the real one, on flash that is kept: without a program, with that of an axis
// or with that of a heat node, which are the real cores. Programs are written as kinebus-flash writes them.

#include <memory>
#include <vector>

#include "node_firmware/boot/tests/boot_bench.hpp"
#include "node_firmware/core/node.hpp"
#include "node_firmware/heat/heat_node.hpp"
#include "protocol/canopen/boards/all.hpp"

namespace kinebus {

class FlashBoard {
 public:
  static constexpr std::size_t kRoom = 16'384;
  static constexpr ImageTarget kTarget = image_target(Stm32g0b1EbbBoard::kFacts);

  FlashBoard(std::uint32_t serial, LocalTime now)
      : identity_{kVendorId, kTarget.product_code, kTarget.revision, serial} {
    reset(now);
  }
  /// An image for it, as a file of another release each.
  static std::vector<std::uint8_t> image(std::uint8_t release, bool of_heat) {
    constexpr std::size_t kBytes = 4004;
    return make_image(
        kBytes, release,
        image_header_for(kTarget, of_heat ? HeatBoard::kFacts.product_code : ImageHeader::kAsBoard));
  }
  /// As it comes from a programmer.
  void write(const std::vector<std::uint8_t>& image, std::uint8_t node_id, LocalTime now) {
    flash.erase();
    for (std::uint32_t at = 0; at < image.size(); at += 4)
      flash.program(at, get_u32_le(std::span(image).subspan(at)));
    handover_.node_id = node_id;
    reset(now);
  }
  void power_cycle(LocalTime now) {
    handover_ = {.magic = 0};
    reset(now);
  }

  void on_frame(LocalTime now, const CanFrame& frame) {
    if (boot) boot->on_frame(now, frame);
    if (axis) axis->on_frame(now, frame);
    if (heat) heat->on_frame(now, frame);
  }
  void on_time(LocalTime now) {
    if (boot) boot->on_time(now);
    if (axis) axis->on_time(now), store(*axis);
    if (heat) heat->on_time(now), store(*heat);
  }
  std::optional<CanFrame> next_frame(LocalTime now) {
    auto frame = boot ? boot->next_frame() : axis ? axis->next_frame() : heat->next_frame();
    if (frame) return frame;
    const std::uint8_t id = node_id();
    if (boot && boot->start_requested()) {
      handover_ = {.node_id = id};
      reset(now);
    } else if ((axis && axis->program_stop_requested()) || (heat && heat->program_stop_requested())) {
      handover_ = {.stay = Handover::kBootLoader, .node_id = id};
      reset(now);
    }
    return std::nullopt;
  }
  std::uint8_t node_id() const { return boot ? boot->node_id() : axis ? axis->node_id() : heat->node_id(); }

  ModelFlash flash{kRoom, 3};
  std::unique_ptr<BootLoader> boot;
  std::unique_ptr<LoneNode> axis;
  std::unique_ptr<heat::HeatNode> heat;

 private:
  template <typename Program>
  void store(Program& program) {
    const auto image = program.image_to_store();
    if (image.empty()) return;
    parameters_.assign(image.begin(), image.end());
    parameters_of_heat_ = heat != nullptr;
    program.on_image_stored(true);
  }
  void reset(LocalTime now) {
    boot.reset(), axis.reset(), heat.reset();
    const bool start = start_program(handover_, check_image(flash.bytes(), kTarget));
    const auto id = static_cast<std::uint8_t>(std::exchange(handover_.node_id, 0));
    const ImageHeader header = decode_image_header(flash.bytes());
    const bool is_heat = start && header.node_product_code() == HeatBoard::kFacts.product_code;
    // What the other kind has stored is nothing to this one.
    if (start && is_heat != parameters_of_heat_) parameters_.clear();
    if (!start)
      boot = std::make_unique<BootLoader>(kTarget, identity_, id, flash, now);
    else if (is_heat)
      heat = std::make_unique<heat::HeatNode>(
          heat::HeatNodeOptions{.node_id = id, .serial = identity_[3], .program_crc = header.crc}, now,
          parameters_);
    else
      axis = std::make_unique<LoneNode>(
          NodeOptions{.identity = {.product_code = kTarget.product_code, .serial = identity_[3]},
                      .node_id = id,
                      .program_crc = header.crc},
          now, parameters_);
  }

  LssIdentity identity_;
  Handover handover_{.magic = 0};
  std::vector<std::uint8_t> parameters_;
  bool parameters_of_heat_ = false;
};

}  // namespace kinebus
