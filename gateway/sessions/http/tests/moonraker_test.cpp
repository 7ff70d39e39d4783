// Moonraker's API as Mainsail and Fluidd call it: their first calls, method by method in their order, then
// what a user does on their pages.

#include <algorithm>

#include "gateway/sessions/http/tests/moonraker_page.hpp"

namespace kinebus::http {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

const json kIdentity = {{"client_name", "page"}, {"version", "1"}, {"type", "web"}, {"url", "-"}};

TEST(Moonraker, MainsailsFirstCallsAreAnswered) {
  HttpRig rig;
  WebPage page(rig);
  EXPECT_TRUE(page.result("server.connection.identify", kIdentity)["connection_id"].is_number());
  const json info = page.result("server.info");
  EXPECT_EQ(info["klippy_connected"], true);
  EXPECT_EQ(info["klippy_state"], "ready");
  // Mainsail wants v0.8.0-306 or later.
  EXPECT_GE(info["moonraker_version"].get<std::string>(), "v0.8.1");
  EXPECT_TRUE(page.result("server.config").contains("config"));
  EXPECT_TRUE(page.result("machine.system_info").contains("system_info"));
  EXPECT_TRUE(page.result("machine.proc_stats").contains("throttled_state"));
  EXPECT_TRUE(page.result("server.database.list", {{"root", "config"}})["namespaces"].is_array());
  EXPECT_EQ(page.ask("server.database.get_item", {{"namespace", "mainsail"}})["error"]["code"], 404);
  page.result("server.database.post_item",
              {{"namespace", "mainsail"}, {"key", "general.printername"}, {"value", "m1"}});
  EXPECT_EQ(
      page.result("server.database.get_item", {{"namespace", "mainsail"}})["value"]["general"]["printername"],
      "m1");
  EXPECT_TRUE(page.result("server.webcams.list")["webcams"].empty());
  EXPECT_TRUE(
      page.result("printer.objects.query", {{"objects", {{"gcode", {"commands"}}}}})["status"]["gcode"]
          .contains("commands"));
  EXPECT_EQ(page.result("printer.info")["state"], "ready");
  EXPECT_TRUE(page.result("server.gcode_store")["gcode_store"].is_array());
  const json objects = page.result("printer.objects.list")["objects"];
  json wanted = json::object();
  for (const json& name : objects) wanted[name.get<std::string>()] = nullptr;
  for (const char* needed : {"virtual_sdcard", "pause_resume", "display_status", "gcode_macro PAUSE",
                             "toolhead", "gcode_move", "extruder", "heater_bed", "print_stats", "webhooks"})
    EXPECT_TRUE(wanted.contains(needed)) << needed;
  const json status = page.result("printer.objects.subscribe", {{"objects", wanted}})["status"];
  EXPECT_EQ(status.size(), wanted.size());
  EXPECT_EQ(status["toolhead"]["homed_axes"], "");
  EXPECT_EQ(status["print_stats"]["state"], "standby");
  EXPECT_TRUE(page.result("server.temperature_store", {{"include_monitors", true}}).contains("extruder"));
  EXPECT_TRUE(page.result("server.files.get_directory", {{"path", "gcodes"}})["files"].is_array());
  EXPECT_EQ(page.result("server.history.list")["count"], 0);
  EXPECT_TRUE(page.result("server.history.totals").contains("job_totals"));
  EXPECT_TRUE(page.result("server.announcements.list")["entries"].empty());
  EXPECT_TRUE(page.result("server.job_queue.status")["queued_jobs"].empty());
}

TEST(Moonraker, FluiddsFirstCallsAreAnswered) {
  HttpRig rig;
  WebPage page(rig);
  page.result("server.connection.identify", kIdentity);
  EXPECT_EQ(page.ask("server.database.get_item", {{"namespace", "fluidd"}})["error"]["code"], 404);
  page.result("server.info");
  page.result("server.config");
  page.result("machine.proc_stats");
  page.result("machine.system_info");
  EXPECT_TRUE(page.result("server.files.list", {{"root", "config"}}).empty());
  page.result("server.files.roots");
  EXPECT_TRUE(page.result("access.info").contains("login_required"));
  page.result("printer.info");
  page.result("printer.objects.list");
  EXPECT_EQ(page.ask("machine.device_power.devices")["error"]["code"], -32601);
}

TEST(Moonraker, WhoDoesNotShowTheKeyMayOnlyIdentifyItself) {
  HttpRig rig;
  WebPage page(rig, false);
  EXPECT_EQ(page.ask("server.info")["error"]["code"], 401);
  EXPECT_EQ(page.ask("server.connection.identify", kIdentity)["error"]["code"], 401);
  json identity = kIdentity;
  identity["api_key"] = kKey;
  page.result("server.connection.identify", identity);
  page.result("server.info");
  EXPECT_EQ(rig.ask("GET /printer/info HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 401);
}

TEST(Moonraker, APrintIsUploadedStartedAndSeenToItsEnd) {
  HttpRig rig;
  rig.link.machine.make_ready();
  WebPage page(rig);
  page.result("printer.objects.subscribe", {{"objects", {{"print_stats", {"state", "filename"}}}}});
  const std::string form =
      "--B\r\nContent-Disposition: form-data; name=\"root\"\r\n\r\ngcodes\r\n"
      "--B\r\nContent-Disposition: form-data; name=\"file\"; filename=\"a.gcode\"\r\n\r\n"
      "G21\nG90\nG1 X10 F600\nG1 X0\n\r\n--B--\r\n";
  const Response stored =
      rig.ask(HttpRig::head("POST", "/server/files/upload") +
              "Content-Type: multipart/form-data; boundary=B\r\n" + HttpRig::with_body(form));
  ASSERT_EQ(stored.status, 201) << stored.body;
  EXPECT_EQ(stored.json()["item"]["path"], "a.gcode");
  EXPECT_EQ(page.result("server.files.metadata", {{"filename", "a.gcode"}})["filename"], "a.gcode");
  EXPECT_EQ(page.ask("printer.print.start", {{"filename", "b.gcode"}})["error"]["code"], 400);
  EXPECT_EQ(page.result("printer.print.start", {{"filename", "a.gcode"}}), "ok");
  page.run(15s);
  std::vector<std::string> states;
  for (const json& said : page.notified)
    if (said["method"] == "notify_status_update" && said["params"][0]["print_stats"].contains("state"))
      states.push_back(said["params"][0]["print_stats"]["state"]);
  EXPECT_EQ(states, (std::vector<std::string>{"printing", "complete"}));
  const json jobs = page.result("server.history.list")["jobs"];
  ASSERT_EQ(jobs.size(), 1U);
  EXPECT_EQ(jobs[0]["status"], "completed");
  EXPECT_EQ(jobs[0]["exists"], true);
  const json totals = page.result("server.history.totals")["job_totals"];
  EXPECT_EQ(totals["total_jobs"], 1);
  EXPECT_EQ(totals["longest_job"], jobs[0]["total_duration"]);
  EXPECT_EQ(totals["total_time"], jobs[0]["total_duration"]);
  EXPECT_EQ(page.result("server.history.get_job", {{"uid", jobs[0]["job_id"]}})["job"], jobs[0]);
  EXPECT_EQ(page.ask("server.history.get_job", {{"uid", "99"}})["error"]["code"], 404);
  std::vector<std::string> actions;
  for (const json& said : page.notified)
    if (said["method"] == "notify_history_changed") {
      actions.push_back(said["params"][0]["action"]);
      EXPECT_EQ(said["params"][0]["job"]["job_id"], jobs[0]["job_id"]);
    }
  EXPECT_EQ(actions, (std::vector<std::string>{"added", "finished"}));
  EXPECT_EQ(page.result("server.files.delete_file", {{"path", "gcodes/a.gcode"}})["action"], "delete_file");
  EXPECT_EQ(page.result("server.history.list")["jobs"][0]["exists"], false);
}

TEST(Moonraker, AnObjectOfThePrintIsLeftOut) {
  HttpRig rig;
  rig.link.machine.make_ready();
  WebPage page(rig);
  const std::string form =
      "--B\r\nContent-Disposition: form-data; name=\"file\"; filename=\"two.gcode\"\r\n\r\n"
      "G21\nG90\nEXCLUDE_OBJECT_DEFINE NAME=Cube_1\nEXCLUDE_OBJECT_DEFINE NAME=cube_2\nG1 X10 F600\nG4 S20\n"
      "\r\n--B--\r\n";
  ASSERT_EQ(rig.ask(HttpRig::head("POST", "/server/files/upload") +
                    "Content-Type: multipart/form-data; boundary=B\r\n" + HttpRig::with_body(form))
                .status,
            201);
  const json leave_out = {{"script", "EXCLUDE_OBJECT NAME=CUBE_1"}};
  EXPECT_EQ(page.ask("printer.gcode.script", leave_out)["error"]["code"], 400) << "nothing is printed yet";
  EXPECT_EQ(page.result("printer.print.start", {{"filename", "two.gcode"}}), "ok");
  page.run(5s);
  const auto objects = [&] {
    return page.result("printer.objects.query",
                       {{"objects", {{"exclude_object", nullptr}}}})["status"]["exclude_object"];
  };
  ASSERT_EQ(objects()["objects"].size(), 2U);
  EXPECT_TRUE(objects()["excluded_objects"].empty());
  EXPECT_EQ(page.result("printer.gcode.script", leave_out), "ok");
  EXPECT_EQ(objects()["excluded_objects"], json::array({"cube_1"}));
  const json wrong = page.ask("printer.gcode.script", {{"script", "EXCLUDE_OBJECT NAME=sphere"}})["error"];
  EXPECT_NE(wrong["message"].get<std::string>().find("it has cube_1, cube_2"), std::string::npos);
}

TEST(Moonraker, ScriptsAreCarriedOutLineByLine) {
  HttpRig rig;
  rig.link.machine.make_ready();
  WebPage page(rig);
  EXPECT_EQ(
      page.result("printer.gcode.script", {{"script", "SET_HEATER_TEMPERATURE HEATER=extruder TARGET=200"}}),
      "ok");
  EXPECT_EQ(page.result("printer.objects.query",
                        {{"objects", {{"extruder", {"target"}}}}})["status"]["extruder"]["target"],
            200);
  page.result("printer.gcode.script", {{"script", "TURN_OFF_HEATERS"}});
  EXPECT_EQ(page.result("printer.objects.query",
                        {{"objects", {{"extruder", {"target"}}}}})["status"]["extruder"]["target"],
            0);
  const auto x = [&] {
    return page
        .result("printer.objects.query",
                {{"objects", {{"toolhead", {"position"}}}}})["status"]["toolhead"]["position"]
        .at(0)
        .get<double>();
  };
  const double before = x();
  page.result("printer.gcode.script", {{"script", "G91\nG1 X5 F3000\nG90"}});
  page.run(3s);
  // Positions are those of the motors' steps.
  EXPECT_NEAR(x(), before + 5, 1e-3);
  const json wrong = page.ask("printer.gcode.script", {{"script", "G1 X5\nNONSENSE 5"}})["error"];
  EXPECT_NE(wrong["message"].get<std::string>().find("NONSENSE"), std::string::npos);
  page.result("printer.emergency_stop");
  page.run(3s);
  EXPECT_EQ(page.result("printer.info")["state"], "shutdown");
  EXPECT_TRUE(std::any_of(page.notified.begin(), page.notified.end(),
                          [](const json& said) { return said["method"] == "notify_klippy_shutdown"; }));
  page.result("printer.firmware_restart");
}

TEST(Moonraker, TheSameIsAskedByHttp) {
  HttpRig rig;
  EXPECT_EQ(rig.get("/printer/info").json()["result"]["app"], "Kinebus");
  const json status =
      rig.get("/printer/objects/query?toolhead=position,homed_axes&webhooks").json()["result"]["status"];
  EXPECT_EQ(status["toolhead"].size(), 2U);
  EXPECT_EQ(status["webhooks"]["state"], "ready");
  EXPECT_EQ(rig.send("POST", "/printer/print/start", R"({"filename":"none"})").json()["error"]["code"], 400);
  EXPECT_EQ(rig.ask(HttpRig::head("POST", "/printer/emergency_stop") + "Content-Length: 0\r\n\r\n").status,
            200);
  EXPECT_EQ(rig.get("/server/files/gcodes/none.gcode").status, 404);
  EXPECT_EQ(rig.get("/printer/emergency_stop").status, 405);
}

TEST(Moonraker, WrongRequestsAreRefusedAndTheSocketStays) {
  HttpRig rig;
  SocketClient client(rig, "/websocket");
  const auto code = [&](const std::string& text) { return client.say(text).at(0).json()["error"]["code"]; };
  EXPECT_EQ(code("{"), -32700);
  EXPECT_EQ(code("5"), -32600);
  EXPECT_EQ(code(R"({"method":"server.none","id":1})"), -32601);
  EXPECT_EQ(code(R"({"method":"printer.objects.query","id":1})"), 400);
  EXPECT_EQ(code(R"({"method":"printer.gcode.script","params":{"script":5},"id":1})"), 400);
  EXPECT_EQ(client.say(R"([{"method":"server.info","id":1},{"method":"printer.info","id":"x"}])").size(), 2U);
  std::string deep =
      R"({"method":"server.database.post_item","id":1,"params":{"namespace":"n","key":"k","value":)";
  for (int i = 0; i < 2000; ++i) deep += '[';
  for (int i = 0; i < 2000; ++i) deep += ']';
  client.say(deep + "}}");
  const std::string big(60'000, 'a');
  int refused = 0;
  for (int i = 0; i < 12; ++i) {
    const json post = {{"method", "server.database.post_item"},
                       {"id", i},
                       {"params", {{"namespace", "n"}, {"key", std::to_string(i)}, {"value", big}}}};
    refused += client.say(post.dump()).at(0).json().contains("error") ? 1 : 0;
  }
  EXPECT_GT(refused, 2);
  EXPECT_FALSE(client.wire.session->ended());
}

/// As FDM Monster does.
TEST(Moonraker, ARequestSubscribesForAWebsocket) {
  HttpRig rig;
  WebPage page(rig);
  const auto id = page.result("server.connection.identify", kIdentity)["connection_id"].get<std::uint64_t>();
  const std::string path = "/printer/objects/subscribe?connection_id=";
  const auto subscribe = [&](const std::string& number) {
    return rig.ask(HttpRig::head("POST", path + number + "&print_stats&heater_bed=target") +
                   "Content-Length: 0\r\n\r\n");
  };
  const Response response = subscribe(std::to_string(id));
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.json()["result"]["status"]["heater_bed"].size(), 1U) << response.body;
  EXPECT_EQ(response.json()["result"]["status"].contains("connection_id"), false);
  EXPECT_EQ(subscribe(std::to_string(id + 1000)).status, 400);
  page.result("printer.gcode.script", {{"script", "M140 S41"}});
  page.run(2s);
  json told = json::object();
  for (const json& said : page.notified)
    if (said["method"] == "notify_status_update") told.update(said["params"][0]);
  EXPECT_EQ(told["heater_bed"]["target"], 41) << told;
}

}  // namespace
}  // namespace kinebus::http
