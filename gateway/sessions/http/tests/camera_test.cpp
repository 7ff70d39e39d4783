// Cameras of the machine file, as the page and Moonraker's clients hear of them.

#include "gateway/sessions/http/tests/moonraker_page.hpp"

namespace kinebus::http {
namespace {

using nlohmann::json;

class Cameras : public ::testing::Test {
 protected:
  static MachineDescription with_cameras() {
    MachineDescription machine = default_m1();
    machine.cameras = {{.name = "door", .stream = "https://cam.local:8443/s?x=1", .snapshot = ""},
                       {.name = "nozzle", .stream = ":8081/stream", .snapshot = ":8081/snapshot"}};
    return machine;
  }
  std::string policy_for(const std::string& host) {
    const Response page = rig.ask("GET / HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
    EXPECT_EQ(page.status, 200) << page.body;
    const std::size_t begin = page.head.find("img-src");
    return begin == std::string::npos ? page.head
                                      : page.head.substr(begin, page.head.find(';', begin) - begin);
  }
  const Pages pages{
      {"index.html", {.type = "text/html; charset=utf-8", .bytes = "<p>", .gzip = "", .mark = "1"}}};
  HttpRig rig{{}, 32, Users(kKey), with_cameras(), pages};
};

TEST_F(Cameras, AreWhereThePageMayTakePicturesFrom) {
  EXPECT_EQ(policy_for("kinebus:5000"),
            "img-src 'self' data: blob: https://cam.local:8443 http://kinebus:8081");
  EXPECT_EQ(policy_for("[::1]"), "img-src 'self' data: blob: https://cam.local:8443 http://[::1]:8081");
  HttpRig blind({}, 32, Users(kKey), default_m1(), pages);
  const Response page = blind.get("/");
  EXPECT_NE(page.head.find("img-src 'self' data: blob:;"), std::string::npos) << page.head;
}

TEST_F(Cameras, AreToldToMoonrakersClientsWhoMayNotChangeThem) {
  WebPage page(rig);
  const json door = page.result("server.webcams.get_item", {{"name", "door"}})["webcam"];
  EXPECT_EQ(door["stream_url"], "https://cam.local:8443/s?x=1");
  EXPECT_EQ(door["source"], "config");
  const json nozzle = page.result("server.webcams.get_item", {{"name", "nozzle"}})["webcam"];
  EXPECT_EQ(nozzle["stream_url"], "http://kinebus:8081/stream");
  EXPECT_EQ(nozzle["snapshot_url"], "http://kinebus:8081/snapshot");
  page.result("server.webcams.post_item", {{"name", "top"}, {"stream_url", "/webcam"}});
  EXPECT_EQ(page.result("server.webcams.list")["webcams"].size(), 3U);
  for (const json& which : {json{{"name", "door"}}, json{{"uid", door["uid"]}}}) {
    EXPECT_EQ(page.ask("server.webcams.post_item", which)["error"]["code"], 400) << which;
    EXPECT_EQ(page.ask("server.webcams.delete_item", which)["error"]["code"], 400) << which;
  }
  EXPECT_EQ(page.result("server.webcams.list")["webcams"].size(), 3U);
}

TEST_F(Cameras, TheFirstIsToldToOctoPrintsClients) {
  const auto webcam = [](HttpRig& of, const std::string& host) {
    return of.ask("GET /api/settings HTTP/1.1\r\nHost: " + host + "\r\nX-Api-Key: " + kKey + "\r\n\r\n")
        .json()["webcam"];
  };
  const json door = webcam(rig, "kinebus:5000");
  EXPECT_EQ(door, json({{"webcamEnabled", true},
                        {"streamUrl", "https://cam.local:8443/s?x=1"},
                        {"snapshotUrl", ""},
                        {"flipH", false},
                        {"flipV", false},
                        {"rotate90", false}}));
  MachineDescription machine = default_m1();
  machine.cameras = {{.name = "nozzle", .stream = ":8081/stream", .snapshot = ":8081/snapshot"}};
  HttpRig near({}, 32, Users(kKey), machine);
  const json nozzle = webcam(near, "[::1]:5000");
  EXPECT_EQ(nozzle["streamUrl"], "http://[::1]:8081/stream");
  EXPECT_EQ(nozzle["snapshotUrl"], "http://[::1]:8081/snapshot");
  HttpRig blind;
  EXPECT_EQ(webcam(blind, "kinebus")["webcamEnabled"], false);
  EXPECT_EQ(webcam(blind, "kinebus")["streamUrl"], "");
}

}  // namespace
}  // namespace kinebus::http
