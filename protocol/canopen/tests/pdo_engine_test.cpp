#include "protocol/canopen/pdo_engine.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "protocol/can/candump.hpp"
#include "protocol/canopen/emcy.hpp"
#include "protocol/canopen/sdo_server.hpp"

namespace kinebus {
namespace {

using std::chrono::milliseconds;

/// A node of nothing but dictionary, SDO server and PDOs.
struct Bench : ObjectOwner {
  NodeDictionary objects{*this, 1};
  PdoEngine pdos{objects};
  SdoServer server{objects};
  std::map<std::uint32_t, std::int64_t> live;
  std::vector<std::pair<std::uint32_t, std::int64_t>> written;
  std::uint32_t never = 0;  ///< an object that takes nothing
  LocalTime now{0};

  Bench() {
    server.reset(1);
    pdos.configure();
  }
  AbortCode read(const ObjectEntry& entry, std::int64_t& value) override {
    value = live[entry.address.key()];
    return AbortCode::kNone;
  }
  AbortCode write(const ObjectEntry& entry, std::int64_t value) override {
    if (PdoEngine::owns(entry.address)) return pdos.accept(entry, value);
    written.emplace_back(entry.address.key(), value);
    return AbortCode::kNone;
  }
  AbortCode check(const ObjectEntry& entry, std::int64_t) const override {
    return entry.address.key() == never ? AbortCode::kInvalidValue : AbortCode::kNone;
  }
  void sdo(const char* request, const char* reply) {
    server.on_frame(now, parse_frame(request).value());
    const auto answer = server.next_frame();
    ASSERT_TRUE(answer) << request;
    EXPECT_EQ(to_text(*answer).view(), reply) << "after " << request;
  }
  PdoEngine::Reception receive(const char* frame) { return pdos.on_frame(now, parse_frame(frame).value()); }
  std::vector<std::string> sent() {
    std::vector<std::string> all;
    pdos.on_time(now);
    while (const auto frame = pdos.next_frame(now)) all.emplace_back(to_text(*frame).view());
    return all;
  }
  void operate() {
    pdos.set_operational(true, now);
    sent();
  }
  std::int64_t value(ObjectAddress address) {
    return objects.value(kNodeTable[find_object(address)].value_slot());
  }
};
using Frames = std::vector<std::string>;

TEST(PdoEngine, ControlwordsOfBothAxesComeByRpdoOne) {
  Bench b;
  EXPECT_EQ(b.receive("201#0F000600010A"), PdoEngine::Reception::kNotMine) << "not operational yet";
  b.operate();
  EXPECT_EQ(b.receive("201#0F00060001F8"), PdoEngine::Reception::kWritten);
  EXPECT_EQ(b.value({0x6040, 0}), 0x0F);
  EXPECT_EQ(b.value({0x6840, 0}), 0x06);
  EXPECT_EQ(b.value({0x6060, 0}), 1);
  EXPECT_EQ(b.value({0x6860, 0}), -8);
}

TEST(PdoEngine, BroadcastsAndSegmentsReachTheOwner) {
  Bench b;
  b.operate();
  EXPECT_EQ(b.receive("401#8877665544332211"), PdoEngine::Reception::kWritten);
  EXPECT_EQ(b.receive("1FF#0102030405060708"), PdoEngine::Reception::kWritten);
  EXPECT_EQ(b.receive("402#0102030405060708"), PdoEngine::Reception::kNotMine);
  ASSERT_EQ(b.written.size(), 2u);
  EXPECT_EQ(b.written[0], std::pair(object::kSegmentRecord.key(), std::int64_t{0x1122334455667788}));
  EXPECT_EQ(b.written[1].first, object::kRateCommand.key());
}

TEST(PdoEngine, SynchronousRpdoWaitsForSync) {
  Bench b;
  b.operate();
  EXPECT_EQ(b.receive("301#0A00000014000000"), PdoEngine::Reception::kAwaitsSync);
  EXPECT_EQ(b.value({0x607A, 0}), 0);
  b.pdos.on_sync(b.now, 1);
  EXPECT_EQ(b.value({0x607A, 0}), 10);
  EXPECT_EQ(b.value({0x687A, 0}), 20);
}

TEST(PdoEngine, WrongLengthsAreTold) {
  Bench b;
  b.operate();
  EXPECT_EQ(b.receive("201#0F0006"), PdoEngine::Reception::kRefused);
  EXPECT_EQ(b.value({0x6040, 0}), 0);
  EXPECT_EQ(b.receive("201#0F00060001010000"), PdoEngine::Reception::kWritten);
  EXPECT_EQ(b.pdos.next_problem()->emcy_code, emcy::kPdoTooShort);
  const auto second = b.pdos.next_problem();
  EXPECT_EQ(second->emcy_code, emcy::kPdoTooLong);
  EXPECT_EQ(second->rpdo, 1);
  EXPECT_FALSE(b.pdos.next_problem());
}

TEST(PdoEngine, StatusIsSentOnChangeWithInhibitAndEventTime) {
  Bench b;
  b.live[object::kStatusword.key()] = 0x0250;
  b.pdos.set_operational(true, b.now);
  const Frames entry = b.sent();
  EXPECT_EQ(entry.front(), "181#50020000000000");
  EXPECT_EQ(b.sent(), Frames{});
  b.now += milliseconds{3};
  b.live[object::kStatusword.key()] = 0x0231;
  EXPECT_EQ(b.sent(), Frames{}) << "inhibit time is 10 ms";
  EXPECT_EQ(b.pdos.next_deadline(), LocalTime{milliseconds{10}});
  b.now = milliseconds{10};
  EXPECT_EQ(b.sent(), Frames{"181#31020000000000"});
  b.now = milliseconds{30};
  EXPECT_EQ(b.sent(), Frames{});
  EXPECT_EQ(b.pdos.next_deadline(), LocalTime{milliseconds{1010}});
  b.now = milliseconds{1010};
  EXPECT_EQ(b.sent(), Frames{"181#31020000000000"}) << "event timer";
}

TEST(PdoEngine, StreamStatusIsSentWhenTriggered) {
  Bench b;
  b.operate();
  b.now = milliseconds{100};
  b.live[object::kStreamStatus.key()] = 0x42;
  EXPECT_EQ(b.sent(), Frames{});
  b.pdos.trigger(2);
  EXPECT_EQ(b.sent(), Frames{"281#4200000000000000"});
  b.pdos.trigger(2);
  EXPECT_EQ(b.sent(), Frames{}) << "inhibit time is 2 ms";
  b.now += milliseconds{2};
  EXPECT_EQ(b.sent(), Frames{"281#4200000000000000"});
}

TEST(PdoEngine, IsRemappedAsCiaSays) {
  Bench b;
  b.sdo("601#2F001A0000000000", "581#80001A0000000106");  // while valid: unsupported access
  b.sdo("601#23001801810100C0", "581#6000180100000000");  // off
  b.sdo("601#23001A0110006460", "581#80001A0100000106");  // count is not 0 yet
  b.sdo("601#2F001A0000000000", "581#60001A0000000000");
  b.sdo("601#23001A0120006460", "581#60001A0100000000");  // 6064h, 32 bits
  b.sdo("601#23001A0210004160", "581#60001A0200000000");
  b.sdo("601#2F001A0002000000", "581#60001A0000000000");
  b.sdo("601#2F00180201000000", "581#6000180200000000");  // every SYNC
  b.sdo("601#2300180181010040", "581#6000180100000000");
  b.live[object::kPositionActual.key()] = -2;
  b.live[object::kStatusword.key()] = 0x237;
  b.operate();
  b.pdos.on_sync(b.now, 1);
  EXPECT_EQ(b.sent(), Frames{"181#FEFFFFFF3702"});
}

TEST(PdoEngine, RefusesMappingsThatCannotBe) {
  Bench b;
  b.sdo("601#2300140101020080", "581#6000140100000000");
  b.sdo("601#2F00160000000000", "581#6000160000000000");
  b.sdo("601#2300160110004160", "581#8000160141000406");  // statusword is no RPDO's
  b.sdo("601#2300160108004060", "581#8000160141000406");  // wrong length
  b.sdo("601#2300160110000050", "581#8000160100000206");  // no such object
  b.sdo("601#2300160110051860", "581#8000160100000206");
  b.sdo("601#2300160110094060", "581#8000160111000906");  // no such subindex
  for (const char* object : {"01", "02"})
    b.sdo((std::string("601#230016") + object + "40000021").c_str(),
          (std::string("581#600016") + object + "00000000").c_str());
  b.sdo("601#2F00160002000000", "581#8000160042000406");  // 16 bytes
  b.sdo("601#2F00160009000000", "581#8000160031000906");
  b.sdo("601#2300160108000500", "581#6000160100000000");  // dummy u8
  b.sdo("601#2300160210004060", "581#6000160200000000");
  b.sdo("601#2F00160002000000", "581#6000160000000000");
  b.sdo("601#2300140101020000", "581#6000140100000000");
  b.operate();
  EXPECT_EQ(b.receive("201#AA0F00"), PdoEngine::Reception::kWritten);
  EXPECT_EQ(b.value({0x6040, 0}), 0x0F);
}

TEST(PdoEngine, CommunicationParametersAreChecked) {
  Bench b;
  b.sdo("601#2300140101030000", "581#8000140130000906");  // other id while valid
  b.sdo("601#2300140101020080", "581#6000140100000000");
  b.sdo("601#2300140181050000", "581#8000140130000906");  // an SDO's id
  b.sdo("601#2300140101020020", "581#8000140130000906");  // extended
  b.sdo("601#2F001402FC000000", "581#8000140230000906");  // RTR only
  b.sdo("601#2F001402F1000000", "581#8000140230000906");  // reserved
  b.sdo("601#2F001402F0000000", "581#6000140200000000");
  b.sdo("601#2B0018030A000000", "581#8000180300000106");  // inhibit time while valid
  b.sdo("601#2300180181010080", "581#8000180130000906");  // for remote frames, which nobody answers here
}

TEST(PdoEngine, SynchronousTpdoCountsFromItsStartValue) {
  Bench b;
  b.sdo("601#23011801810200C0", "581#6001180100000000");
  b.sdo("601#2F01180203000000", "581#6001180200000000");
  b.sdo("601#2F01180605000000", "581#6001180600000000");
  b.sdo("601#2301180181020040", "581#6001180100000000");
  b.operate();
  std::string when;
  for (int counter = 1; counter <= 14; ++counter) {
    b.pdos.on_sync(b.now, static_cast<std::uint8_t>(counter));
    if (!b.sent().empty()) when += std::to_string(counter) + " ";
  }
  EXPECT_EQ(when, "5 8 11 14 ");
}

TEST(PdoEngine, AcyclicSynchronousTpdoNeedsAnEvent) {
  Bench b;
  b.sdo("601#2F01180200000000", "581#6001180200000000");
  b.operate();
  EXPECT_EQ(b.sent(), Frames{});
  b.pdos.on_sync(b.now, 1);
  EXPECT_EQ(b.sent().size(), 1u) << "how it stands, once";
  b.pdos.on_sync(b.now, 2);
  EXPECT_EQ(b.sent(), Frames{});
  b.pdos.trigger(2);
  EXPECT_EQ(b.sent(), Frames{});
  b.pdos.on_sync(b.now, 3);
  EXPECT_EQ(b.sent().size(), 1u);
  b.live[object::kStreamStatus.key()] = 7;
  EXPECT_EQ(b.sent(), Frames{}) << "not before SYNC";
  b.pdos.on_sync(b.now, 4);
  EXPECT_EQ(b.sent(), Frames{"281#0700000000000000"});
  b.pdos.on_sync(b.now, 5);
  EXPECT_EQ(b.sent(), Frames{});
}

TEST(PdoEngine, OneValueThatIsRefusedTakesTheWholePdoWithIt) {
  Bench b;
  b.never = object::kModeOfOperation.key();
  b.operate();
  EXPECT_EQ(b.receive("201#0F0006000108"), PdoEngine::Reception::kRefused);
  EXPECT_EQ(b.value(object::kControlword), 0);
  EXPECT_EQ(b.value({0x6860, 0}), 0);
  EXPECT_TRUE(b.written.empty());
  const auto told = b.pdos.next_problem();
  ASSERT_TRUE(told);
  EXPECT_EQ(told->emcy_code, emcy::kPdoRefused);
  EXPECT_EQ(told->rpdo, 1);
  EXPECT_EQ(told->object, object::kModeOfOperation);
  EXPECT_FALSE(b.pdos.next_problem());
}

TEST(PdoEngine, RpdoTimeoutIsToldOnce) {
  Bench b;
  b.sdo("601#2B00140532000000", "581#6000140500000000");
  b.operate();
  b.now = milliseconds{200};
  b.sent();
  EXPECT_FALSE(b.pdos.next_problem()) << "watched from the first PDO on";
  b.receive("201#000000000000");
  EXPECT_EQ(b.pdos.next_deadline(), LocalTime{milliseconds{250}});
  b.now = milliseconds{250};
  b.sent();
  EXPECT_EQ(b.pdos.next_problem()->emcy_code, emcy::kRpdoTimeout);
  b.now = milliseconds{900};
  b.sent();
  EXPECT_FALSE(b.pdos.next_problem());
}

}  // namespace
}  // namespace kinebus
