// A heat node in a session: what it does of what nobody vouches for.

#include "node_firmware/heat/tests/heat_node_bench.hpp"
#include "protocol/can/candump.hpp"
#include "protocol/canopen/alarm_codes.hpp"
#include "protocol/motion/voucher.hpp"

namespace kinebus::heat {
namespace {

constexpr std::uint32_t kDeviceState = 0x08000022;

struct HeatSession : testing::Test {
  HeatSession() {
    bench.set_up();
    begin_session(1);
  }

  /// By the master, who holds the key that the node has.
  void vouched(const CanFrame& frame) {
    bench.send(master->vouch_for(frame));
    bench.send(frame);
  }
  static CanFrame writing(ObjectAddress a, std::uint32_t value, int bytes) {
    CanFrame request{.id = 0x600u + HeatNodeBench::kId, .length = 8};
    request.data[0] = static_cast<std::uint8_t>(0x23 | (4 - bytes) << 2);
    put_u16_le(std::span(request.data).subspan(1), a.index);
    request.data[3] = a.subindex;
    put_u32_le(std::span(request.data).subspan(4), value);
    return request;
  }
  static CanFrame set_points(std::uint16_t tenths) {
    CanFrame frame{.id = 0x200u + HeatNodeBench::kId, .length = 8};
    put_u16_le(frame.data, tenths);
    return frame;
  }
  void begin_session(std::uint64_t key_low) {
    const SipHashKey key{key_low, 7};
    const std::array<std::uint32_t, 4> parts{
        static_cast<std::uint32_t>(key.low), static_cast<std::uint32_t>(key.low >> 32),
        static_cast<std::uint32_t>(key.high), static_cast<std::uint32_t>(key.high >> 32)};
    const auto tell = [&](std::uint8_t subindex, std::uint32_t value, int bytes) {
      const CanFrame request = writing({0x2117, subindex}, value, bytes);
      master ? vouched(request) : bench.send(request);
    };
    for (std::uint8_t i = 0; i < 4; ++i) tell(static_cast<std::uint8_t>(i + 1), parts[i], 4);
    tell(5, 1, 1);
    master.emplace(key);
  }
  /// With the gateway's SYNC.
  void run(double seconds) {
    for (double t = 0; t < seconds; t += 0.05) {
      bench.send(CanFrame{.id = 0x080});
      bench.run(0.05);
    }
  }
  void heat() {
    vouched(writing({0x7402, 1}, 2000, 2));
    run(1);
    ASSERT_NE(bench.node.heater_output(0), 0u);
  }
  std::int64_t refused() { return bench.read({0x2244, 0}).value_or(0); }

  HeatNodeBench bench;
  std::optional<VoucherWriter> master;
};

TEST_F(HeatSession, TheMasterHeatsAndNobodyElseAlsoFromCold) {
  EXPECT_EQ(bench.read({0x2117, 5}), 1u);
  EXPECT_EQ(bench.write_set_point(1, 1500), kDeviceState);
  bench.send(set_points(1500));
  EXPECT_EQ(bench.write({0x2224, 1}, 1000, 2), kDeviceState) << "tuning";
  run(1);
  EXPECT_EQ(bench.node.heater_output(0), 0u);
  EXPECT_EQ(bench.read({0x7402, 1}), 0u);
  EXPECT_EQ(refused(), 3);
  vouched(set_points(1500));
  run(1);
  EXPECT_NE(bench.node.heater_output(0), 0u);
}

TEST_F(HeatSession, WhileItHeatsNobodyElseWritesNorCommandsAndEachIsToldOnce) {
  heat();
  bench.forget();
  for (const CanFrame& order :
       {writing({0x7402, 1}, 2500, 2), writing({0x2211, 1}, 3000, 2), writing({0x2243, 0}, 1, 4),
        writing({0x6422, 1}, 0, 1), writing({0x1400, 1}, 0x80000214, 4), writing({0x2117, 5}, 0, 1)}) {
    const std::size_t before = bench.seen.size();
    bench.send(order);
    ASSERT_GT(bench.seen.size(), before);
    const auto reply =
        std::find_if(bench.seen.begin() + static_cast<std::ptrdiff_t>(before), bench.seen.end(),
                     [](const CanFrame& f) { return f.id == 0x580u + HeatNodeBench::kId; });
    ASSERT_NE(reply, bench.seen.end());
    EXPECT_EQ(get_u32_le(std::span(reply->data).subspan(4)), kDeviceState);
  }
  bench.send(set_points(2500));
  for (const NmtCommand command : {NmtCommand::kStop, NmtCommand::kEnterPreOperational,
                                   NmtCommand::kResetNode, NmtCommand::kResetCommunication})
    bench.nmt(command);
  run(1);
  EXPECT_EQ(bench.node.nmt_state(), NmtState::kOperational);
  EXPECT_EQ(bench.read({0x7402, 1}), 2000u);
  EXPECT_NE(bench.node.heater_output(0), 0u);
  EXPECT_EQ(refused(), 11);
  EXPECT_EQ(bench.emergencies(node_emcy::kNotVouched).size(), 11u) << "6 by SDO, RPDO1, 4 by NMT";
}

TEST_F(HeatSession, LssIsNotHeardWhileItHeats) {
  heat();
  for (const char* frame : {"7E5#0401000000000000", "7E5#1109000000000000", "7E5#1700000000000000"})
    bench.send(parse_frame(frame).value());
  run(0.5);
  EXPECT_FALSE(bench.node.take_reset_request());
  EXPECT_TRUE(bench.node.image_to_store().empty());
  EXPECT_NE(bench.node.heater_output(0), 0u);
}

TEST_F(HeatSession, RecordedOrdersAreRefusedAlsoWithTheirVouchers) {
  const CanFrame order = writing({0x7402, 1}, 2300, 2);
  const CanFrame voucher = master->vouch_for(order);
  bench.send(voucher);
  bench.send(order);
  run(0.5);
  vouched(writing({0x7402, 1}, 1800, 2));
  bench.send(voucher);
  bench.send(order);
  EXPECT_EQ(bench.read({0x7402, 1}), 1800u);
  EXPECT_EQ(refused(), 1);
}

TEST_F(HeatSession, WhoeverAsksForHeatToGoOffGetsIt) {
  heat();
  EXPECT_EQ(bench.write_set_point(1, 0), 0u);
  EXPECT_EQ(bench.node.heater_output(0), 0u);
  heat();
  bench.send(set_points(0));
  EXPECT_EQ(bench.node.heater_output(0), 0u);
  EXPECT_EQ(refused(), 0);
}

TEST_F(HeatSession, ANewKeyWhileItHeatsIsTakenOfWhoHoldsTheOld) {
  heat();
  begin_session(2);
  vouched(writing({0x7402, 1}, 1900, 2));
  EXPECT_EQ(bench.read({0x7402, 1}), 1900u);
  EXPECT_EQ(refused(), 0);
}

// A gateway that stood still for a while need not be brought up again.
TEST_F(HeatSession, AfterASilenceOfSyncTheMastersNextVoucherClosesItAndWhatWasObeyedIsTold) {
  heat();
  bench.run(0.5);
  EXPECT_EQ(bench.read({0x2117, 5}), 0u);
  EXPECT_EQ(bench.write_set_point(1, 1700), 0u);
  bench.forget();
  run(0.1);
  vouched(encode(SyncStamp{.counter = 1, .epoch = 1, .time = BusTime{5}}));
  EXPECT_EQ(bench.read({0x2117, 5}), 1u);
  ASSERT_EQ(bench.emergencies(node_emcy::kNotVouched).size(), 1u);
  EXPECT_EQ(bench.write_set_point(1, 1800), kDeviceState);
  EXPECT_EQ(bench.read({0x7402, 1}), 1700u);
}

TEST_F(HeatSession, TheSilenceOfSyncAndAResetEndIt) {
  heat();
  bench.run(0.3);
  EXPECT_EQ(bench.read({0x2117, 5}), 1u);
  bench.run(0.2);
  EXPECT_EQ(bench.read({0x2117, 5}), 0u);
  EXPECT_NE(bench.node.heater_output(0), 0u) << "who comes back finds it warm";
  EXPECT_EQ(bench.write_set_point(1, 1700), 0u);
  master.reset();
  begin_session(3);
  EXPECT_EQ(bench.read({0x2117, 5}), 1u);
  ASSERT_EQ(bench.write_set_point(1, 0), 0u);
  run(0.1);
  bench.nmt(NmtCommand::kResetCommunication);
  EXPECT_EQ(bench.read({0x2117, 5}), 0u);
}

}  // namespace
}  // namespace kinebus::heat
