// Touch probe 1 (CiA 402, 60B8h ff.) on a switch input: the first edge of each kind, where the axes were and
// when.

#include "node_firmware/core/tests/node_bench.hpp"

namespace kinebus::testing_bench {
namespace {

constexpr std::uint8_t kProbeNode = 3;
constexpr int kInput = 4;  // input 5

std::int64_t status(Bench& bench) {
  return bench.read(kProbeNode, 0x60B9, 0);
}

Bench probing_bench() {
  return Bench({NodeSetup{.id = kProbeNode}});
}

void touch(Bench& bench, bool level) {
  bench.node().on_switch(bench.local(), kInput, level);
  bench.run(5ms);
}

TEST(NodeProbe, KeepsTheFirstEdgeOfEachKindSinceItWasSwitchedOn) {
  Bench bench = probing_bench();
  bench.write(kProbeNode, 0x2130, 5, 1, 8);
  bench.write(kProbeNode, 0x2132, 5, 2, 500);
  touch(bench, true);
  EXPECT_EQ(status(bench), 0) << "it is off";
  touch(bench, false);
  bench.write(kProbeNode, 0x60B8, 0, 2, 0x31);
  EXPECT_EQ(status(bench), 0x01);
  const LocalTime before = bench.local();
  touch(bench, true);
  EXPECT_EQ(status(bench), 0x03);
  const auto first = static_cast<std::uint32_t>(bench.read(kProbeNode, 0x60D1, 0));
  EXPECT_EQ(first, static_cast<std::uint32_t>(bench.node().path().clock().to_bus(before).count()))
      << "the edge itself, not when debouncing believed it";
  touch(bench, false);
  EXPECT_EQ(status(bench), 0x07);
  const auto gone = static_cast<std::uint32_t>(bench.read(kProbeNode, 0x60D2, 0));
  EXPECT_GT(gone - first, 4'000'000u);
  touch(bench, true);
  EXPECT_EQ(static_cast<std::uint32_t>(bench.read(kProbeNode, 0x60D1, 0)), first);
  bench.write(kProbeNode, 0x60B8, 0, 2, 0x33);
  EXPECT_EQ(status(bench), 0x01) << "what was stored is forgotten";
  touch(bench, false);
  touch(bench, true);
  touch(bench, false);
  touch(bench, true);
  EXPECT_EQ(status(bench), 0x07);
  EXPECT_GT(static_cast<std::uint32_t>(bench.read(kProbeNode, 0x60D1, 0)) -
                static_cast<std::uint32_t>(bench.read(kProbeNode, 0x60D2, 0)),
            0u);
}

TEST(NodeProbe, TellsWhereAMovingAxisWasAndLetsItMoveOn) {
  Bench bench = probing_bench();
  bench.write(kProbeNode, 0x2130, 5, 1, 8);
  bench.write(kProbeNode, 0x60B8, 0, 2, 0x11);
  bench.enable(kProbeNode, 0, 1);
  bench.write(kProbeNode, 0x607A, 0, 4, 100'000);
  bench.write(kProbeNode, 0x6081, 0, 4, 20'000);
  bench.write(kProbeNode, 0x6040, 0, 2, 0x1F);
  bench.run(1s);
  const std::int64_t here = bench.read(kProbeNode, 0x6062, 0);
  touch(bench, true);
  const std::int64_t latched = bench.read(kProbeNode, 0x60BA, 0);
  EXPECT_GE(latched, here);
  EXPECT_LE(latched, here + 200) << "10 ms at 20000 counts/s";
  EXPECT_EQ(bench.read(kProbeNode, 0x68BA, 0), 0) << "the other axis was not switched on";
  bench.run(6s);
  EXPECT_EQ(bench.read(kProbeNode, 0x6062, 0), 100'000);
}

TEST(NodeProbe, IsNoPartOfTheFingerprint) {
  Bench bench = probing_bench();
  const auto before = bench.read(kProbeNode, 0x2116, 0);
  bench.write(kProbeNode, 0x60B8, 0, 2, 0x31);
  EXPECT_EQ(bench.read(kProbeNode, 0x2116, 0), before);
}

/// What TPDO1 told of the input since the frame `from`, one after the other.
std::vector<bool> told(const Bench& bench, std::size_t from) {
  std::vector<bool> levels;
  for (std::size_t i = from; i < bench.seen.size(); ++i) {
    const CanFrame& frame = bench.seen[i].frame;
    if (frame.id != 0x180U + kProbeNode) continue;
    const bool on = (frame.data[6] >> kInput & 1U) != 0;
    if (levels.empty() || levels.back() != on) levels.push_back(on);
  }
  return levels;
}

TEST(NodeInputs, APulseIsToldThoughItIsOverWhenTheMainLoopHearsOfIt) {
  Bench bench = probing_bench();
  bench.send(nmt_frame(NmtCommand::kStart, kAllNodes));
  bench.run(50ms);
  for (const auto late : {LocalTime{0}, LocalTime{4'000'000}}) {
    const std::size_t from = bench.seen.size();
    const LocalTime begin = bench.local() - late;
    bench.node().on_switch(begin, kInput, true);
    bench.node().on_switch(begin + LocalTime{600'000}, kInput, false);
    bench.read(kProbeNode, 0x1000, 0);  // the main loop comes round
    bench.run(100ms);
    EXPECT_EQ(told(bench, from), (std::vector<bool>{true, false})) << "late by " << late.count() << " ns";
    EXPECT_EQ(bench.read(kProbeNode, 0x2133, 0), 0);
  }
  // Shorter than the debounce time it is none.
  const std::size_t from = bench.seen.size();
  bench.node().on_switch(bench.local(), kInput, true);
  bench.node().on_switch(bench.local() + LocalTime{400'000}, kInput, false);
  bench.run(100ms);
  for (const bool on : told(bench, from)) EXPECT_FALSE(on);
}

TEST(NodeInputs, WhoseChangesNobodyHearsIsReadAsItIs) {
  Bench bench = probing_bench();  // not operational: TPDO1 is not sent
  bench.node().on_switch(bench.local(), kInput, true);
  bench.run(2ms);
  bench.node().on_switch(bench.local(), kInput, false);
  bench.run(2ms);
  EXPECT_EQ(bench.read(kProbeNode, 0x2133, 0), 0);
}

}  // namespace
}  // namespace kinebus::testing_bench
