// The virtual machine by itself: who waits for it, and what wakes them.

#include "tools/simulation/bus/virtual_machine.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "gateway/description/machine_description.hpp"
#include "tools/simulation/bus/virtual_nodes.hpp"

namespace kinebus {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr VirtualClocks kClocks{.drift_ppm = 25, .latency_max = std::chrono::microseconds{20}};

/// Carriages that stand so near to their switches that these are looked at all the time.
VirtualMachine beside_the_switches() {
  auto nodes = virtual_nodes_of(default_m1(), kClocks, 1);
  for (VirtualNodeOptions& node : nodes)
    for (VirtualAxis& axis : node.axes)
      if (axis.switch_input != 0) axis.switch_counts = axis.start_counts + 3;
  return VirtualMachine(nodes, 1);
}

struct Heard {
  std::vector<std::pair<BusTime, CanFrame>> frames;
  int wakes = 0;
};
template <typename Next>
Heard listen(VirtualMachine& machine, BusTime until, Next next) {
  Heard heard;
  for (BusTime now{0}; now < until; now = std::max(next(now), now + BusTime{1})) {
    ++heard.wakes;
    for (bool done = false; !done;) {
      done = machine.advance(now);
      while (const auto got = machine.receive()) heard.frames.emplace_back(got->when, got->frame);
    }
  }
  return heard;
}

TEST(VirtualMachine, WhoLooksRarelyHearsTheSameFramesWithTheSameStamps) {
  VirtualMachine often = beside_the_switches(), rarely = beside_the_switches();
  const Heard all = listen(often, seconds{3}, [&](BusTime) { return often.next_event(); });
  const Heard few =
      listen(rarely, seconds{3}, [&](BusTime now) { return rarely.next_event(now + milliseconds{2}); });
  ASSERT_GT(all.frames.size(), 3u);
  EXPECT_TRUE(all.frames == few.frames);
  EXPECT_GT(all.wakes, 100'000) << "a look each 3 us";
  EXPECT_LT(few.wakes, 3'000);
}

}  // namespace
}  // namespace kinebus
