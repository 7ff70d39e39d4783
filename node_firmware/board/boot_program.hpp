#pragma once
// The boot loader on a board: feeds it frames and time. One pass of its main loop.

#include <array>
#include <span>

#include "node_firmware/board/drivers.hpp"
#include "node_firmware/board/local_clock.hpp"
#include "node_firmware/boot/boot_loader.hpp"
#include "node_firmware/boot/handover.hpp"
#include "node_firmware/core/parameter_image.hpp"

namespace kinebus {

/// Under which id the boot loader answers: the program's that gave way to it, or the stored one; 0: none.
inline std::uint8_t boot_node_id(const Handover& handover, ParameterImage& image,
                                 std::span<const std::uint8_t> stored) {
  if (handover.node_id >= 1 && handover.node_id <= 127) return static_cast<std::uint8_t>(handover.node_id);
  return image.adopt(stored) == ParameterImage::Load::kGood ? image.node_id() : std::uint8_t{0};
}

template <CanDriver Can, LocalCounter Counter>
class BootProgram {
 public:
  BootProgram(const ImageTarget& board, const LssIdentity& identity, std::uint8_t node_id,
              ProgramFlash& flash, Can& can)
      : can_(can), loader_(board, identity, node_id, flash, clock_.now()) {
    hear();
  }

  /// Call at least every millisecond. True: the program is to be started, and the answer to that is on the
  /// bus.
  bool pass() {
    loader_.on_time(clock_.now());
    while (const auto* received = can_.front()) {
      loader_.on_frame(clock_.now(), received->frame());
      can_.drop();
    }
    can_.serve_mailboxes();
    while (can_.queue().has_room()) {
      const auto frame = loader_.next_frame();
      if (!frame) break;
      can_.queue().push(*frame);
      can_.serve_mailboxes();
    }
    if (heard_ != loader_.node_id()) hear();
    return loader_.start_requested() && can_.queue().idle();
  }
  std::uint8_t node_id() const { return loader_.node_id(); }

 private:
  void hear() {
    heard_ = loader_.node_id();
    const std::array<CanAccept, 3> filters{{{0x000}, {0x7E5}, {static_cast<std::uint16_t>(0x600 + heard_)}}};
    can_.accept(std::span(filters).first(heard_ == 0 ? 2 : 3));
  }

  Can& can_;
  LocalClock<Counter> clock_;
  BootLoader loader_;
  std::uint8_t heard_ = 0;
};

}  // namespace kinebus
