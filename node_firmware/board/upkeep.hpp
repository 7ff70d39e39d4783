#pragma once
// What a node's program looks after besides the node: stored parameters, the watchdog, what a reset keeps.

#include <chrono>
#include <cstdint>

#include "node_firmware/board/drivers.hpp"
#include "node_firmware/boot/handover.hpp"
#include "node_firmware/core/node.hpp"

namespace kinebus {

/// An erase that a save needs is made at start, while nothing moves: room for a whole image.
inline constexpr std::size_t kLargestParameterImage = 5000;
/// So long without a reset: this program is good.
inline constexpr LocalTime kProgramProved = std::chrono::seconds{5};

/// Each pass: what the node wants kept is written. The processor stands still meanwhile: up to 0.5 s for an
/// erase and 100 us a word. Only while no motor of the board has power. True: it was told what came of it.
template <WatchdogDriver Watchdog, typename Save>
bool store_parameters(Node& node, Watchdog& dog, Save&& save) {
  const auto image = node.image_to_store();
  if (image.empty()) return false;
  dog.allow_flash();
  node.on_image_stored(save(image));
  dog.back_to_normal();
  return true;
}

/// The id under which the boot loader answered, which may have come by LSS and be stored nowhere; once. 0: as
/// stored.
inline std::uint8_t take_inherited_node_id(Handover& handover) {
  const std::uint32_t id = handover.magic == Handover::kMagic ? handover.node_id : 0;
  handover.node_id = 0;
  return id <= 127 ? static_cast<std::uint8_t>(id) : std::uint8_t{0};
}

/// Feeds the watchdog, every 10 ms, only when the control goes on and the node's timed jobs are served.
class WatchdogKeeper {
 public:
  /// `nodes`: one, or the program of several. `ticks`: control interrupts so far.
  template <WatchdogDriver Watchdog, typename Nodes>
  void serve(Watchdog& dog, LocalTime now, const Nodes& nodes, std::uint32_t ticks) {
    if (now < due_) return;
    due_ = now + std::chrono::milliseconds{10};
    if (!nodes.healthy(now) || ticks == fed_at_) return;
    fed_at_ = ticks;
    dog.feed();
  }

 private:
  LocalTime due_{0};
  std::uint32_t fed_at_ = 0;
};

}  // namespace kinebus
