#pragma once
// Whether there is anybody else on the bus: what is sent there is acknowledged, or something is heard.

#include <cstdint>

namespace kinebus {

class LonelyBus {
 public:
  /// So long nothing that waits has gone out, and nothing was heard. On a bus that works a frame takes 0.13
  /// ms, and whatever is more urgent is heard; bus-off is over within 1.5 ms. Local counts.
  static constexpr std::uint32_t kPatience = 5 * 4000;

  /// Main loop, each pass. `waits`: something is to be sent, or the controller has not joined the bus.
  /// `progress` is another number after each frame that was sent or heard. True: it is lonely.
  bool look(std::uint32_t counts, bool waits, std::uint32_t progress) {
    if (!waits || progress != progress_) since_ = counts;
    progress_ = progress;
    return counts - since_ > kPatience;
  }

 private:
  std::uint32_t since_ = 0, progress_ = 0;
};

}  // namespace kinebus
