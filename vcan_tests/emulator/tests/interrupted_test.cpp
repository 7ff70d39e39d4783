// Interrupted again and again on firmware images, three F405s and the nodes of one Octopus: no node is ever
// elsewhere than the gateway believes (FF03h). Some rounds in the tests; KINEBUS_ROUNDS=500 by hand.

#include <cstdio>

#include "gateway/machine/tests/stranger_rig.hpp"
#include "vcan_tests/emulator/emulated_machine.hpp"
#include "vcan_tests/emulator/octopus_board.hpp"

namespace kinebus::emulator {
namespace {

/// Carriages that stand a little off their switches: homing takes a second, not ten.
std::vector<VirtualNodeOptions> near_the_switches(std::vector<VirtualNodeOptions> nodes) {
  double off = 9'000;
  for (VirtualNodeOptions& node : nodes)
    for (VirtualAxis& axis : node.axes)
      if (axis.switch_input != 0)
        axis.start_counts = axis.switch_counts + (axis.active_above ? -1 : 1) * (off += 1'111);
  return nodes;
}

class ThreeImages final : public EmulatedMachine {
 public:
  ThreeImages(const std::vector<VirtualNodeOptions>& nodes, std::uint64_t)
      : EmulatedMachine(load_elf(KINEBUS_FIRMWARE_IMAGE), boards_like(near_the_switches(nodes))) {}
};
using Images = StrangerOf<ThreeImages>;

/// The machine's nodes are the first ones of one board, whose axes and inputs are counted through.
class OneOctopus final : public EmulatedMachine {
 public:
  OneOctopus(const std::vector<VirtualNodeOptions>& nodes, std::uint64_t)
      : EmulatedMachine(load_elf(KINEBUS_OCTOPUS_IMAGE), {board_of(near_the_switches(nodes))}),
        count_(static_cast<int>(nodes.size())) {}

  double true_counts(int node, int axis, BusTime at) override {
    return EmulatedMachine::true_counts(0, 2 * node + axis, at);
  }
  PathTime path_time(int, BusTime at) override { return EmulatedMachine::path_time(0, at); }
  int node_count() const override { return count_; }
  void set_input(int node, BusTime at, int input, bool level) override {
    EmulatedMachine::set_input(0, at, 2 * node + input, level);
  }

 private:
  static EmulatedNodeOptions board_of(const std::vector<VirtualNodeOptions>& nodes) {
    EmulatedNodeOptions board;
    board.node_id = nodes.front().node.node_id;
    board.make = &make_board<OctopusBoard>;
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (std::size_t axis = 0; axis < nodes[n].axes.size(); ++axis) {
        VirtualAxis& mine = board.board.axes[2 * n + axis];
        mine = nodes[n].axes[axis];
        if (mine.switch_input != 0) mine.switch_input += static_cast<int>(2 * n);
      }
    return board;
  }
  int count_;
};
using Octopus = StrangerOf<OneOctopus>;

template <typename Rig>
void tell(const char* what, const Rig& rig, int times) {
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

TEST(Interrupted, CancelAndReferenceFindsEveryNodeOfAnOctopusWhereTheGatewayBelieves) {
  Octopus rig;
  const int times = rounds(3);
  cancel_and_reference(rig, times);
  tell("cancel and reference on an Octopus", rig, times);
}

TEST(Interrupted, LostRecordAndResumeFindsEveryNodeOfAnOctopusWhereTheGatewayBelieves) {
  Octopus rig;
  const int times = rounds(3);
  lose_record_and_resume(rig, times);
  tell("lost record and resume on an Octopus", rig, times);
}

}  // namespace
}  // namespace kinebus::emulator
