// Files on their way from a request into the store, and out again.

#include "gateway/sessions/http/tests/http_rig.hpp"

namespace kinebus::http {
namespace {

std::string lines_of(std::size_t size) {
  std::string text;
  for (std::size_t i = 0; text.size() < size; ++i) text += "G1 X" + std::to_string(i % 97) + " F1200\r\n--";
  text.resize(size);
  return text;
}

/// As libcurl, and so PrusaSlicer and its relatives, write it.
std::string form(const std::string& file_name, const std::string& text, const std::string& print = "false",
                 const std::string& path = "") {
  const std::string boundary = "------------------------0123456789abcdef";
  const std::string field = "--" + boundary + "\r\nContent-Disposition: form-data; name=\"";
  const std::string body = field + "print\"\r\n\r\n" + print + "\r\n" + field + "path\"\r\n\r\n" + path +
                           "\r\n" + field + "file\"; filename=\"" + file_name +
                           "\"\r\nContent-Type: application/octet-stream\r\n\r\n" + text + "\r\n--" +
                           boundary + "--\r\n";
  return HttpRig::head("POST", "/api/files/local") +
         "Content-Type: multipart/form-data; boundary=" + boundary + "\r\n" + HttpRig::with_body(body);
}

std::string put(const std::string& name, const std::string& text, const std::string& fields = "") {
  return HttpRig::head("PUT", "/api/v1/files/local/" + name) + "Content-Type: text/x.gcode\r\n" + fields +
         HttpRig::with_body(text);
}

TEST(HttpUpload, AFormIsStoredByteForByteHoweverItComes) {
  HttpRig rig;
  for (const std::size_t piece : {1, 3, 97, 4000, 60'000}) {
    const std::string text = lines_of(piece < 90 ? 3000 : 700'000);
    const Response response = rig.ask(form("part a.gcode", text), piece);
    ASSERT_EQ(response.status, 201) << response.body;
    EXPECT_EQ(rig.stored("part a.gcode"), text);
    EXPECT_EQ(response.json()["files"]["local"]["name"], "part a.gcode");
    EXPECT_NE(response.head.find("Location: /api/files/local/part%20a.gcode"), std::string::npos);
  }
  const auto listed = rig.get("/api/files/local").json();
  ASSERT_EQ(listed["files"].size(), 1U);
  EXPECT_EQ(listed["files"][0]["size"], 700'000);
  EXPECT_EQ(rig.half_uploads(), 0);
}

TEST(HttpUpload, APutIsStoredWithALengthInChunksAndWhenItWaitsToBeAsked) {
  HttpRig rig;
  const std::string text = lines_of(500'000);
  EXPECT_EQ(rig.ask(put("a.gcode", text)).status, 201);
  EXPECT_EQ(rig.stored("a.gcode"), text);
  EXPECT_EQ(rig.ask(put("a.gcode", "G1")).status, 409);
  EXPECT_EQ(rig.stored("a.gcode"), text);
  EXPECT_EQ(rig.ask(put("a.gcode", "G1", "Overwrite: ?1\r\n")).status, 201);
  EXPECT_EQ(rig.stored("a.gcode"), "G1");
  EXPECT_EQ(rig.ask(HttpRig::head("PUT", "/api/v1/files/usb/b.gcode") +
                    "Transfer-Encoding: chunked\r\n\r\n4\r\nG1 X\r\n2\r\n5\n\r\n0\r\n\r\n")
                .status,
            201);
  EXPECT_EQ(rig.stored("b.gcode"), "G1 X5\n");
  EXPECT_EQ(rig.ask(put("empty.gcode", "")).status, 201);

  Connection& curl = rig.connect();
  const std::string request = put("c.gcode", "G1 X7\n", "Expect: 100-continue\r\n");
  const std::size_t body = request.find("\r\n\r\n") + 4;
  curl.to_send = request.substr(0, body);
  rig.pump();
  EXPECT_TRUE(curl.heard.starts_with("HTTP/1.1 100 Continue\r\n\r\n")) << curl.heard;
  curl.heard.clear();
  EXPECT_EQ(rig.ask(curl, request.substr(body)).status, 201);
  // Who may not store hears it before it sends anything.
  curl.to_send = request.substr(0, body);
  rig.pump();
  EXPECT_EQ(curl.take().status, 409);
}

TEST(HttpUpload, NoNameLeadsOutOfTheStore) {
  HttpRig rig;
  for (const char* name : {"..%2Fa", "%2Fetc%2Fpasswd", "a%00b", "a%0Ab", ".hidden", "%2E%2E", "a%5Cb",
                           "a%E2%80%AEb", "%FF%FE", "a/b", "..", ".", "%zz"})
    EXPECT_EQ(rig.ask(put(name, "G1\n")).status, 400) << name;
  for (const char* name : {"../a", "/etc/passwd", "a/b", ".hidden", "a\\\\b", "a\u202Eb", "\xFF", ""})
    EXPECT_EQ(rig.ask(form(name, "G1\n")).status, 400) << name;
  EXPECT_EQ(rig.ask(form("a", "G1\n", "false", "sub/folder")).status, 400);
  EXPECT_EQ(rig.ask(form("a", "G1\n", "false", "../..")).status, 400);
  EXPECT_EQ(rig.ask(HttpRig::head("PUT", "/api/v1/files/sd/a") + HttpRig::with_body("G1")).status, 404);
  EXPECT_EQ(rig.get("/api/files/local").json()["files"].size(), 0U);
  EXPECT_EQ(rig.half_uploads(), 0);
}

TEST(HttpUpload, AHalfUploadLeavesNothing) {
  HttpRig rig;
  const std::string whole = form("a.gcode", lines_of(400'000));
  for (std::size_t cut = 50; cut < whole.size(); cut = cut * 3 / 2) {
    Connection& connection = rig.connect();
    connection.to_send = whole.substr(0, cut);
    rig.pump();
    rig.cut(connection);
    EXPECT_EQ(rig.half_uploads(), 0) << cut;
  }
  // Cut before the worker has begun it.
  Connection& connection = rig.connect();
  connection.session->on_bytes(rig.link.machine.now,
                               {reinterpret_cast<const std::uint8_t*>(whole.data()), 2000});
  rig.cut(connection);
  EXPECT_EQ(rig.half_uploads(), 0);
  EXPECT_EQ(rig.get("/api/files/local").json()["files"].size(), 0U);
  // A length that lies: the rest is no request.
  Connection& liar = rig.connect();
  EXPECT_EQ(rig.ask(liar, HttpRig::head("PUT", "/api/v1/files/local/b") +
                              "Content-Length: 2\r\n\r\nG1 X9000\r\n\r\n")
                .status,
            201);
  EXPECT_EQ(rig.stored("b"), "G1");
  rig.pump();
  EXPECT_EQ(liar.take().status, 400);
}

TEST(HttpUpload, QuotaAndWrongFormsAreRefused) {
  HttpRig rig({.folder = {}, .quota_bytes = 100'000});
  EXPECT_EQ(rig.ask(put("a", lines_of(100'001))).status, 507);
  EXPECT_EQ(rig.ask(put("a", lines_of(90'000))).status, 201);
  std::string chunks = HttpRig::head("PUT", "/api/v1/files/local/b") + "Transfer-Encoding: chunked\r\n\r\n";
  for (int i = 0; i < 200; ++i) chunks += "400\r\n" + std::string(0x400, 'G') + "\r\n";
  EXPECT_EQ(rig.ask(chunks + "0\r\n\r\n").status, 507);
  EXPECT_EQ(rig.half_uploads(), 0);
  EXPECT_EQ(rig.get("/api/v1/storage").json()["storage_list"][0]["free_space"], 10'000);

  const std::string form_head = HttpRig::head("POST", "/api/files/local");
  EXPECT_EQ(rig.ask(form_head + HttpRig::with_body("G1")).status, 415);
  const std::string type = "Content-Type: multipart/form-data; boundary=B\r\n";
  const std::string part = "--B\r\nContent-Disposition: form-data; name=\"";
  EXPECT_EQ(rig.ask(form_head + type + HttpRig::with_body("no form")).status, 400);
  EXPECT_EQ(rig.ask(form_head + type + HttpRig::with_body(part + "print\"\r\n\r\ntrue\r\n--B--")).status,
            400);
  const std::string file = part + "file\"; filename=\"c\"\r\n\r\nG1\r\n";
  EXPECT_EQ(rig.ask(form_head + type + HttpRig::with_body(file)).status, 400);
  EXPECT_EQ(rig.ask(form_head + type + HttpRig::with_body(file + file + "--B--")).status, 400);
  EXPECT_EQ(rig.ask(form_head + type +
                    HttpRig::with_body(part + "path\"\r\n\r\n" + std::string(2000, 'a') + "\r\n--B--"))
                .status,
            400);
  EXPECT_EQ(rig.half_uploads(), 0);
  // The fields may follow the file.
  EXPECT_EQ(
      rig.ask(form_head + type + HttpRig::with_body(file + part + "select\"\r\n\r\ntrue\r\n--B--")).status,
      201);
  EXPECT_EQ(rig.server.selected, "c");
}

TEST(HttpUpload, WhatIsStoredIsReadAndDeletedAgain) {
  HttpRig rig;
  const std::string text = lines_of(300'000);
  ASSERT_EQ(rig.ask(put("a%20b.gcode", text)).status, 201);
  const auto file = rig.get("/api/v1/files/local/a%20b.gcode").json();
  EXPECT_EQ(file["size"], text.size());
  EXPECT_EQ(rig.get(file["refs"]["download"].get<std::string>()).body, text);
  EXPECT_EQ(rig.get("/api/files/local/a%20b.gcode").json()["name"], "a b.gcode");
  EXPECT_EQ(rig.send("DELETE", "/api/files/local/a%20b.gcode", "").status, 204);
  EXPECT_EQ(rig.send("DELETE", "/api/v1/files/local/a%20b.gcode", "").status, 404);
  EXPECT_EQ(rig.get("/api/files/local/a%20b.gcode").status, 404);
  EXPECT_EQ(rig.get("/downloads/files/local/a%20b.gcode").status, 404);
}

}  // namespace
}  // namespace kinebus::http
