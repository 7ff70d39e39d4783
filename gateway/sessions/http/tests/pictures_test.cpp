// Pictures and facts of slicers, as each API has them.

#include "gateway/jobs/store/tests/sliced_job.hpp"
#include "gateway/sessions/http/tests/moonraker_page.hpp"

namespace kinebus::http {
namespace {

using nlohmann::json;

class Pictures : public ::testing::Test {
 protected:
  void store(const std::string& name, const std::string& text) {
    const Response response = rig.ask(HttpRig::head("PUT", "/api/v1/files/local/" + name) +
                                      "Content-Type: text/x.gcode\r\n" + HttpRig::with_body(text));
    ASSERT_EQ(response.status, 201) << response.body;
  }
  /// A picture under `path`, as it must be answered.
  void expect_picture(const std::string& path, const std::string& bytes,
                      const std::string& type = "image/png") {
    const Response response = rig.get(path);
    EXPECT_EQ(response.status, 200) << path << response.body;
    EXPECT_TRUE(response.body == bytes) << path;
    EXPECT_NE(response.head.find("Content-Type: " + type), std::string::npos) << response.head;
    EXPECT_NE(response.head.find("X-Content-Type-Options: nosniff"), std::string::npos) << response.head;
  }
  HttpRig rig;
  const std::string great = png_of(220, 124, 5000), icon = png_of(16, 16);
};

TEST_F(Pictures, OfMoonraker) {
  store("a%20b.gcode", prusa_job());
  WebPage page(rig);
  const json file = page.result("server.files.metadata", {{"filename", "a b.gcode"}});
  EXPECT_EQ(file["slicer"], "PrusaSlicer");
  EXPECT_EQ(file["slicer_version"], "2.9.4+linux-x64");
  EXPECT_EQ(file["estimated_time"], 93'784);
  EXPECT_EQ(file["filament_total"], 1334.5);
  EXPECT_EQ(file["filament_weight_total"], 3.68);
  EXPECT_EQ(file["filament_type"], "PLA;PETG");
  EXPECT_EQ(file["layer_height"], 0.2);
  EXPECT_EQ(file["first_layer_height"], 0.25);
  EXPECT_EQ(file["object_height"], 2.0);
  EXPECT_EQ(file["nozzle_diameter"], 0.4);
  EXPECT_EQ(file["first_layer_extr_temp"], 215.0);
  EXPECT_EQ(file["first_layer_bed_temp"], 60.0);
  ASSERT_EQ(file["thumbnails"].size(), 2U);
  EXPECT_EQ(file["thumbnails"][1], json({{"width", 220},
                                         {"height", 124},
                                         {"size", great.size()},
                                         {"relative_path", ".thumbs/a b.gcode-220x124.png"}}));
  expect_picture("/server/files/gcodes/.thumbs/a%20b.gcode-220x124.png?timestamp=1", great);
  expect_picture("/server/files/gcodes/.thumbs/a%20b.gcode-16x16.png", icon);
  const json list = rig.get("/server/files/thumbnails?filename=a%20b.gcode").json()["result"];
  EXPECT_EQ(list[0]["thumbnail_path"], ".thumbs/a b.gcode-16x16.png");
  for (const char* path : {"a%20b.gcode-17x16.png", "a%20b.gcode-16.png", "c.gcode-16x16.png", "-", "x",
                           "a%20b.gcode-16x16x.png", "a%20b.gcode-x.png", "%2e%2e%2fa-1x1.png"})
    EXPECT_EQ(rig.get(std::string("/server/files/gcodes/.thumbs/") + path).status, 404) << path;
  // What no slicer has written is not there.
  store("hand.gcode", "G21\n");
  const json plain = page.result("server.files.metadata", {{"filename", "hand.gcode"}});
  EXPECT_FALSE(plain.contains("thumbnails") || plain.contains("slicer") || plain.contains("layer_height"));
}

TEST_F(Pictures, OfPrusaLink) {
  store("part.gcode", picture_block("thumbnail_JPG begin 48x48", jpeg_of(48, 48)) + prusa_job());
  const json refs = rig.get("/api/v1/files/usb/part.gcode").json()["refs"];
  EXPECT_EQ(refs["icon"], "/thumb/s/local/part.gcode");
  EXPECT_EQ(rig.get("/api/v1/files/local").json()["children"][0]["refs"], refs);
  // 16 x 16 is an icon on a printer's own display.
  expect_picture(refs["icon"].get<std::string>(), jpeg_of(48, 48), "image/jpeg");
  expect_picture(refs["thumbnail"].get<std::string>(), great);
  expect_picture("/thumb/l/usb/part.gcode", great);
  for (const char* path : {"/thumb/x/usb/part.gcode", "/thumb/l/card/part.gcode", "/thumb/l/usb/none.gcode"})
    EXPECT_EQ(rig.get(path).status, 404) << path;
  EXPECT_EQ(rig.ask("GET /thumb/l/usb/part.gcode HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 401);
  store("hand.gcode", "G21\n");
  EXPECT_FALSE(rig.get("/api/v1/files/local/hand.gcode").json()["refs"].contains("thumbnail"));
  EXPECT_EQ(rig.get("/thumb/l/usb/hand.gcode").status, 404);
}

TEST_F(Pictures, OfOctoPrint) {
  store("a%20b.gcode", prusa_job());
  const json file = rig.get("/api/files/local/a%20b.gcode").json();
  EXPECT_EQ(file["gcodeAnalysis"]["estimatedPrintTime"], 93'784);
  EXPECT_EQ(file["gcodeAnalysis"]["filament"]["tool0"]["length"], 1334.5);
  const auto path = file["thumbnail"].get<std::string>();
  EXPECT_TRUE(path.starts_with("plugin/prusaslicerthumbnails/thumbnail/a%20b.png?")) << path;
  expect_picture("/" + path, great);
  EXPECT_EQ(rig.get("/plugin/prusaslicerthumbnails/thumbnail/none.png").status, 404);
  rig.send("POST", "/api/files/local/a%20b.gcode", R"({"command":"select"})");
  const json job = rig.get("/api/job").json()["job"];
  EXPECT_EQ(job["estimatedPrintTime"], 93'784);
  EXPECT_EQ(job["filament"]["tool0"]["length"], 1334.5);
}

TEST_F(Pictures, AreSentAgainOnlyWhenTheJobIsAnother) {
  store("a.gcode", prusa_job());
  const auto mark_of = [](const Response& response) {
    const std::size_t at = response.head.find("ETag: ") + 6;
    return response.head.substr(at, response.head.find("\r\n", at) - at);
  };
  const std::string mark = mark_of(rig.get("/thumb/l/local/a.gcode"));
  const auto ask = [&] {
    return rig.ask(HttpRig::head("GET", "/thumb/l/local/a.gcode") + "If-None-Match: " + mark + "\r\n\r\n")
        .status;
  };
  EXPECT_EQ(ask(), 304);
  rig.ask(HttpRig::head("DELETE", "/api/v1/files/local/a.gcode") + "\r\n");
  store("a.gcode", prusa_job(11));
  EXPECT_EQ(ask(), 200);
}

TEST_F(Pictures, AreInTheListOfTheJobLink) {
  store("a.gcode", prusa_job());
  const json job = rig.send("POST", "/kinebus/v1/list_jobs", "{}").json()["jobs"][0];
  EXPECT_EQ(job["notes"]["filament_g"], 3.68) << job;
  EXPECT_EQ(job["notes"]["pictures"][1]["width_px"], 220);
}

}  // namespace
}  // namespace kinebus::http
