// The heat node as a device of CiA 301 and 305: NMT, PDOs, its id.
#include <gtest/gtest.h>

#include "node_firmware/heat/tests/heat_node_bench.hpp"

namespace kinebus::heat {
namespace {

TEST(HeatNode, ObeysNmt) {
  HeatNodeBench bench;
  bench.set_up();
  ASSERT_EQ(bench.write_set_point(1, 2100), 0u);
  bench.run(10);
  bench.nmt(NmtCommand::kResetCommunication);
  bench.run(1);
  EXPECT_NE(bench.node.heater_output(0), 0u) << "communication only";
  EXPECT_EQ(bench.node.nmt_state(), NmtState::kPreOperational);
  bench.nmt(NmtCommand::kStop);
  bench.run(0.2);
  EXPECT_EQ(bench.node.heater_output(0), 0u);
  EXPECT_EQ(bench.read({0x1001, 0}), std::nullopt) << "stopped: no SDO";
  bench.nmt(NmtCommand::kStart);
  EXPECT_EQ(bench.read({0x7402, 1}), 0u);
  ASSERT_EQ(bench.write_set_point(1, 2100), 0u);
  bench.run(1);
  bench.nmt(NmtCommand::kResetNode);
  bench.run(1);
  EXPECT_EQ(bench.node.heater_output(0), 0u);
  EXPECT_EQ(bench.read({0x6110, 1}), 0u) << "settings as stored";
}

TEST(HeatNode, SynchronousPdosAndWrongLengthsAreAsCiaSays) {
  HeatNodeBench bench;
  // RPDO1 takes effect with SYNC, TPDO2 comes with every one.
  ASSERT_EQ(bench.write({0x1400, 2}, 1, 1), 0u);
  ASSERT_EQ(bench.write({0x1801, 2}, 1, 1), 0u);
  bench.set_up();
  CanFrame set_points{.id = 0x200u + HeatNodeBench::kId, .length = 8};
  put_u16_le(set_points.data, 2000);
  bench.send(set_points);
  EXPECT_EQ(bench.read({0x7402, 1}), 0u);
  bench.forget();
  bench.send(CanFrame{.id = 0x080});
  EXPECT_EQ(bench.read({0x7402, 1}), 2000u);
  EXPECT_EQ(std::count_if(bench.seen.begin(), bench.seen.end(),
                          [](const CanFrame& frame) { return frame.id == 0x280u + HeatNodeBench::kId; }),
            1);
  bench.send(CanFrame::make(0x200u + HeatNodeBench::kId, {1, 2, 3}));
  EXPECT_EQ(bench.emergencies(0x8210).size(), 1u);
  bench.send(CanFrame::make(0x080, {1}));
  EXPECT_EQ(bench.emergencies(0x8240).size(), 1u);
}

TEST(HeatNode, GetsItsIdByLss) {
  HeatNode node({.serial = 4711}, LocalTime{1s});
  LssMaster master;
  LocalTime now{1s};
  const auto settle = [&] {
    for (int i = 0; i < 5000 && master.status() == LssMaster::Status::kBusy; ++i) {
      now += 1ms;
      node.on_time(now);
      master.on_time(now);
      while (const auto frame = master.next_frame()) node.on_frame(now, *frame);
      while (const auto frame = node.next_frame()) master.on_frame(*frame);
      if (!node.image_to_store().empty()) node.on_image_stored(true);
    }
    return master.status() == LssMaster::Status::kDone;
  };
  ASSERT_TRUE(master.fastscan(now) && settle());
  EXPECT_EQ(master.identity()[1], 0x404u);
  EXPECT_EQ(master.identity()[3], 4711u);
  ASSERT_TRUE(master.configure_node_id(now, 33) && settle());
  ASSERT_TRUE(master.store(now) && settle());
  ASSERT_TRUE(master.switch_all(now, false));
  settle();
  EXPECT_EQ(node.node_id(), 33);
}

}  // namespace
}  // namespace kinebus::heat
