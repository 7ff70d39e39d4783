// OctoPrint's push updates: let in by the session of a passive login, the state, the past and events.

#include <algorithm>

#include "gateway/sessions/http/tests/socket_rig.hpp"

namespace kinebus::http {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::json;

std::string auth_of(HttpRig& rig) {
  const Json login = rig.send("POST", "/api/login", R"({"passive":true})").json();
  return login["name"].get<std::string>() + ":" + login["session"].get<std::string>();
}

/// The payloads of all messages of this type.
std::vector<Json> of_type(const std::vector<Heard>& heard, const char* type) {
  std::vector<Json> found;
  for (const Heard& one : heard)
    if (const Json told = one.json(); told.is_object() && told.contains(type)) found.push_back(told[type]);
  return found;
}
std::vector<std::string> events_in(const std::vector<Heard>& heard) {
  std::vector<std::string> names;
  for (const Json& event : of_type(heard, "event"))
    if (event["type"] != "PrinterStateChanged" && event["type"] != "UpdatedFiles")
      names.push_back(event["type"]);
  return names;
}

TEST(OctoPrintPush, TellsNothingBeforeItIsLetIn) {
  HttpRig rig;
  ASSERT_TRUE(rig.link.machine.make_ready());
  SocketClient client(rig, "/sockjs/websocket", "");
  auto heard = client.hear(2s);
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(heard[0].json()["connected"]["version"], "1.9.0");

  for (const char* wrong : {"kinebus:0123", "kinebus", "", ":", "_api:0123456789abcdef"}) {
    heard = client.say(Json{{"auth", wrong}, {"throttle", 2}}.dump());
    for (const Heard& one : heard) EXPECT_EQ(one.json()["reauthRequired"]["reason"], "stale") << wrong;
  }
  for (const char* junk :
       {"[1]", "null", "{", "{\"auth\":[]}", "{\"throttle\":\"a\"}", "{\"throttle\":1e300}"})
    EXPECT_TRUE(client.say(junk).empty()) << junk;

  heard = client.say(Json{{"auth", auth_of(rig)}}.dump());
  const auto more = client.hear(100ms);
  heard.insert(heard.end(), more.begin(), more.end());
  ASSERT_FALSE(of_type(heard, "history").empty());
  EXPECT_EQ(of_type(heard, "history")[0]["state"]["text"], "Operational");

  // Who says nothing of a login is shown the door.
  SocketClient stranger(rig, "/sockjs/websocket", "");
  heard = stranger.hear(12s);
  ASSERT_FALSE(heard.empty());
  EXPECT_EQ(heard.back().opcode, Opcode::kClose);
}

TEST(OctoPrintPush, TheStateComesAsOftenAsItIsWanted) {
  HttpRig rig;
  ASSERT_TRUE(rig.link.machine.make_ready());
  rig.link.machine.run_for(1s);
  SocketClient client(rig, "/sockjs/websocket", "");
  client.say(Json{{"auth", auth_of(rig)}}.dump());
  client.hear(1s);
  const auto current = of_type(client.hear(5s), "current");
  EXPECT_GE(current.size(), 9U);
  EXPECT_LE(current.size(), 11U);
  EXPECT_TRUE(current[0]["state"]["flags"]["ready"]);
  EXPECT_TRUE(current[0]["job"]["file"]["name"].is_null());
  EXPECT_TRUE(current[0]["currentZ"].is_number());
  client.say(R"({"throttle":4})");
  client.hear(2s);
  EXPECT_EQ(of_type(client.hear(6s), "current").size(), 3U);
}

TEST(OctoPrintPush, AJobIsToldFromItsStartToItsEnd) {
  HttpRig rig;
  ASSERT_TRUE(rig.link.machine.make_ready());
  rig.ask(rig.head("PUT", "/api/v1/files/local/part.gcode") + rig.with_body("G1 X4 F100\nG1 X0\nM2\n"));
  SocketClient client(rig, "/sockjs/websocket");  // with the key in its request
  client.hear(1s);
  EXPECT_EQ(rig.send("POST", "/api/files/local/part.gcode", R"({"command":"select","print":true})").status,
            204);
  auto heard = client.hear(2s);
  EXPECT_EQ(events_in(heard), (std::vector<std::string>{"PrintStarted"}));
  const Json during = of_type(heard, "current").back();
  EXPECT_EQ(during["state"]["text"], "Printing");
  EXPECT_EQ(during["job"]["file"]["name"], "part.gcode");
  EXPECT_EQ(during["job"]["file"]["size"], 20);
  EXPECT_GT(during["progress"]["completion"].get<double>(), 0);

  EXPECT_EQ(rig.send("POST", "/api/job", R"({"command":"pause","action":"pause"})").status, 204);
  EXPECT_EQ(events_in(client.hear(10s)), (std::vector<std::string>{"PrintPaused"}));
  EXPECT_EQ(rig.send("POST", "/api/job", R"({"command":"pause","action":"resume"})").status, 204);
  heard = client.hear(10s);
  ASSERT_EQ(events_in(heard), (std::vector<std::string>{"PrintResumed", "PrintDone"}));
  // 8 mm at 100 mm/min; a pause is not printing.
  for (const Json& event : of_type(heard, "event"))
    if (event["type"] == "PrintDone") {
      EXPECT_NEAR(event["payload"]["time"].get<double>(), 4.8, 1.5) << event;
    }

  EXPECT_EQ(rig.send("POST", "/api/job", R"({"command":"start"})").status, 204);
  client.hear(2s);
  EXPECT_EQ(rig.send("POST", "/api/job", R"({"command":"cancel"})").status, 204);
  EXPECT_EQ(events_in(client.hear(10s)),
            (std::vector<std::string>{"PrintCancelling", "PrintFailed", "PrintCancelled"}));
}

TEST(OctoPrintPush, ARefusedJobAndAStopFail) {
  HttpRig rig;
  ASSERT_TRUE(rig.link.machine.make_ready());
  SocketClient client(rig, "/sockjs/websocket");
  rig.ask(rig.head("PUT", "/api/v1/files/local/far.gcode") + rig.with_body("G1 X4000 F100\nM2\n"));
  client.hear(1s);
  EXPECT_EQ(rig.send("POST", "/api/files/local/far.gcode", R"({"command":"select","print":true})").status,
            409);
  EXPECT_EQ(events_in(client.hear(1s)), (std::vector<std::string>{"PrintFailed"}));
}

TEST(OctoPrintPush, SockJsPutsItsFramesAroundAll) {
  HttpRig rig;
  ASSERT_TRUE(rig.link.machine.make_ready());
  const Json info = rig.ask("GET /sockjs/info?t=1 HTTP/1.1\r\nHost: localhost\r\n\r\n").json();
  EXPECT_EQ(info["websocket"], true);
  SocketClient client(rig, "/sockjs/173/abcdefgh/websocket", "");
  auto heard = client.hear(100ms);
  ASSERT_GE(heard.size(), 2U);
  EXPECT_EQ(heard[0].payload, "o");
  ASSERT_EQ(heard[1].payload.substr(0, 1), "a");
  const auto inner = [](const Heard& one) {
    return Json::parse(Json::parse(one.payload.substr(1))[0].get<std::string>());
  };
  EXPECT_TRUE(inner(heard[1]).contains("connected"));
  heard = client.say(Json::array({Json{{"auth", auth_of(rig)}}.dump()}).dump());
  const auto more = client.hear(1s);
  heard.insert(heard.end(), more.begin(), more.end());
  ASSERT_GE(heard.size(), 2U);
  EXPECT_TRUE(inner(heard[0]).contains("history"));
  EXPECT_TRUE(inner(heard[1]).contains("current"));
}

TEST(OctoPrintPush, ThePastHasThePointsOfTwentyMinutes) {
  HttpRig rig;
  ASSERT_TRUE(rig.link.machine.make_ready());
  rig.run_until([] { return false; }, 30s);
  SocketClient client(rig, "/sockjs/websocket");
  const auto history = of_type(client.hear(200ms), "history");
  ASSERT_EQ(history.size(), 1U);
  const Json& points = history[0]["temps"];
  ASSERT_GE(points.size(), 28U);
  EXPECT_LE(points.size(), 32U);
  EXPECT_EQ(points[1]["time"].get<int>() - points[0]["time"].get<int>(), 1);
  EXPECT_TRUE(points[0]["tool0"]["actual"].is_number());
}

}  // namespace
}  // namespace kinebus::http
