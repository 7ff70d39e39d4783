#pragma once
// One message of MQTT.

#include <string>

namespace kinebus::fleet {

struct MqttMessage {
  std::string topic;
  std::string payload;
  int qos = 0;
  bool retain = false;
};

}  // namespace kinebus::fleet
