// The Octopus as a CAN interface of a computer: its own nodes, and an EBB at its CAN connector, behind one
// USB cable. The computer speaks as Linux's gs_usb driver does.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "protocol/canopen/alarm_codes.hpp"
#include "vcan_tests/emulator/ebb_board.hpp"
#include "vcan_tests/emulator/tests/gs_usb_host.hpp"
#include "vcan_tests/emulator/tests/octopus_bench.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint8_t kEbbId = 20;
constexpr int kUsb = kFirstInterrupt + 67;

const ElfImage& ebb_image() {
  static const ElfImage loaded = load_elf(KINEBUS_EBB_IMAGE);
  return loaded;
}
std::unique_ptr<Chip> make_ebb(const ElfImage&, const BoardOptions& options) {
  return std::make_unique<EbbBoard>(ebb_image(), options);
}

/// One cable; `head`: an EBB at the CAN connector.
struct OneCable {
  explicit OneCable(bool head)
      : machine(octopus_image(), boards(head)), host(machine, octopus()), bench(host) {}

  static std::vector<EmulatedNodeOptions> boards(bool head) {
    std::vector<EmulatedNodeOptions> all{
        {.board = {.unique_id = {1, 2, 3}}, .node_id = kId, .make = &make_board<OctopusBoard>}};
    if (head)
      all.push_back({.board = {.unique_id = {4, 5, 6}},
                     .node_id = kEbbId,
                     .powered_before = 137ms,
                     .clock_drift_ppm = 40,
                     .make = &make_ebb});
    return all;
  }
  OctopusBoard& octopus() { return machine.board<OctopusBoard>(0); }
  void connect() {
    host.plug();
    ASSERT_TRUE(host.probe());
    ASSERT_TRUE(host.up());
    bench.now = machine.now();
  }
  void expect_good() {
    EXPECT_EQ(host.strange_echoes, 0);
    EXPECT_EQ(host.overflows, 0);
    EXPECT_EQ(octopus().resets(), 0u);
    for (const std::string& violation : octopus().usb().violations()) ADD_FAILURE() << violation;
    EXPECT_TRUE(octopus().strange_accesses().empty());
    EXPECT_TRUE(octopus().lost_accesses().empty());
  }

  EmulatedMachine machine;
  GsUsbHost host;
  GatewayBench bench;
};

TEST(OctopusUsb, IsWhatTheDriverLooksForAndTakesOneBitRate) {
  OneCable cable(false);
  EXPECT_FALSE(cable.octopus().usb_device_seen()) << "no cable";
  cable.host.plug();
  ASSERT_TRUE(cable.host.probe());
  EXPECT_EQ(cable.host.control().text(1), "Kinebus");
  EXPECT_EQ(cable.host.control().text(3), "000000010000000200000003");
  EXPECT_FALSE(cable.host.up(500'000)) << "the nodes speak 1 Mbit/s";
  ASSERT_TRUE(cable.host.up());
  const auto before = cable.host.stamp();
  cable.bench.now = cable.machine.now();
  const BusTime from = cable.machine.now();
  cable.bench.run(100ms);
  const auto after = cable.host.stamp();
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(*after - *before, static_cast<double>((cable.machine.now() - from).count()) / 1e3, 500);
  cable.expect_good();
}

// Whoever looks sees the same frames in the same order, with the time at which they were on the wire.
TEST(OctopusUsb, BoardsNodesAndToolHeadAreOneBusInOneOrder) {
  OneCable cable(true);
  cable.connect();
  const std::size_t from = cable.host.wire.size();
  cable.bench.bring_up({kId, kId + 1, kId + 2, kId + 3, kEbbId});
  for (const std::uint8_t id : {kId, std::uint8_t{kId + 3}, kEbbId})
    EXPECT_NE(cable.bench.read(id, 0x1018, 4), 0) << "node " << int{id};
  cable.bench.run(2s);
  cable.bench.stop_sync();
  cable.bench.run(20ms);
  std::vector<GsUsbHost::Heard> heard;
  std::ranges::copy_if(cable.host.heard, std::back_inserter(heard),
                       [](const auto& h) { return (h.can_id & 1u << 29) == 0; });
  const auto& wire = cable.host.wire;
  ASSERT_EQ(heard.size(), wire.size() - from) << "none lost, none doubled";
  double worst = 0;
  for (std::size_t i = 0; i < heard.size(); ++i) {
    ASSERT_EQ(heard[i].can_id, wire[from + i].frame.id) << i;
    // From one frame to the next: the board's clock against true time.
    if (i == 0) continue;
    const double stamps = static_cast<double>(static_cast<std::int32_t>(heard[i].stamp - heard[i - 1].stamp));
    const double truth = static_cast<double>((wire[from + i].when - wire[from + i - 1].when).count()) / 1e3;
    worst = std::max(worst, std::abs(stamps - truth));
  }
  fmt::print("{} frames; time stamps within {:.2f} us of the wire, from frame to frame\n", heard.size(),
             worst);
  EXPECT_LE(worst, 2.5);
  cable.expect_good();
}

TEST(OctopusUsb, BoardsNodesAndToolHeadAgreeOnTimeWithin2Us) {
  OneCable cable(true);
  cable.connect();
  cable.bench.bring_up({kId, kId + 1, kId + 2, kId + 3, kEbbId});
  cable.bench.run(3s);
  cable.bench.rate(1.0);
  cable.bench.run(300ms);
  double worst = 0, most = -1e9, least = 1e9;
  cable.bench.run(2s, 10ms, [&] {
    const auto ticks =
        cable.machine.path_time(1, cable.machine.now()) - cable.machine.path_time(0, cable.machine.now());
    const double skew = static_cast<double>(ticks.count()) / 16;
    worst = std::max(worst, std::abs(skew));
    most = std::max(most, skew);
    least = std::min(least, skew);
  });
  fmt::print("skew of the EBB against the board's nodes: {:.2f} to {:.2f} us\n", least, most);
  EXPECT_LE(worst, 2.0);
  EXPECT_GT(cable.machine.path_time(0, cable.machine.now()).count(), 0);
  cable.expect_good();
}

TEST(OctopusUsb, WithNobodyAtTheConnectorItsNodesWorkAndTheHostIsTold) {
  OneCable cable(false);
  cable.connect();
  cable.bench.bring_up({kId, kId + 1, kId + 2, kId + 3});
  EXPECT_TRUE(cable.host.wire.empty() || cable.host.wire.back().when < 1s);
  cable.bench.enable(kId, 0, 1);
  cable.bench.move(kId, 0, 16'000, 200'000, 2'000'000);
  cable.bench.run(500ms);
  EXPECT_EQ(cable.octopus().driver(0).steps(), 1'000);
  const auto told = std::ranges::count_if(
      cable.host.heard, [](const auto& h) { return h.can_id == ((1u << 29) | 0x200 | 0x020); });
  EXPECT_EQ(told, 1) << "nobody acknowledges";
  const auto state = cable.host.state();
  EXPECT_EQ(state[0], 0u) << "the bus inside works";
  EXPECT_GE(state[2], 128u) << "transmit errors";
  cable.expect_good();
  // Somebody comes: from the next frame on all is on the wire.
  cable.machine.set_gateway_on_wire(true);
  cable.bench.run(20ms);
  const std::size_t before = cable.host.wire.size();
  cable.bench.run(500ms);
  const auto syncs = std::count_if(cable.host.wire.begin() + static_cast<std::ptrdiff_t>(before),
                                   cable.host.wire.end(), [](const auto& r) { return r.frame.id == 0x080; });
  EXPECT_NEAR(static_cast<double>(syncs), 10, 1);
  EXPECT_LE(cable.host.state()[2], 127u);
  // And goes.
  cable.machine.set_gateway_on_wire(false);
  cable.bench.run(20ms);
  EXPECT_EQ(cable.bench.read(kId, 0x6064, 0), 16'000);
  cable.expect_good();
}

// SYNC ends with the cable: all stop on the path and stand with power. With the cable back they go on from
// there.
TEST(OctopusUsb, APulledCableStopsBoardAndToolHeadOnThePathAndTheyGoOnWithIt) {
  OneCable cable(true);
  cable.connect();
  cable.bench.bring_up({kId, kId + 1, kId + 2, kId + 3, kEbbId});
  for (int axis = 0; axis < 2; ++axis) {
    cable.bench.write(kId, static_cast<std::uint16_t>(0x607F + 0x800 * axis), 0, 4, 3'200'000);
    cable.bench.enable(kId, axis, 7);
  }
  StreamFeed feed{.id = kId};
  cable.bench.write(kId, 0x2115, 0, 2, 5);
  cable.bench.send(feed.start(cable.bench.read_long(kId, 0x2112) / kPathTicksPerUnit + 20'000));
  cable.bench.send(feed.segment(5'000, 150'000, -120'000));
  for (int i = 0; i < 20; ++i) cable.bench.send(feed.segment(5'000, 0, 0));
  cable.bench.send(feed.segment(5'000, -150'000, 120'000));
  cable.bench.send(feed.end());
  cable.bench.run(20ms);
  cable.bench.rate(1);
  cable.bench.run(400ms);
  const StepDriver& driver = cable.octopus().driver(0);
  const std::int64_t before = driver.steps();
  EXPECT_GT(std::abs(before), 20) << "it moves";
  cable.bench.stop_sync();
  cable.host.unplug();
  cable.bench.run(1s);
  const auto ticks = [&](int node) { return cable.machine.path_time(node, cable.machine.now()); };
  const std::array<PathTime, 2> stopped{ticks(0), ticks(1)};
  const std::int64_t stood = driver.steps();
  cable.octopus().clear_edges();
  cable.bench.run(500ms);
  EXPECT_TRUE(driver.edges().empty()) << "it stands";
  EXPECT_TRUE(driver.enabled());
  const double whole = static_cast<double>(feed.state[0].position) / kCount;
  EXPECT_LT(std::abs(static_cast<double>(stood) * 16), std::abs(whole) / 2) << "long before its end";
  for (int node = 0; node < 2; ++node) EXPECT_EQ(ticks(node), stopped[static_cast<std::size_t>(node)]);
  EXPECT_EQ(stopped[0], stopped[1]) << "all at the same place of the path";
  EXPECT_LE(
      std::abs(stood - nearest_step(static_cast<double>(feed.position(0, stopped[0].count())) / kCount)), 1);
  // And back.
  cable.host.plug();
  ASSERT_TRUE(cable.host.probe());
  ASSERT_TRUE(cable.host.up());
  cable.bench.now = cable.machine.now();
  cable.bench.start_sync();
  cable.bench.run(2s);
  EXPECT_NE(cable.bench.read(kId, 0x1018, 4), 0);
  EXPECT_NE(cable.bench.read(kEbbId, 0x1018, 4), 0);
  const auto codes = cable.bench.emergencies(kId);
  cable.bench.command(RateCommand::Kind::kClear);
  cable.bench.run(50ms);
  cable.bench.rate(1);
  cable.bench.run(3s);
  EXPECT_EQ(driver.steps(), nearest_step(whole));
  cable.expect_good();
}

// Six axes in motion, two at rest with power, a bus that is full, and a host that sends and reads all the
// time. The time that steps take does not grow with the speed alone: looking for the next step takes its
// part.
struct OctopusUsbLoad : testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(StepsPerSecond, OctopusUsbLoad, testing::Values(50'000, 100'000, 200'000));

TEST_P(OctopusUsbLoad, FullLoadTakesNoControlPeriodAndLosesNoFrame) {
  const int steps_per_s = GetParam();
  OneCable cable(true);
  cable.connect();
  cable.bench.bring_up({kId, kId + 1, kId + 2, kId + 3, kEbbId});
  const auto way = [&](int axis) { return (axis % 2 == 0 ? 1 : -1) * (axis < 6 ? 8 * steps_per_s : 0); };
  for (int axis = 0; axis < 8; ++axis) {
    cable.bench.write(id_of(axis), static_cast<std::uint16_t>(0x607F + 0x800 * (axis % 2)), 0, 4, 3'200'000);
    cable.bench.enable(id_of(axis), axis % 2, 1);
  }
  for (int axis = 0; axis < 8; ++axis)
    cable.bench.move(id_of(axis), axis % 2, way(axis), 16 * steps_per_s, 32'000'000);
  cable.machine.set_gateway_on_wire(true);
  cable.bench.run(50ms);
  CortexM4& cpu = cable.octopus().cpu();
  cpu.clear_costs();
  const Cycle began = cable.octopus().now(), idle = cpu.idle();
  const std::size_t wire = cable.host.wire.size(), heard = cable.host.heard.size();
  std::uint32_t strangers = 0, own = 0;
  // A stranger on the wire and the host speak with others; some of what the host says all nodes take: EMCYs
  // that ask for nothing.
  cable.bench.run(200ms, 300us, [&] {
    if (cable.machine.can_send())
      cable.machine.send(cable.machine.now(),
                         CanFrame::make(0x1C1 + strangers++ % 8, {0, 0, 0, 0, 0, 0, 0, 0}));
    if (cable.host.can_send())
      cable.host.send(cable.machine.now(),
                      CanFrame::make(++own % 6 == 0 ? 0x0D1 : 0x1D1, {0, 0, 0, 0, 0, 0, 0, 0}));
  });
  const ExceptionCost control = cpu.cost(kControl), usb = cpu.cost(kUsb);
  const double span = static_cast<double>(cable.octopus().now() - began);
  const double awake = 1 - static_cast<double>(cpu.idle() - idle) / span;
  const double longest_pass_ms = seconds_of(cpu.longest_pass()) * 1e3;
  cable.bench.run(50ms);
  const std::size_t on_wire = cable.host.wire.size() - wire, told = cable.host.heard.size() - heard;
  fmt::print(
      "{} steps/s: {} frames on the wire in 0.2 s, {} of the host; control interrupt {:.1f} % at most, with "
      "what "
      "interrupts it, USB {:.1f} % of the "
      "processor and {:.1f} us at most; awake {:.0f} %, main loop {:.1f} ms at most\n",
      steps_per_s, on_wire, own, 100 * control.worst_cycles / kControlPeriod,
      100 * static_cast<double>(usb.cycles) / span, static_cast<double>(usb.worst_cycles) / 168, 100 * awake,
      longest_pass_ms);
  EXPECT_EQ(told, on_wire) << "none lost";
  EXPECT_GT(own, 600u);
  EXPECT_LE(control.worst_cycles, 0.6 * kControlPeriod);
  EXPECT_NEAR(static_cast<double>(control.calls), span / kControlPeriod, 2);
  EXPECT_LT(longest_pass_ms, 4) << "half of a plan";
  cable.bench.run(800ms);
  for (int axis = 0; axis < 8; ++axis)
    EXPECT_EQ(cable.octopus().driver(axis).steps(), way(axis) / 16) << axis;
  for (std::uint8_t n = 0; n < 4; ++n) EXPECT_TRUE(cable.bench.emergencies(kId + n).empty());
  EXPECT_EQ(cable.bench.read(kId, 0x2120, 2), 0) << "receive overruns";
  cable.expect_good();
}

}  // namespace
}  // namespace kinebus::emulator
