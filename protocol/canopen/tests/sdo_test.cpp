// Server and client, each against recorded exchanges (CiA 301's own examples of each protocol) and against
// each other over a bus that loses frames.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "protocol/can/candump.hpp"
#include "protocol/canopen/sdo_client.hpp"
#include "protocol/canopen/sdo_server.hpp"

namespace kinebus {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// Byte strings by address.
class Memory : public SdoObjects {
 public:
  AbortCode sdo_read(ObjectAddress address, std::uint32_t offset, std::span<std::uint8_t> out,
                     std::uint32_t& total) override {
    const auto found = values.find(address.key());
    if (found == values.end()) return AbortCode::kNoObject;
    total = static_cast<std::uint32_t>(found->second.size());
    for (std::size_t i = 0; i < out.size() && offset + i < total; ++i) out[i] = found->second[offset + i];
    return AbortCode::kNone;
  }
  AbortCode sdo_write(ObjectAddress address, std::uint32_t offset, std::span<const std::uint8_t> bytes,
                      bool last) override {
    if (refusal != AbortCode::kNone) return refusal;
    auto& value = incoming;
    if (offset == 0) value.clear();
    EXPECT_EQ(offset, value.size());
    value.insert(value.end(), bytes.begin(), bytes.end());
    if (last) values[address.key()] = value;
    if (last && server != nullptr) server->defer();
    return AbortCode::kNone;
  }
  std::vector<std::uint8_t>& at(std::uint16_t index) { return values[ObjectAddress{index, 0}.key()]; }
  std::map<std::uint32_t, std::vector<std::uint8_t>> values;
  std::vector<std::uint8_t> incoming;
  AbortCode refusal = AbortCode::kNone;
  SdoServer* server = nullptr;
};

struct ServerBench {
  Memory memory;
  SdoServer server{memory};
  LocalTime now{0};
  ServerBench() { server.reset(1); }

  /// Sends `request` and compares all that comes back, in order.
  void exchange(const char* request, std::vector<const char*> replies) {
    server.on_frame(now, parse_frame(request).value());
    expect(replies, request);
  }
  void expect(const std::vector<const char*>& replies, const char* what) {
    std::vector<std::string> got;
    while (const auto frame = server.next_frame()) got.emplace_back(to_text(*frame).view());
    EXPECT_EQ(got, std::vector<std::string>(replies.begin(), replies.end())) << "after " << what;
  }
};

std::vector<std::uint8_t> bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}

TEST(SdoServer, ExpeditedTransfers) {
  ServerBench b;
  b.memory.at(0x6041) = {0x37, 0x02};
  b.exchange("601#4041600000000000", {"581#4B41600037020000"});
  b.exchange("601#2B4060000F000000", {"581#6040600000000000"});
  EXPECT_EQ(b.memory.at(0x6040), (std::vector<std::uint8_t>{0x0F, 0x00}));
  b.exchange("601#237A600078563412", {"581#607A600000000000"});
  b.exchange("601#4034120500000000", {"581#8034120500000206"});
}

TEST(SdoServer, SegmentedUpload) {
  ServerBench b;
  b.memory.at(0x1008) = bytes_of("Kinebus node");
  b.exchange("601#4008100000000000", {"581#410810000C000000"});
  b.exchange("601#6000000000000000", {"581#004B696E65627573"});
  b.exchange("601#7000000000000000", {"581#15206E6F64650000"});
  EXPECT_FALSE(b.server.busy());
}

TEST(SdoServer, SegmentedDownload) {
  ServerBench b;
  b.exchange("601#2100210008000000", {"581#6000210000000000"});
  b.exchange("601#0001020304050607", {"581#2000000000000000"});
  b.exchange("601#1D08000000000000", {"581#3000000000000000"});
  EXPECT_EQ(b.memory.at(0x2100), (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(SdoServer, SegmentErrorsAreAborted) {
  ServerBench b;
  b.exchange("601#2100210008000000", {"581#6000210000000000"});
  b.exchange("601#1001020304050607", {"581#8000210000000305"});  // toggle
  b.exchange("601#2100210003000000", {"581#6000210000000000"});
  b.exchange("601#0101020304050607", {"581#8000210012000706"});  // longer than announced
  b.exchange("601#2100210009000000", {"581#6000210000000000"});
  b.exchange("601#0101020304050607", {"581#8000210013000706"});  // shorter
  b.exchange("601#6000000000000000", {"581#8000210001000405"});  // segment without a transfer
  b.exchange("601#E000000000000000", {"581#8000000001000405"});  // no such command
  EXPECT_EQ(b.server.counters().aborts_sent, 5u);
}

TEST(SdoServer, BlockDownloadWithCrc) {
  ServerBench b;
  // "123456789" has CRC 31C3h.
  b.exchange("601#C600210009000000", {"581#A40021007F000000"});
  b.exchange("601#0131323334353637", {});
  b.exchange("601#8238390000000000", {"581#A2027F0000000000"});
  b.exchange("601#D5C3310000000000", {"581#A100000000000000"});
  EXPECT_EQ(b.memory.at(0x2100), bytes_of("123456789"));
  b.exchange("601#C600210009000000", {"581#A40021007F000000"});
  b.exchange("601#0131323334353637", {});
  b.exchange("601#8238390000000000", {"581#A2027F0000000000"});
  b.exchange("601#D5C4310000000000", {"581#8000210004000405"});
}

TEST(SdoServer, BlockDownloadAsksAgainAfterAGap) {
  ServerBench b;
  b.exchange("601#C600210015000000", {"581#A40021007F000000"});
  b.exchange("601#0131323334353637", {});
  b.exchange("601#8331323334353637", {"581#A2017F0000000000"});
  b.exchange("601#0131323334353637", {});
  b.exchange("601#8231323334353637", {"581#A2027F0000000000"});
}

TEST(SdoServer, BlockUploadWithCrc) {
  ServerBench b;
  b.memory.at(0x1008) = bytes_of("123456789");
  b.exchange("601#A408100010000000", {"581#C608100009000000"});
  b.exchange("601#A300000000000000", {"581#0131323334353637", "581#8238390000000000"});
  b.exchange("601#A201100000000000", {"581#8138390000000000"});  // the second was lost
  b.exchange("601#A201100000000000", {"581#D5C3310000000000"});
  b.exchange("601#A100000000000000", {});
  EXPECT_FALSE(b.server.busy());
  EXPECT_EQ(b.server.counters().transfers, 1u);
}

TEST(SdoServer, SmallBlockUploadSwitchesWhenTheClientAllows) {
  ServerBench b;
  b.memory.at(0x6041) = {0x37, 0x02};
  b.exchange("601#A441600010080000", {"581#4B41600037020000"});
}

TEST(SdoServer, SilenceEndsATransfer) {
  ServerBench b;
  b.exchange("601#2100210008000000", {"581#6000210000000000"});
  EXPECT_EQ(b.server.next_deadline(), LocalTime{seconds{1}});
  b.server.on_time(seconds{1});
  b.expect({"581#8000210000000405"}, "a second of silence");
  EXPECT_EQ(b.server.next_deadline(), LocalTime::max());
}

TEST(SdoServer, AClientsAbortAndANewRequestEndTheOldTransfer) {
  ServerBench b;
  b.memory.at(0x6041) = {0x37, 0x02};
  b.exchange("601#2100210008000000", {"581#6000210000000000"});
  b.exchange("601#8000210000000405", {});
  EXPECT_FALSE(b.server.busy());
  b.exchange("601#2100210008000000", {"581#6000210000000000"});
  b.exchange("601#4041600000000000", {"581#4B41600037020000"});
}

TEST(SdoServer, OthersFramesAndShortFramesAreNoRequests) {
  ServerBench b;
  b.exchange("602#4041600000000000", {});
  b.exchange("601#404160", {});
  b.exchange("601#R8", {});
  EXPECT_EQ(b.server.counters().malformed, 1u);
}

TEST(SdoServer, AnAnswerMayWaitForTheObjects) {
  ServerBench b;
  b.memory.server = &b.server;
  b.exchange("601#2310100173617665", {});
  EXPECT_TRUE(b.server.deferred());
  b.exchange("601#4041600000000000", {"581#8041600022000008"});
  b.server.on_time(seconds{100});
  b.server.finish(AbortCode::kNone);
  b.expect({"581#6010100100000000"}, "finish");
  b.exchange("601#2310100173617665", {});
  b.server.finish(AbortCode::kHardware);
  b.expect({"581#8010100100000606"}, "failed finish");
}

/// Client and server over a bus; `lose(i)`: the i-th frame never arrives.
struct Pair {
  Memory memory;
  SdoServer server{memory};
  SdoClient client;
  LocalTime now{0};
  long frames = 0;
  std::function<bool(long)> lose = [](long) { return false; };

  Pair() { server.reset(5); }
  void run() {
    for (int i = 0; i < 200'000 && client.status() == SdoClient::Status::kBusy; ++i) {
      bool moved = false;
      if (const auto frame = client.next_frame()) {
        moved = true;
        if (!lose(frames++)) server.on_frame(now, *frame);
      }
      if (const auto frame = server.next_frame()) {
        moved = true;
        if (!lose(frames++)) client.on_frame(now, *frame);
      }
      if (!moved) {
        now = std::min(client.next_deadline(), server.next_deadline());
        client.on_time(now);
        server.on_time(now);
      }
    }
    while (const auto frame = client.next_frame()) server.on_frame(now, *frame);
    while (server.next_frame()) {
    }
  }
};

std::vector<std::uint8_t> pattern(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> bytes(size);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

TEST(Sdo, AnyLengthTravelsBothWaysByAnyMethod) {
  for (const auto method :
       {SdoClient::Method::kAutomatic, SdoClient::Method::kSegmented, SdoClient::Method::kBlock}) {
    for (const std::size_t size :
         {1, 2, 3, 4, 5, 7, 8, 14, 63, 64, 65, 882, 888, 889, 890, 896, 897, 1778, 1779, 20'000}) {
      Pair p;
      const auto bytes = pattern(size, static_cast<unsigned>(size));
      ASSERT_TRUE(p.client.download(p.now, 5, {0x2100, 0}, bytes, method));
      p.run();
      ASSERT_EQ(p.client.status(), SdoClient::Status::kDone) << size << " " << text(p.client.abort_code());
      ASSERT_EQ(p.memory.at(0x2100), bytes) << size;
      std::vector<std::uint8_t> room(size + size % 3);
      ASSERT_TRUE(p.client.upload(p.now, 5, {0x2100, 0}, room, method));
      p.run();
      ASSERT_EQ(p.client.status(), SdoClient::Status::kDone) << size << " " << text(p.client.abort_code());
      room.resize(p.client.received());
      ASSERT_EQ(room, bytes) << size;
      EXPECT_FALSE(p.server.busy()) << size;
    }
  }
}

TEST(Sdo, TheServersRefusalReachesTheCaller) {
  Pair p;
  p.memory.refusal = AbortCode::kTooHigh;
  const auto bytes = pattern(2, 1);
  p.client.download(p.now, 5, {0x2113, 0}, bytes);
  p.run();
  EXPECT_EQ(p.client.status(), SdoClient::Status::kFailed);
  EXPECT_EQ(p.client.abort_code(), AbortCode::kTooHigh);
  std::vector<std::uint8_t> room(4);
  p.client.upload(p.now, 5, {0x9999, 0}, room);
  p.run();
  EXPECT_EQ(p.client.abort_code(), AbortCode::kNoObject);
}

TEST(Sdo, AValueLongerThanTheRoomIsRefused) {
  Pair p;
  p.memory.at(0x1008) = pattern(100, 3);
  for (const auto method : {SdoClient::Method::kSegmented, SdoClient::Method::kBlock}) {
    std::vector<std::uint8_t> room(99);
    p.client.upload(p.now, 5, {0x1008, 0}, room, method);
    p.run();
    EXPECT_EQ(p.client.abort_code(), AbortCode::kOutOfMemory);
    EXPECT_FALSE(p.server.busy());
  }
}

TEST(Sdo, ASilentServerIsATimeout) {
  Pair p;
  p.lose = [](long) { return true; };
  std::vector<std::uint8_t> room(4);
  p.client.upload(p.now, 5, {0x1008, 0}, room);
  p.run();
  EXPECT_EQ(p.client.abort_code(), AbortCode::kTimeout);
}

TEST(Sdo, LossEndsInTheRightBytesOrInAnErrorNeverInWrongBytes) {
  int good = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    Pair p;
    std::mt19937 random(seed);
    p.lose = [&](long) { return random() % 150 == 0; };
    const auto method = seed % 2 == 0 ? SdoClient::Method::kBlock : SdoClient::Method::kSegmented;
    const auto bytes = pattern(100 + random() % 900, seed);
    p.client.download(p.now, 5, {0x2100, 0}, bytes, method);
    p.run();
    if (p.client.status() == SdoClient::Status::kDone) {
      ++good;
      ASSERT_EQ(p.memory.at(0x2100), bytes) << "seed " << seed;
    }
    p.memory.at(0x2200) = bytes;
    std::vector<std::uint8_t> room(1100);
    p.client.upload(p.now, 5, {0x2200, 0}, room, method);
    p.run();
    if (p.client.status() == SdoClient::Status::kDone) {
      ++good;
      room.resize(p.client.received());
      ASSERT_EQ(room, bytes) << "seed " << seed;
    }
  }
  EXPECT_GT(good, 100);
}

}  // namespace
}  // namespace kinebus
