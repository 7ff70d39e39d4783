// What apps and managers of printers do with OctoPrint's buttons, and parts of files.

#include <cmath>
#include <iostream>

#include "gateway/sessions/http/tests/http_rig.hpp"
#include "gateway/sessions/messages.hpp"

namespace kinebus::http {
namespace {

using namespace std::chrono_literals;

joblink::Status status_of(HttpRig& rig) {
  return to_message(rig.link.machine.gateway->status());
}

class OctoPrintControl : public ::testing::Test {
 protected:
  int post(const std::string& path, const std::string& body) {
    const Response response = rig.send("POST", path, body);
    if (response.status >= 300) std::cout << path << " " << body << ": " << response.body << "\n";
    return response.status;
  }
  bool is_ready() {
    return rig.run_until([&] { return status_of(rig).state() == joblink::STATE_READY; }, 120s);
  }
  /// The tool comes to rest there.
  bool comes_to(double x_mm, double z_mm) {
    return rig.run_until(
        [&] {
          const joblink::Status now = status_of(rig);
          return now.state() == joblink::STATE_READY && std::abs(now.tool().x_mm() - x_mm) < 1e-3 &&
                 std::abs(now.tool().z_mm() - z_mm) < 1e-3;
        },
        60s);
  }
  HttpRig rig;
};

TEST_F(OctoPrintControl, TheHeadIsHomedAndMoved) {
  EXPECT_EQ(post("/api/connection", R"({"command":"connect"})"), 204);
  ASSERT_TRUE(rig.run_until([&] { return status_of(rig).state() == joblink::STATE_UNHOMED; }, 20s));
  EXPECT_EQ(post("/api/printer/printhead", R"({"command":"home","axes":["x","y","z"]})"), 204);
  ASSERT_TRUE(is_ready());
  // M1 homes above its workspace.
  EXPECT_EQ(post("/kinebus/v1/reference", "{}"), 204);
  ASSERT_TRUE(rig.run_until([&] { return status_of(rig).tool().z_mm() < 250; }, 60s) && is_ready());
  const joblink::Pose before = status_of(rig).tool();
  EXPECT_EQ(post("/api/printer/printhead", R"({"command":"jog","x":3,"y":0,"z":-2})"), 204);
  EXPECT_TRUE(comes_to(before.x_mm() + 3, before.z_mm() - 2));
  EXPECT_EQ(post("/api/printer/printhead", R"({"command":"jog","x":1,"absolute":true,"speed":600})"), 204);
  EXPECT_TRUE(comes_to(1, before.z_mm() - 2));
  EXPECT_EQ(post("/api/printer/command", R"({"commands":["G91","G0 X2","G90"]})"), 204);
  EXPECT_TRUE(comes_to(3, before.z_mm() - 2));

  for (const auto& [factor, ratio] : {std::pair("50", 0.5), std::pair("0.25", 0.25), std::pair("120", 1.2)}) {
    const std::string feedrate = std::string(R"({"command":"feedrate","factor":)") + factor + "}";
    EXPECT_EQ(post("/api/printer/printhead", feedrate), 204);
    EXPECT_DOUBLE_EQ(status_of(rig).feed_override(), ratio);
  }
}

TEST_F(OctoPrintControl, HeatersHaveOctoPrintsNames) {
  EXPECT_EQ(post("/api/printer/tool", R"({"command":"target","targets":{"tool0":180}})"), 204);
  EXPECT_EQ(post("/api/printer/bed", R"({"command":"target","target":55})"), 204);
  const joblink::Status now = status_of(rig);
  for (const joblink::Heater& heater : now.heaters())
    EXPECT_EQ(heater.target_celsius(), heater.kind() == joblink::HEATER_BED ? 55 : 180);
  EXPECT_EQ(rig.get("/api/printer").json()["temperature"]["tool0"]["target"], 180);
}

MachineDescription with_two_hotends() {
  MachineDescription machine = default_m1();
  HeaterDescription second = *machine.heater({HeaterKind::kHotend, 0});
  second.name = "hotend_1";
  second.index = 1;
  machine.heaters.push_back(second);
  return machine;
}

TEST(OctoPrintTools, TheOneThatIsSelectedIsInUse) {
  HttpRig rig({}, 32, Users(kKey), with_two_hotends());
  rig.send("POST", "/api/connection", R"({"command":"connect"})");
  ASSERT_TRUE(rig.run_until([&] { return status_of(rig).state() == joblink::STATE_UNHOMED; }, 20s));
  rig.send("POST", "/api/printer/printhead", R"({"command":"home","axes":["z"]})");
  ASSERT_TRUE(rig.run_until([&] { return status_of(rig).state() == joblink::STATE_READY; }, 120s));
  ASSERT_EQ(status_of(rig).hotend_in_use(), 0U);
  for (const unsigned tool : {1U, 0U}) {
    const std::string body = R"({"command":"select","tool":"tool)" + std::to_string(tool) + R"("})";
    const Response response = rig.send("POST", "/api/printer/tool", body);
    EXPECT_EQ(response.status, 204) << response.body;
    EXPECT_TRUE(rig.run_until([&] { return status_of(rig).hotend_in_use() == tool; }, 5s)) << body;
  }
}

TEST_F(OctoPrintControl, WhatIsWrongIsSaidAndNothingMoves) {
  const std::tuple<const char*, const char*, int, const char*> cases[] = {
      {"/api/printer/printhead", R"({"command":"dance"})", 400, "jog, home, feedrate"},
      {"/api/printer/printhead", R"({"command":"jog","x":"far"})", 400, "numbers"},
      {"/api/printer/printhead", R"({"command":"jog","x":1,"absolute":true})", 409, "home the machine"},
      {"/api/printer/printhead", R"({"command":"feedrate"})", 400, "factor"},
      {"/api/printer/tool", R"({"command":"target","targets":{"tool7":200}})", 409, "no heater 'tool7'"},
      {"/api/printer/tool", R"({"command":"target","targets":{"tool0":"hot"}})", 400, "degrees Celsius"},
      {"/api/printer/tool", R"({"command":"target"})", 400, "'targets'"},
      {"/api/printer/tool", R"({"command":"extrude","amount":"much"})", 400, "the amount"},
      {"/api/printer/tool", R"({"command":"select","tool":"tool1"})", 409, "no tool 'tool1'"},
      {"/api/printer/tool", R"({"command":"offset"})", 400, "target, extrude, select"},
      {"/api/printer/bed", R"({"command":"offset","offset":1})", 400, "target"},
      {"/api/printer/bed", R"({"command":"target","target":900})", 409, "0 to 120 C"},
      {"/api/printer/chamber", R"({"command":"target","target":40})", 409, "no heater 'chamber'"},
      {"/api/printer/command", R"({"commands":[]})", 400, "1 to 50 lines"},
      {"/api/printer/command", R"({"commands":[7]})", 400, "a text"},
      {"/api/printer/command", R"({"command":"G999"})", 409, "G999"},
      {"/api/connection", R"({"command":"disconnect"})", 409, "keeps its bus"},
      {"/api/connection", R"({"command":"port"})", 400, "connect, disconnect"},
  };
  for (const auto& [path, body, status, words] : cases) {
    const Response response = rig.send("POST", path, body);
    EXPECT_EQ(response.status, status) << path << body << response.body;
    EXPECT_NE(response.body.find(words), std::string::npos) << path << body << response.body;
  }
}

TEST_F(OctoPrintControl, APartOfAFileIsAPart) {
  const std::string put =
      HttpRig::head("PUT", "/api/v1/files/local/a%20b.gcode") + "Content-Type: text/x.gcode\r\n";
  ASSERT_EQ(rig.ask(put + HttpRig::with_body("0123456789")).status, 201);
  const auto part = [&](const std::string& range) {
    return rig.ask(HttpRig::head("GET", "/downloads/files/local/a%20b.gcode") + "Range: " + range +
                   "\r\n\r\n");
  };
  const std::pair<const char*, const char*> parts[] = {{"bytes=0-0", "0"},
                                                       {"bytes=2-5", "2345"},
                                                       {"bytes=7-", "789"},
                                                       {"bytes=8-99999999999999999999", "0123456789"},
                                                       {"bytes=8-18446744073709551615", "89"},
                                                       {"bytes=-3", "789"},
                                                       {"bytes=-30", "0123456789"},
                                                       {"bytes=5-2", "0123456789"},
                                                       {"bytes=1-2,4-5", "0123456789"},
                                                       {"lines=1-2", "0123456789"}};
  for (const auto& [range, text] : parts) {
    const Response response = part(range);
    EXPECT_EQ(response.body, text) << range;
    const bool is_whole = response.body.size() == 10 && std::string(range) != "bytes=-30";
    EXPECT_EQ(response.status, is_whole ? 200 : 206) << range;
  }
  EXPECT_NE(part("bytes=2-5").head.find("Content-Range: bytes 2-5/10"), std::string::npos);
  const Response beyond = part("bytes=10-");
  EXPECT_EQ(beyond.status, 416);
  EXPECT_NE(beyond.head.find("Content-Range: bytes */10"), std::string::npos);
  EXPECT_NE(part("").head.find("Content-Disposition: attachment; filename*=UTF-8''a%20b.gcode"),
            std::string::npos);
}

}  // namespace
}  // namespace kinebus::http
