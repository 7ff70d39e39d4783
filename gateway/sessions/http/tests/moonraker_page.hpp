#pragma once
// A web page that speaks Moonraker's API over its websocket.

#include <string>
#include <vector>

#include "gateway/sessions/http/tests/socket_rig.hpp"

namespace kinebus::http {

class WebPage {
 public:
  explicit WebPage(HttpRig& rig, bool with_key = true)
      : rig_(rig), client_(rig, "/websocket", with_key ? kKey : "") {}
  /// The whole answer.
  nlohmann::json ask(const std::string& method, const nlohmann::json& params = nlohmann::json::object()) {
    const int id = ++id_;
    nlohmann::json answer;
    collect(
        client_.say(
            nlohmann::json{{"jsonrpc", "2.0"}, {"method", method}, {"params", params}, {"id", id}}.dump()),
        id, answer);
    rig_.run_until(
        [&] {
          collect(frames_of(client_.wire.heard), id, answer);
          return !answer.is_null();
        },
        std::chrono::seconds{20});
    return answer;
  }
  nlohmann::json result(const std::string& method, const nlohmann::json& params = nlohmann::json::object()) {
    const nlohmann::json answer = ask(method, params);
    EXPECT_TRUE(answer.contains("result")) << method << ": " << answer.dump();
    return answer.value("result", nlohmann::json::object());
  }
  void run(BusTime time) {
    nlohmann::json none;
    collect(client_.hear(time), -1, none);
  }
  std::vector<nlohmann::json> notified;

 private:
  void collect(const std::vector<Heard>& frames, int id, nlohmann::json& answer) {
    for (const Heard& frame : frames) {
      const nlohmann::json said = frame.json();
      if (said.contains("method"))
        notified.push_back(said);
      else if (said.contains("id") && said["id"] == id)
        answer = said;
    }
  }
  HttpRig& rig_;
  SocketClient client_;
  int id_ = 0;
};

}  // namespace kinebus::http
