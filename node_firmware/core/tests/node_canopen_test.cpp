// The node as any CANopen master sees it.

#include "node_firmware/core/tests/node_bench.hpp"

namespace kinebus::testing_bench {
namespace {

enum Direction { To, From };
struct Line {
  Direction direction;
  std::string_view text;
};

/// Sends what goes To the node and expects exactly what comes From it, in order, heartbeats and PDOs aside.
void expect_exchange(Node& node, LocalTime& now, std::initializer_list<Line> lines) {
  for (const Line& line : lines) {
    now += 1ms;
    if (line.direction == To) {
      node.on_frame(now, frame_of(line.text));
      continue;
    }
    std::string got = "nothing";
    for (int i = 0; i < 10 && got == "nothing"; ++i)
      if (const auto frame = node.next_frame();
          frame && frame->id < 0x700 && (frame->id < 0x180 || frame->id >= 0x580))
        got = text_of(*frame);
    EXPECT_EQ(got, line.text);
  }
}

struct OneNode : testing::Test {
  OneNode() : node({.identity = {.serial = 7}, .node_id = 1}, now) {
    while (node.next_frame()) {
    }
  }
  LocalTime now{1s};
  LoneNode node;
};

TEST(NodeBoot, TellsWhyTheProgramBeforeItEnded) {
  LocalTime now{0};
  struct Case {
    ResetReport reset;
    std::string_view emergency;
  };
  for (const Case& c :
       {Case{{.cause = ResetCause::kSoftware, .reason = 3, .pc = 0x0802'1234}, "081#0061010004030000"},
        Case{{.cause = ResetCause::kWatchdog}, "081#0061010003000000"},
        Case{{.cause = ResetCause::kBrownOut}, "081#2032050002000000"},
        Case{{.cause = ResetCause::kPowerOn}, ""}, Case{{.cause = ResetCause::kSoftware}, ""},
        Case{{.cause = ResetCause::kResetPin}, ""}}) {
    LoneNode node({.node_id = 1, .reset = c.reset}, now);
    EXPECT_EQ(text_of(*node.next_frame()), "701#00");
    const auto next = node.next_frame();  // else the first heartbeat
    const bool told = next && next->id == 0x081;
    EXPECT_EQ(told ? text_of(*next) : "", c.emergency);
    if (told) {
      EXPECT_EQ(text_of(*node.next_frame()), "081#0000000000000000") << "it is over";
    }
    expect_exchange(node, now,
                    {{To, "601#4021210300000000"},
                     {From, c.reset.pc != 0 ? "581#4321210334120208" : "581#4321210300000000"}});
    node.on_frame(now, frame_of("601#4003100000000000"));
    EXPECT_EQ(node.next_frame()->data[4], told ? 1 : 0) << "1003h";
  }
}

TEST(NodeBoot, TellsBootUpThenHeartbeats) {
  LocalTime now{0};
  LoneNode node({.node_id = 5}, now);
  EXPECT_EQ(text_of(*node.next_frame()), "705#00");
  EXPECT_EQ(text_of(*node.next_frame()), "705#7F");
  EXPECT_FALSE(node.next_frame());
  node.on_frame(now, frame_of("000#0105"));
  now = 500ms;
  node.on_time(now);
  std::vector<std::string> sent;
  while (const auto frame = node.next_frame()) sent.push_back(text_of(*frame));
  EXPECT_NE(std::find(sent.begin(), sent.end(), "705#05"), sent.end());
}

TEST_F(OneNode, ComesToOperationEnabledBySdoAlone) {
  expect_exchange(
      node, now,
      {{To, "601#4000100000000000"}, {From, "581#430010009201FFFF"},  // device type
       {To, "601#4018100400000000"}, {From, "581#4318100407000000"},  // serial number
       {To, "601#4041600000000000"}, {From, "581#4B41600050020000"},  // switch on disabled
       {To, "601#2F60600001000000"}, {From, "581#6060600000000000"},  // profile position
       {To, "601#4061600000000000"}, {From, "581#4F61600001000000"},
       {To, "601#2B40600006000000"}, {From, "581#6040600000000000"},
       {To, "601#4041600000000000"}, {From, "581#4B41600031060000"},  // ready to switch on
       {To, "601#2B40600007000000"}, {From, "581#6040600000000000"},
       {To, "601#4041600000000000"}, {From, "581#4B41600033060000"},  // switched on
       {To, "601#2B4060000F000000"}, {From, "581#6040600000000000"},
       {To, "601#4041600000000000"}, {From, "581#4B41600037060000"},    // operation enabled
       {To, "601#4041680000000000"}, {From, "581#4B41680050020000"}});  // the other axis is as it was
  EXPECT_TRUE(node.drive(0).power);
  EXPECT_FALSE(node.drive(1).power);
}

TEST_F(OneNode, RefusesWhatItCannotDoWithTheRightAbortCode) {
  expect_exchange(node, now,
                  {{To, "601#4000200000000000"},
                   {From, "581#8000200000000206"},  // no such object
                   {To, "601#2F60600009000000"},
                   {From, "581#8060600030000906"},  // no such mode
                   {To, "601#2F98600001000000"},
                   {From, "581#8098600030000906"},  // no such homing method
                   {To, "601#2B41600000000000"},
                   {From, "581#8041600002000106"},  // read only
                   {To, "601#2310100100000000"},
                   {From, "581#8010100120000008"}});  // not "save"
}

TEST_F(OneNode, RemapsATpdoAndSendsItOnSync) {
  expect_exchange(node, now,
                  {{To, "601#23021801810300C0"},
                   {From, "581#6002180100000000"},
                   {To, "601#2F021A0000000000"},
                   {From, "581#60021A0000000000"},
                   {To, "601#23021A0120006460"},
                   {From, "581#60021A0100000000"},
                   {To, "601#2F021A0001000000"},
                   {From, "581#60021A0000000000"},
                   {To, "601#2F02180201000000"},
                   {From, "581#6002180200000000"},
                   {To, "601#2302180181030040"},
                   {From, "581#6002180100000000"},
                   {To, "000#0101"}});
  while (node.next_frame()) {
  }
  node.on_frame(now, frame_of("080#"));
  EXPECT_EQ(text_of(*node.next_frame()), "381#00000000");
}

TEST_F(OneNode, StatuswordTpdoComesWhenItChanges) {
  node.on_frame(now, frame_of("000#0101"));
  now += 20ms;
  node.on_time(now);
  while (node.next_frame()) {
  }
  node.on_frame(now, frame_of("201#060000000000"));
  now += 20ms;
  node.on_time(now);
  const auto frame = node.next_frame();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->id, 0x181u);
  EXPECT_EQ(get_u16_le(frame->data) & 0x6F, 0x21);
}

TEST_F(OneNode, StoresParametersAndLoadsThemWhenItStartsAgain) {
  node.on_frame(now, frame_of("601#23816000A0860100"));  // profile velocity 100,000, not what it comes with
  while (node.next_frame()) {
  }
  node.on_frame(now, frame_of("601#2310100173617665"));
  EXPECT_FALSE(node.next_frame());  // the answer waits for the memory
  const auto image = node.image_to_store();
  ASSERT_FALSE(image.empty());
  const std::vector<std::uint8_t> kept(image.begin(), image.end());
  node.on_image_stored(true);
  EXPECT_EQ(text_of(*node.next_frame()), "581#6010100100000000");

  LoneNode again({.node_id = 1}, now, kept);
  while (again.next_frame()) {
  }
  again.on_frame(now, frame_of("601#4081600000000000"));
  EXPECT_EQ(text_of(*again.next_frame()), "581#43816000A0860100");

  // A failing memory is said so.
  node.on_frame(now, frame_of("601#2310100173617665"));
  EXPECT_FALSE(node.image_to_store().empty());
  node.on_image_stored(false);
  std::vector<std::string> sent;
  while (const auto frame = node.next_frame()) sent.push_back(text_of(*frame));
  EXPECT_EQ(sent.front().substr(0, 8), "081#3055");
  EXPECT_EQ(sent.back(), "581#8010100100000606");
}

TEST_F(OneNode, DamagedStorageMeansDefaultsAndAnEmergency) {
  node.on_frame(now, frame_of("601#2381600000E80300"));
  node.on_frame(now, frame_of("601#2310100173617665"));
  const auto image = node.image_to_store();
  std::vector<std::uint8_t> kept(image.begin(), image.end());
  for (const std::size_t place : {std::size_t{0}, std::size_t{6}, kept.size() / 2, kept.size() - 1}) {
    std::vector<std::uint8_t> damaged = kept;
    damaged[place] ^= 0x10;
    LoneNode again({.node_id = 1}, now, damaged);
    bool told = false;
    while (const auto frame = again.next_frame()) told = told || text_of(*frame).substr(0, 8) == "081#3055";
    EXPECT_TRUE(told) << place;
    again.on_frame(now, frame_of("601#4081600000000000"));
    EXPECT_EQ(text_of(*again.next_frame()), "581#4381600000F40100") << place;
  }
  for (std::size_t length = 0; length < kept.size(); length += 7)
    LoneNode(NodeOptions{.node_id = 1}, now, std::span(kept).first(length));
}

TEST_F(OneNode, RestoreBringsTheDefaultsBackAtTheNextReset) {
  node.on_frame(now, frame_of("601#2381600000E80300"));
  node.on_frame(now, frame_of("601#231110016C6F6164"));
  EXPECT_FALSE(node.image_to_store().empty());
  node.on_image_stored(true);
  node.on_frame(now, frame_of("000#8101"));
  EXPECT_TRUE(node.take_reset_request());
  while (node.next_frame()) {
  }
  expect_exchange(node, now, {{To, "601#4081600000000000"}, {From, "581#4381600000F40100"}});
}

TEST_F(OneNode, NothingIsStoredWhileAnAxisHasPower) {
  node.on_frame(now, frame_of("000#0101"));
  for (const char* word : {"601#2B40600006000000", "601#2B40600007000000"})
    node.on_frame(now, frame_of(word));
  ASSERT_TRUE(node.powered());
  while (node.next_frame()) {
  }
  expect_exchange(node, now,
                  {{To, "601#2310100173617665"},
                   {From, "581#8010100122000008"},
                   {To, "601#231110016C6F6164"},
                   {From, "581#8011100122000008"}});
  node.on_frame(now, frame_of("7E5#0401000000000000"));
  node.on_frame(now, frame_of("7E5#1700000000000000"));
  EXPECT_EQ(text_of(*node.next_frame()), "7E4#17FF010000000000");
  EXPECT_TRUE(node.image_to_store().empty());
}

TEST_F(OneNode, PowerThatComesBeforeTheMemoryIsWrittenComesFirst) {
  node.on_frame(now, frame_of("601#2310100173617665"));
  node.on_frame(now, frame_of("7E5#0401000000000000"));
  node.on_frame(now, frame_of("7E5#1700000000000000"));
  node.on_frame(now, frame_of("000#0101"));
  for (const char* word : {"201#0600", "201#0700"})
    node.on_frame(now, frame_of(std::string(word) + "00000000"));
  ASSERT_TRUE(node.powered());
  EXPECT_TRUE(node.image_to_store().empty());
  std::vector<std::string> sent;
  while (const auto frame = node.next_frame()) sent.push_back(text_of(*frame));
  for (const char* told : {"581#8010100122000008", "7E4#17FF010000000000"})
    EXPECT_EQ(std::count(sent.begin(), sent.end(), told), 1) << told;
}

TEST(NodeLss, AnUnconfiguredNodeGetsItsIdOverTheBusAndKeepsIt) {
  LocalTime now{0};
  LoneNode node({.identity = {.serial = 0x1234}}, now);
  EXPECT_FALSE(node.next_frame());
  node.on_frame(now, frame_of("7E5#0401000000000000"));  // all to configuration
  node.on_frame(now, frame_of("7E5#1104000000000000"));  // node id 4
  EXPECT_EQ(text_of(*node.next_frame()), "7E4#1100000000000000");
  node.on_frame(now, frame_of("7E5#1700000000000000"));  // store
  EXPECT_FALSE(node.next_frame());
  const auto image = node.image_to_store();
  ASSERT_FALSE(image.empty());
  const std::vector<std::uint8_t> kept(image.begin(), image.end());
  node.on_image_stored(true);
  EXPECT_EQ(text_of(*node.next_frame()), "7E4#1700000000000000");
  node.on_frame(now, frame_of("7E5#0400000000000000"));  // back to waiting: it boots
  EXPECT_EQ(text_of(*node.next_frame()), "704#00");
  EXPECT_EQ(node.node_id(), 4);

  LoneNode again({.identity = {.serial = 0x1234}}, now, kept);
  EXPECT_EQ(text_of(*again.next_frame()), "704#00");
}

TEST_F(OneNode, EqualConfigurationsHaveEqualFingerprintsWhateverTheNodeId) {
  LoneNode other({.node_id = 9}, now);
  while (other.next_frame()) {
  }
  node.on_frame(now, frame_of("601#4016210000000000"));
  other.on_frame(now, frame_of("609#4016210000000000"));
  const auto mine = node.next_frame(), theirs = other.next_frame();
  ASSERT_TRUE(mine && theirs);
  EXPECT_EQ(mine->data, theirs->data);
  node.on_frame(now, frame_of("601#2381600001000000"));
  while (node.next_frame()) {
  }
  node.on_frame(now, frame_of("601#4016210000000000"));
  EXPECT_NE(node.next_frame()->data, theirs->data);
}

TEST_F(OneNode, TheWatchdogIsNotFedWhenServiceIsLate) {
  EXPECT_TRUE(node.healthy(now));
  now = node.next_deadline() + 1s;
  EXPECT_FALSE(node.healthy(now));
  node.on_time(now);
  while (node.next_frame()) {
  }
  EXPECT_TRUE(node.healthy(now));
}

}  // namespace
}  // namespace kinebus::testing_bench
