// Payloads as a reader of Sparkplug B and Home Assistant see them.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gateway/fleet/outward/home_assistant.hpp"
#include "gateway/fleet/outward/sparkplug_node.hpp"

namespace kinebus::fleet {
namespace {

const MachineView kPrints{.machine = {.name = "m", .kind = "m1", .material = "PLA", .nozzle_mm = 0.4},
                          .answers = true,
                          .state = "running",
                          .job = 7,
                          .progress = 0.5};

sparkplug::Payload read(const MqttMessage& message) {
  sparkplug::Payload payload;
  EXPECT_TRUE(payload.ParseFromString(message.payload));
  return payload;
}

const sparkplug::Payload::Metric& metric(const sparkplug::Payload& payload, const std::string& name) {
  for (const auto& m : payload.metrics())
    if (m.name() == name) return m;
  ADD_FAILURE() << "no metric " << name;
  static const sparkplug::Payload::Metric kNone;
  return kNone;
}

TEST(Sparkplug, BirthAndDeathOfOneConnectionHaveItsNumber) {
  SparkplugNode node("hall", "agent", 0);
  for (std::uint64_t connection = 0; connection < 300; ++connection) {
    node.next_connection();
    const MqttMessage death = node.death(5);
    EXPECT_EQ(death.topic, "spBv1.0/hall/NDEATH/agent");
    EXPECT_FALSE(read(death).has_seq());
    EXPECT_EQ(metric(read(death), "bdSeq").long_value(), connection % 256);
    const auto birth = node.birth(6, {});
    ASSERT_EQ(birth.size(), 1U);
    EXPECT_EQ(birth[0].topic, "spBv1.0/hall/NBIRTH/agent");
    EXPECT_EQ(read(birth[0]).seq(), 0U);
    EXPECT_EQ(metric(read(birth[0]), "bdSeq").long_value(), connection % 256);
  }
}

TEST(Sparkplug, MessagesAreNumberedRoundTheByteAndSayWhatChanged) {
  SparkplugNode node("hall", "agent", 0);
  node.next_connection();
  const auto births = node.birth(1, {kPrints});
  ASSERT_EQ(births.size(), 2U);
  EXPECT_EQ(births[1].topic, "spBv1.0/hall/DBIRTH/agent/m");
  EXPECT_EQ(read(births[1]).seq(), 1U);
  EXPECT_EQ(metric(read(births[1]), "Properties/Material").string_value(), "PLA");
  for (std::uint64_t n = 2; n < 600; ++n) {
    const MqttMessage data = node.show(n, kPrints);
    EXPECT_EQ(data.topic, "spBv1.0/hall/DDATA/agent/m");
    EXPECT_EQ(read(data).seq(), n % 256);
    EXPECT_EQ(metric(read(data), "Progress").double_value(), 0.5);
  }
}

TEST(Sparkplug, AMachineThatDoesNotAnswerDiesAndIsBornAgain) {
  SparkplugNode node("hall", "agent", 0);
  node.next_connection();
  node.birth(1, {kPrints});
  MachineView gone = kPrints;
  gone.answers = false;
  EXPECT_EQ(node.show(2, gone).topic, "spBv1.0/hall/DDEATH/agent/m");
  EXPECT_EQ(node.show(3, kPrints).topic, "spBv1.0/hall/DBIRTH/agent/m");
  EXPECT_EQ(node.show(4, kPrints).topic, "spBv1.0/hall/DDATA/agent/m");
}

TEST(Sparkplug, ARebirthIsAskedForByItsMetricAlone) {
  const SparkplugNode node("hall", "agent", 0);
  sparkplug::Payload command;
  auto& asked = *command.add_metrics();
  asked.set_name("Node Control/Rebirth");
  EXPECT_FALSE(node.is_rebirth(command.SerializeAsString()));
  asked.set_boolean_value(true);
  EXPECT_TRUE(node.is_rebirth(command.SerializeAsString()));
  EXPECT_FALSE(node.is_rebirth("\xff\xff\xff"));
}

TEST(HomeAssistant, FindsAMachineAndItsStates) {
  const MqttMessage device = home_assistant_device("hall", kPrints.machine);
  EXPECT_EQ(device.topic, "homeassistant/device/kinebus_hall_m/config");
  EXPECT_TRUE(device.retain);
  const auto config = nlohmann::json::parse(device.payload);
  const MqttMessage state = home_assistant_state("hall", kPrints);
  EXPECT_EQ(config["state_topic"], state.topic);
  EXPECT_EQ(config["availability"][0]["topic"], state.topic);
  EXPECT_EQ(config["components"]["progress"]["unit_of_measurement"], "%");
  const auto value = nlohmann::json::parse(state.payload);
  EXPECT_EQ(value["state"], "running");
  EXPECT_EQ(value["progress"], 50);
  EXPECT_EQ(value["answers"], config["payload_available"]);
}

}  // namespace
}  // namespace kinebus::fleet
