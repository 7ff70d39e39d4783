// Websockets: frames as RFC 6455 wants them, and Kinebus's own API over them.

#include <algorithm>

#include "gateway/sessions/http/tests/socket_rig.hpp"
#include "protocol/joblink/version.hpp"

namespace kinebus::http {
namespace {

using namespace std::chrono_literals;
constexpr const char* kPath = "/kinebus/v1/socket";

/// `token`: in base64.
std::string hello(const std::string& token) {
  return R"({"request_id":7,"hello":{"client_name":"a page","version_major":)" +
         std::to_string(joblink::kVersionMajor) + R"(,"token":")" + token + R"("}})";
}

std::string fed(const std::string& bytes, std::size_t piece) {
  FrameReader reader;
  std::string story;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    std::string_view rest = std::string_view(bytes).substr(at, piece);
    while (!rest.empty()) {
      const FrameReader::Taken taken = reader.take(rest);
      rest.remove_prefix(taken.count);
      using Step = FrameReader::Step;
      if (taken.step == Step::kText) story += "text:" + std::string(reader.payload()) + " ";
      if (taken.step == Step::kPing) story += "ping:" + std::string(reader.payload()) + " ";
      if (taken.step == Step::kPong) story += "pong ";
      if (taken.step == Step::kClose)
        return story + "close:" + std::to_string(static_cast<int>(reader.code()));
      if (taken.step == Step::kBad) return story + "bad:" + std::to_string(static_cast<int>(reader.code()));
      if (taken.step == Step::kMore && taken.count == 0) break;
    }
  }
  return story;
}

TEST(WebSocket, FramesAreReadHoweverTheyAreCut) {
  struct Case {
    std::string bytes, story;
  };
  const std::string unmasked("\x81\x01x", 3), long_form("\x81\xFE\x00\x05\0\0\0\0abcde", 13);
  const std::string huge("\x81\xFF\0\0\0\0\0\x01\0\x01\0\0\0\0", 14);
  const Case cases[] = {
      {said("hi"), "text:hi "},
      {said(""), "text: "},
      {masked(0x01, "a") + masked(0x00, "b") + masked(0x89, "p") + masked(0x80, "c"), "ping:p text:abc "},
      {masked(0x8A, "") + said("x"), "pong text:x "},
      {masked(0x88, "\x03\xE8"), "close:1000"},
      {masked(0x88, ""), "close:1005"},
      {masked(0x88, "\x03"), "bad:1002"},
      {masked(0x88, "\x03\xED"), "bad:1002"},
      {masked(0x88, "\x03\xE8\xFF"), "bad:1007"},
      {masked(0x80, "a"), "bad:1002"},
      {masked(0x01, "a") + said("b"), "bad:1002"},
      {masked(0xC1, "a"), "bad:1002"},
      {masked(0x82, "a"), "bad:1003"},
      {masked(0x83, "a"), "bad:1002"},
      {masked(0x09, "a"), "bad:1002"},
      {masked(0x89, std::string(126, 'a')), "bad:1002"},
      {said("\xC3\x28"), "bad:1007"},
      {unmasked, "bad:1002"},
      {long_form, "bad:1002"},
      {huge, "bad:1009"},
      {masked(0x01, std::string(60'000, 'a')) + masked(0x80, std::string(6000, 'b')), "bad:1009"},
  };
  for (const Case& c : cases)
    for (const std::size_t piece : {c.bytes.size(), std::size_t{1}, std::size_t{7}})
      EXPECT_EQ(fed(c.bytes, piece), c.story) << piece;
}

TEST(WebSocket, TheHandshakeIsAnsweredAsInTheStandard) {
  HttpRig rig;
  Connection& wire = rig.connect();
  const Response response = rig.ask(wire, handshake(kPath, ""));
  EXPECT_EQ(response.status, 101);
  EXPECT_NE(response.head.find("Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo="), std::string::npos);
  EXPECT_EQ(rig.get(kPath).status, 426);
  EXPECT_EQ(rig.ask(handshake(kPath, "Origin: http://example.org\r\n")).status, 403);
  EXPECT_EQ(rig.ask(handshake(kPath, "Sec-Fetch-Site: cross-site\r\n")).status, 403);
  EXPECT_EQ(rig.ask(handshake("/api/job", "")).status, 401);
}

TEST(WebSocket, WhoDoesNotShowTheKeyIsNotHeard) {
  HttpRig rig;
  SocketClient client(rig, kPath, "");
  EXPECT_EQ(client.say(R"({"request_id":1,"get_status":{}})").at(0).json()["reply"]["error"]["code"],
            "ERROR_NOT_ALLOWED");
  const auto wrong = client.say(hello("YWJj"));
  ASSERT_EQ(wrong.size(), 2U);
  EXPECT_EQ(wrong[1].opcode, Opcode::kClose);
  EXPECT_EQ(wrong[1].code(), 1008U);
  EXPECT_TRUE(client.wire.session->ended());

  SocketClient silent(rig, kPath, "");
  const auto heard = silent.hear(12s);
  ASSERT_FALSE(heard.empty());
  EXPECT_EQ(heard.back().code(), 1008U);
}

TEST(WebSocket, AfterAPauseOfTheWholeComputerNobodyIsGone) {
  HttpRig rig;
  SocketClient client(rig, kPath), late(rig, kPath, "");
  rig.link.machine.run_for(240s);
  for (const SocketClient* one : {&client, &late}) one->wire.session->on_absence(rig.link.machine.now);
  rig.pump();
  EXPECT_FALSE(client.wire.session->ended());
  EXPECT_FALSE(late.wire.session->ended());
  EXPECT_FALSE(client.say(R"({"request_id":1,"get_status":{}})").empty());
}

TEST(WebSocket, TheKeyInTheHelloLetsIn) {
  HttpRig rig;
  SocketClient client(rig, kPath, "");
  // "0123456789abcdef" in base64.
  const auto heard = client.say(hello("MDEyMzQ1Njc4OWFiY2RlZg=="));
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(heard[0].json()["reply"]["request_id"], 7);
  EXPECT_NE(heard[0].json()["reply"]["hello"]["client_id"], 0);
  const auto status = client.say(R"({"request_id":8,"get_status":{}})").at(0).json()["reply"]["status"];
  EXPECT_EQ(status["state"], "STATE_OFF");
  EXPECT_EQ(status["clients"][0]["name"], "a page");
}

TEST(WebSocket, CommandsMoveTheMachineAndNewsAreHeard) {
  HttpRig rig;
  SocketClient client(rig, kPath);
  client.say(R"({"request_id":1,"watch":{"status_hz":10,"events":true}})");
  const auto done = client.say(R"({"request_id":2,"bring_up":{}})");
  const auto reply = std::find_if(done.begin(), done.end(), [](const Heard& h) {
    return h.json().contains("reply") && h.json()["reply"]["request_id"] == 2;
  });
  ASSERT_NE(reply, done.end());
  EXPECT_FALSE(reply->json()["reply"].contains("error")) << reply->payload;
  bool unhomed = false, told = false;
  for (const Heard& h : client.hear(10s)) {
    const auto message = h.json();
    if (message.contains("status")) unhomed = unhomed || message["status"]["state"] == "STATE_UNHOMED";
    if (message.contains("event")) told = told || message["event"]["state"] == "STATE_UNHOMED";
  }
  EXPECT_TRUE(unhomed);
  EXPECT_TRUE(told);
  // Control was taken for the request alone: others may command.
  EXPECT_EQ(rig.link.control.holder(), 0U);
  client.say(R"({"request_id":3,"take_control":{}})");
  EXPECT_NE(rig.link.control.holder(), 0U);
  EXPECT_EQ(rig.send("POST", "/kinebus/v1/home", "{}").status, 409);
  EXPECT_EQ(rig.send("POST", "/kinebus/v1/stop", "{}").status, 204);
  rig.cut(client.wire);
  EXPECT_EQ(rig.link.control.holder(), 0U);
}

TEST(WebSocket, WhoReadsSlowlyHearsTheNewestAndCostsNoMemory) {
  HttpRig rig;
  Connection& wire = rig.connect();
  rig.ask(wire, handshake(kPath, "X-Api-Key: " + std::string(kKey) + "\r\n"));
  wire.to_send = said(R"({"request_id":1,"watch":{"status_hz":20,"events":true}})");
  rig.pump();
  // It takes nothing for 20 s.
  ByteSession& session = *wire.session;
  const auto held = std::move(wire.session);
  std::size_t most = 0;
  rig.run_until(
      [&] {
        if (rig.link.machine.now >= session.next_deadline()) session.on_time(rig.link.machine.now);
        most = std::max(most, session.next_bytes().size());
        return session.ended();
      },
      20s);
  EXPECT_FALSE(session.ended());
  EXPECT_GT(most, Socket::kNewsBacklog / 2);
  EXPECT_LT(most, 2 * Socket::kNewsBacklog);
  // After 30 s it is let go.
  EXPECT_TRUE(rig.run_until(
      [&] {
        if (rig.link.machine.now >= session.next_deadline()) session.on_time(rig.link.machine.now);
        return session.ended();
      },
      20s));
}

TEST(WebSocket, WhoSaysNothingIsPingedAndWhoDoesNotAnswerIsGone) {
  HttpRig rig;
  SocketClient client(rig, kPath);
  const auto heard = client.hear(25s);
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(heard[0].opcode, Opcode::kPing);
  client.send(masked(0x8A, ""));
  EXPECT_TRUE(client.hear(15s).empty());
  EXPECT_EQ(client.send(masked(0x89, "you?")).at(0).payload, "you?");
  client.hear(60s);
  EXPECT_TRUE(client.wire.session->ended());
}

TEST(WebSocket, ThereIsAlwaysRoomForRequestsAndForWhoHasTheKey) {
  HttpRig rig;
  // Without the key they give way.
  for (int i = 0; i < 30; ++i) SocketClient(rig, kPath, "");
  std::vector<std::unique_ptr<SocketClient>> let_in;
  for (int i = 0; i < 20; ++i) let_in.push_back(std::make_unique<SocketClient>(rig, kPath));
  EXPECT_EQ(rig.ask(handshake(kPath, "X-Api-Key: " + std::string(kKey) + "\r\n")).status, 503);
  EXPECT_EQ(rig.get("/api/version").status, 200);
  for (const auto& client : let_in) EXPECT_FALSE(client->wire.session->ended());
}

TEST(KinebusApi, RequestsAreThoseOfTheJobLink) {
  HttpRig rig;
  EXPECT_EQ(rig.get("/kinebus/v1/get_status").json()["state_words"], "off");
  EXPECT_TRUE(rig.get("/kinebus/v1/get_machine").json()["joints"].is_array());
  EXPECT_TRUE(rig.get("/kinebus/v1/get_events?after_id=0&alarms_only=true").json()["events"].is_array());
  EXPECT_EQ(rig.get("/kinebus/v1/get_events?after=0").status, 400);
  EXPECT_EQ(rig.get("/kinebus/v1/home").status, 405);
  EXPECT_EQ(rig.get("/kinebus/v1/upload_begin").status, 404);
  EXPECT_EQ(rig.send("POST", "/kinebus/v1/jog", R"({"delta":{"x_mm":1}})").status, 409);
  EXPECT_EQ(rig.send("POST", "/kinebus/v1/jog", R"({"delta":{"x_inch":1}})").status, 400);
  EXPECT_EQ(rig.send("POST", "/kinebus/v1/jog", R"({"delta":"x"})").status, 400);
  EXPECT_EQ(rig.send("POST", "/kinebus/v1/console", R"({"line":"M115"})").status, 200);
}

TEST(KinebusApi, ItsDescriptionNamesEveryRequestAndAllThatItRefersTo) {
  HttpRig rig;
  const auto described = rig.get("/kinebus/v1/openapi.json").json();
  EXPECT_EQ(described["openapi"], "3.0.3");
  for (const char* path : {"get_status", "jog", "start_job", "stop", "get_history"})
    EXPECT_TRUE(described["paths"].contains(std::string("/kinebus/v1/") + path)) << path;
  const std::string text = described.dump(), mark = "\"$ref\":\"#/components/schemas/";
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
    const std::size_t from = at + mark.size();
    const std::string name = text.substr(from, text.find('"', from) - from);
    EXPECT_TRUE(described["components"]["schemas"].contains(name)) << name;
  }
}

TEST(KinebusApi, JsonIsAsProtobufMapsIt) {
  HttpRig rig;
  const auto events = rig.get("/kinebus/v1/get_events").json()["events"];
  for (const auto& event : events) EXPECT_TRUE(event["id"].is_string());
  EXPECT_TRUE(rig.get("/kinebus/v1/read_machine_file").json()["sha256"].is_string());
}

}  // namespace
}  // namespace kinebus::http
