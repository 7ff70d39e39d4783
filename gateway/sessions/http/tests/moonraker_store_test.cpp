// Moonraker's API: what its pages ask for beside the first calls and prints; what is kept for who comes
// later.

#include <algorithm>

#include "gateway/sessions/http/tests/moonraker_page.hpp"

namespace kinebus::http {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

// src/api/socketActions.ts of Fluidd and the calls of Mainsail's src, but for components that are not
// announced (power, update_manager, timelapse, spoolman, sensor, analysis, mmu); what any Moonraker has
// besides.
TEST(MoonrakerStore, NoButtonOfThePagesMeetsAnUnknownMethod) {
  HttpRig rig;
  WebPage page(rig);
  const json info = page.result("server.info");
  const auto announced = info["components"].get<std::vector<std::string>>();
  for (const char* absent :
       {"power", "update_manager", "timelapse", "spoolman", "sensor", "job_queue", "analysis"})
    EXPECT_EQ(std::count(announced.begin(), announced.end(), absent), 0) << absent;
  const char* methods[] = {"access.delete_user",
                           "access.get_api_key",
                           "access.get_user",
                           "access.info",
                           "access.login",
                           "access.logout",
                           "access.oneshot_token",
                           "access.post_api_key",
                           "access.post_user",
                           "access.refresh_jwt",
                           "access.user.password",
                           "access.users.list",
                           "connection.register_remote_method",
                           "connection.send_event",
                           "machine.sudo.info",
                           "machine.sudo.password",
                           "server.announcements.feeds",
                           "server.extensions.list",
                           "server.extensions.request",
                           "server.webcams.test",
                           "machine.peripherals.canbus",
                           "machine.peripherals.serial",
                           "machine.peripherals.usb",
                           "machine.peripherals.video",
                           "machine.proc_stats",
                           "machine.reboot",
                           "machine.services.restart",
                           "machine.services.start",
                           "machine.services.stop",
                           "machine.shutdown",
                           "machine.system_info",
                           "printer.emergency_stop",
                           "printer.firmware_restart",
                           "printer.gcode.help",
                           "printer.gcode.script",
                           "printer.info",
                           "printer.objects.list",
                           "printer.objects.query",
                           "printer.objects.subscribe",
                           "printer.print.cancel",
                           "printer.print.pause",
                           "printer.print.resume",
                           "printer.print.start",
                           "printer.query_endstops.status",
                           "printer.restart",
                           "server.announcements.dismiss",
                           "server.announcements.list",
                           "server.config",
                           "server.connection.identify",
                           "server.database.compact",
                           "server.database.delete_backup",
                           "server.database.delete_item",
                           "server.database.get_item",
                           "server.database.list",
                           "server.database.post_backup",
                           "server.database.post_item",
                           "server.database.restore",
                           "server.files.copy",
                           "server.files.delete_directory",
                           "server.files.delete_file",
                           "server.files.get_directory",
                           "server.files.list",
                           "server.files.metadata",
                           "server.files.metascan",
                           "server.files.move",
                           "server.files.post_directory",
                           "server.files.roots",
                           "server.files.zip",
                           "server.gcode_store",
                           "server.history.delete_job",
                           "server.history.list",
                           "server.history.reset_totals",
                           "server.history.totals",
                           "server.info",
                           "server.job_queue.delete_job",
                           "server.job_queue.pause",
                           "server.job_queue.post_job",
                           "server.job_queue.start",
                           "server.job_queue.status",
                           "server.logs.rollover",
                           "server.restart",
                           "server.temperature_store",
                           "server.webcams.delete_item",
                           "server.webcams.list",
                           "server.webcams.post_item"};
  for (const char* method : methods) {
    const json answer = page.ask(method);
    ASSERT_TRUE(answer.is_object()) << method;
    EXPECT_NE(answer.value("error", json::object()).value("code", 0), -32601) << method;
    EXPECT_TRUE(answer.contains("result") || !answer["error"]["message"].get<std::string>().empty())
        << method;
  }
}

TEST(MoonrakerStore, WhoComesLaterSeesHowTemperaturesWent) {
  HttpRig rig;
  rig.link.machine.make_ready();
  rig.pump();
  WebPage early(rig);
  early.result("printer.gcode.script", {{"script", "SET_HEATER_TEMPERATURE HEATER=extruder TARGET=120"}});
  early.run(40s);
  WebPage late(rig);
  const json course = late.result("server.temperature_store")["extruder"];
  const auto temperatures = course["temperatures"].get<std::vector<double>>();
  ASSERT_GE(temperatures.size(), 35U);
  ASSERT_EQ(course["targets"].size(), temperatures.size());
  // A value a second: at first cold and off, then ever hotter.
  EXPECT_EQ(course["targets"].front(), 0);
  EXPECT_EQ(course["targets"].back(), 120);
  EXPECT_GT(temperatures.back(), temperatures.front() + 20);
  const double now =
      late.result("printer.objects.query",
                  {{"objects", {{"extruder", {"temperature"}}}}})["status"]["extruder"]["temperature"];
  EXPECT_NEAR(temperatures.back(), now, 5);
  rig.run_until([] { return false; }, 1300s);
  WebPage latest(rig);
  EXPECT_EQ(latest.result("server.temperature_store")["extruder"]["temperatures"].size(), 1200U);
}

TEST(MoonrakerStore, TheConsoleIsOneForAllAndKept) {
  HttpRig rig;
  rig.link.machine.make_ready();
  WebPage asks(rig), hears(rig);
  asks.result("printer.gcode.script", {{"script", "M115"}});
  asks.ask("printer.gcode.script", {{"script", "NONSENSE 5"}});
  hears.run(1s);
  std::vector<std::string> heard;
  for (const json& said : hears.notified)
    if (said["method"] == "notify_gcode_response") heard.push_back(said["params"][0]);
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_NE(heard[0].find("FIRMWARE_NAME"), std::string::npos) << heard[0];
  EXPECT_TRUE(heard[1].starts_with("!! NONSENSE 5")) << heard[1];
  WebPage late(rig);
  const json all = late.result("server.gcode_store")["gcode_store"];
  std::vector<std::string> story;
  for (const json& line : all) {
    EXPECT_GT(line["time"].get<double>(), 0);
    const std::string text = line["message"];
    if (line["type"] == "command" || text.find("FIRMWARE_NAME") != std::string::npos ||
        text.starts_with("!! N"))
      story.push_back(line["type"].get<std::string>() + " " + text.substr(0, 4));
  }
  EXPECT_EQ(story, (std::vector<std::string>{"command M115", "response " + heard[0].substr(0, 4),
                                             "command NONS", "response !! N"}));
  EXPECT_EQ(late.result("server.gcode_store", {{"count", 1}})["gcode_store"], json::array({all.back()}));
  EXPECT_TRUE(late.result("server.gcode_store", {{"count", 0}})["gcode_store"].empty());
  EXPECT_EQ(rig.get("/server/gcode_store?count=1").json()["result"]["gcode_store"].size(), 1U);
  // However much is said, what is kept is bounded.
  for (int i = 0; i < 1200; ++i) asks.result("printer.gcode.script", {{"script", "M115"}});
  EXPECT_LE(rig.server.console().lines().size(), ConsoleCourse::kLines);
}

TEST(MoonrakerStore, CamerasThatAPageEntersAreKeptAndToldToOthers) {
  HttpRig rig;
  WebPage page(rig), other(rig);
  EXPECT_EQ(page.ask("server.webcams.post_item", {{"name", ""}})["error"]["code"], 400);
  EXPECT_EQ(page.ask("server.webcams.post_item", {{"name", "top"}, {"rotation", "90"}})["error"]["code"],
            400);
  const json entered = page.result("server.webcams.post_item", {{"name", "top"},
                                                                {"stream_url", "/webcam/?action=stream"},
                                                                {"rotation", 90},
                                                                {"source", "x"}})["webcam"];
  EXPECT_EQ(entered["rotation"], 90);
  EXPECT_EQ(entered["source"], "database");
  other.result("printer.objects.subscribe", {{"objects", {{"webhooks", nullptr}}}});
  page.result("server.webcams.post_item", {{"uid", entered["uid"]}, {"enabled", false}});
  other.run(1s);
  ASSERT_TRUE(std::any_of(other.notified.begin(), other.notified.end(), [](const json& said) {
    return said["method"] == "notify_webcams_changed" && said["params"][0]["webcams"][0]["enabled"] == false;
  }));
  const json webcams = page.result("server.webcams.list")["webcams"];
  ASSERT_EQ(webcams.size(), 1U);
  EXPECT_EQ(webcams[0]["stream_url"], "/webcam/?action=stream");
  EXPECT_EQ(page.result("server.webcams.get_item", {{"name", "top"}})["webcam"], webcams[0]);
  page.result("server.webcams.delete_item", {{"uid", entered["uid"]}});
  EXPECT_EQ(page.ask("server.webcams.delete_item", {{"uid", entered["uid"]}})["error"]["code"], 404);
  EXPECT_TRUE(page.result("server.webcams.list")["webcams"].empty());
}

}  // namespace
}  // namespace kinebus::http
