#include "tools/cli/message_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {
namespace {

TEST(MessageJson, HasEveryValueOfTheSchemaUnderItsName) {
  joblink::Status status;
  status.set_state(joblink::STATE_HELD);
  status.set_job("part \"1\".gcode");
  status.mutable_tool()->set_x_mm(1.5);
  status.mutable_counters()->set_frames_sent(1ULL << 60);
  auto& command = *status.add_commands();
  command.set_command(joblink::COMMAND_JOG);
  command.mutable_why_not()->set_text("cannot jog");
  const auto json = nlohmann::json::parse(to_json_text(status));
  EXPECT_EQ(json["state"], "STATE_HELD");
  EXPECT_EQ(json["job"], "part \"1\".gcode");
  EXPECT_EQ(json["tool"]["x_mm"], 1.5);
  EXPECT_EQ(json["counters"]["frames_sent"], "1152921504606846976") << "64 bits are text, as protobuf says";
  EXPECT_EQ(json["commands"][0]["command"], "COMMAND_JOG");
  EXPECT_EQ(json["commands"][0]["allowed"], false);
  const auto& fields = *joblink::Status::descriptor();
  for (int i = 0; i < fields.field_count(); ++i) {
    const auto& field = *fields.field(i);
    const bool always = field.is_repeated() || !field.has_presence();
    EXPECT_TRUE(json.contains(field.name()) || !always) << field.name();
  }
}

TEST(MessageJson, HasOnlyWhatIsAskedFor) {
  joblink::Status status;
  status.set_bus_load(0.25);
  status.add_nodes()->set_id(3);
  const auto json = nlohmann::json::parse(to_json_text(status, {"nodes", "bus_load"}));
  EXPECT_EQ(json.size(), 2u);
  EXPECT_EQ(json["nodes"][0]["id"], 3);
  EXPECT_EQ(json["bus_load"], 0.25);
}

}  // namespace
}  // namespace kinebus
