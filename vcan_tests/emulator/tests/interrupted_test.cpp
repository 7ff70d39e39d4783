// Interrupted again and again on three firmware images: no node is ever elsewhere than the gateway believes
// (FF03h). Some rounds in the tests; KINEBUS_ROUNDS=500 by hand, which prints how many there were.

#include <cstdio>

#include "gateway/machine/tests/stranger_rig.hpp"
#include "vcan_tests/emulator/emulated_machine.hpp"

namespace kinebus::emulator {
namespace {

/// Boards whose carriages stand a little off their switches: homing takes a second, not ten.
std::vector<EmulatedNodeOptions> boards_near_the_switches(std::vector<VirtualNodeOptions> nodes) {
  double off = 9'000;
  for (VirtualNodeOptions& node : nodes)
    for (VirtualAxis& axis : node.axes)
      if (axis.switch_input != 0)
        axis.start_counts = axis.switch_counts + (axis.active_above ? -1 : 1) * (off += 1'111);
  return boards_like(nodes);
}

class ThreeImages final : public EmulatedMachine {
 public:
  ThreeImages(const std::vector<VirtualNodeOptions>& nodes, std::uint64_t)
      : EmulatedMachine(load_elf(KINEBUS_FIRMWARE_IMAGE), boards_near_the_switches(nodes)) {}
};
using Images = StrangerOf<ThreeImages>;

void tell(const char* what, const Images& rig, int times) {
  std::printf("%s: %d times in %.0f s of the machine's time\n", what, times, to_seconds(rig.now));
}

TEST(Interrupted, CancelAndReferenceFindsEveryImageWhereTheGatewayBelieves) {
  Images rig;
  const int times = rounds(6);
  cancel_and_reference(rig, times);
  tell("cancel and reference", rig, times);
}

TEST(Interrupted, LostRecordAndResumeFindsEveryImageWhereTheGatewayBelieves) {
  Images rig;
  const int times = rounds(6);
  lose_record_and_resume(rig, times);
  tell("lost record and resume", rig, times);
}

}  // namespace
}  // namespace kinebus::emulator
