// Who is let in, what is answered, and how long anybody is waited for.

#include "gateway/sessions/http/tests/http_rig.hpp"

namespace kinebus::http {
namespace {

using namespace std::chrono_literals;

TEST(Http, TheVersionIsWhatPrusaSlicerWantsOfBothKindsOfHosts) {
  HttpRig rig;
  const Response response = rig.get("/api/version");
  EXPECT_EQ(response.status, 200);
  EXPECT_TRUE(response.json().contains("api"));
  EXPECT_TRUE(response.json()["text"].get<std::string>().starts_with("OctoPrint"));
  EXPECT_TRUE(response.json()["capabilities"]["upload-by-put"].get<bool>());
  // PrusaSlicer looks at the first member.
  EXPECT_TRUE(rig.get("/api/v1/storage").body.starts_with("{\"storage_list\":[{"));
}

TEST(Http, OnlyWhoHasTheKeyAndAsksFromHereIsLetIn) {
  struct Case {
    std::string fields;
    int status;
  };
  const std::string key = std::string("X-Api-Key: ") + kKey + "\r\n";
  const Case cases[] = {
      {"Host: 10.0.0.7\r\n" + key, 200},
      {"Host: [fe80::1]:5000\r\n" + key, 200},
      {"Host: localhost:5000\r\n" + key, 200},
      {"Host: KineBus\r\n" + key, 200},
      {"Host: kinebus\r\nAuthorization: Bearer " + std::string(kKey) + "\r\n", 200},
      {"Host: kinebus:80\r\nOrigin: http://kinebus:80\r\n" + key, 200},
      {"Host: kinebus\r\n", 401},
      {"Host: kinebus\r\nX-Api-Key: 0123456789abcdeF\r\n", 401},
      {"Host: kinebus\r\nX-Api-Key: \r\n", 401},
      {key, 400},
      {"Host: kinebus\r\nHost: kinebus\r\n" + key, 400},
      {"Host: kinebus.example.org\r\n" + key, 403},
      {"Host: 127.0.0.1.example.org\r\n" + key, 403},
      {"Host: [::1\r\n" + key, 403},
      {"Host: kinebus\r\nOrigin: http://example.org\r\n" + key, 403},
      {"Host: kinebus\r\nOrigin: http://example.org/kinebus\r\n" + key, 403},
      {"Host: kinebus\r\nOrigin: null\r\n" + key, 403},
      {"Host: kinebus\r\nSec-Fetch-Site: cross-site\r\n" + key, 403},
      {"Host: kinebus\r\nExpect: a miracle\r\n" + key, 417},
  };
  HttpRig rig;
  for (const Case& c : cases) {
    const Response response = rig.ask("GET /api/job HTTP/1.1\r\n" + c.fields + "\r\n");
    EXPECT_EQ(response.status, c.status) << c.fields;
    EXPECT_EQ(response.json().contains("error"), c.status != 200) << response.body;
  }
}

TEST(Http, WrongPathsAndMethodsAreNamed) {
  HttpRig rig;
  EXPECT_EQ(rig.get("/").status, 404);
  EXPECT_EQ(rig.get("/api/files/local/a/b").status, 404);
  EXPECT_EQ(rig.get("/api/../etc/passwd").status, 400);
  EXPECT_EQ(rig.get("http://example.org/").status, 400);
  const Response wrong = rig.ask(HttpRig::head("PATCH", "/api/job") + "\r\n");
  EXPECT_EQ(wrong.status, 405);
  EXPECT_NE(wrong.head.find("Allow: GET, POST"), std::string::npos);
  EXPECT_EQ(rig.ask("nonsense\r\n\r\n").status, 400);
  EXPECT_EQ(rig.send("POST", "/api/job", "[1").status, 400);
  EXPECT_EQ(rig.send("POST", "/api/job", "{}").status, 400);
  EXPECT_EQ(rig.send("POST", "/api/job", std::string(70'000, '[')).status, 413);
  EXPECT_EQ(rig.ask(HttpRig::head("POST", "/api/job") + "Content-Type: text/plain\r\n" +
                    HttpRig::with_body("{\"command\":\"cancel\"}"))
                .status,
            415);
}

TEST(Http, RequestsOnOneConnectionAreAnsweredInTheirOrder) {
  HttpRig rig;
  Connection& connection = rig.connect();
  const std::string all = HttpRig::head("GET", "/api/server") + "\r\n" + HttpRig::head("GET", "/none") +
                          "\r\n" + HttpRig::head("HEAD", "/api/job") + "\r\n" +
                          HttpRig::head("GET", "/api/job") + "Connection: close\r\n\r\n";
  const Response first = rig.ask(connection, all);
  EXPECT_TRUE(first.json().contains("safemode"));
  EXPECT_EQ(connection.take().status, 404);
  const std::size_t end = connection.heard.find("\r\n\r\n");
  ASSERT_NE(end, std::string::npos);
  // HEAD: the length of what is not there.
  connection.heard.erase(0, end + 4);
  EXPECT_EQ(connection.take().json()["state"], "Offline");
  EXPECT_TRUE(connection.session->ended());
}

TEST(Http, NobodyIsWaitedForForEver) {
  HttpRig rig;
  Connection& silent = rig.connect();
  Connection& slow_head = rig.connect();
  Connection& slow_body = rig.connect();
  slow_head.to_send = "GET /api/job HTTP/1.1\r\nHost: ";
  slow_body.to_send = HttpRig::head("PUT", "/api/v1/files/local/a.gcode") + "Content-Length: 100\r\n\r\nG1";
  rig.pump();
  const BusTime begun = rig.link.machine.now;
  rig.run_until([&] { return slow_head.session->ended(); }, 60s);
  EXPECT_EQ(slow_head.take().status, 408);
  EXPECT_LT(rig.link.machine.now - begun, Session::kHeadWithin + 3s);
  rig.run_until([&] { return slow_body.session->ended() && silent.session->ended(); }, 120s);
  EXPECT_EQ(slow_body.take().status, 408);
  EXPECT_TRUE(silent.session->ended());
  EXPECT_EQ(silent.heard, "");
  EXPECT_EQ(rig.half_uploads(), 0);
}

// A deadline that has passed is due in every turn of the daemon's loop: the loop would run without a rest.
TEST(Http, WhoTakesNoAnswerOrTakesItSlowlyIsNotDueInEveryTurn) {
  const std::string ask = HttpRig::head("GET", "/api/printer") + "\r\n";
  for (const bool reads : {false, true})
    for (const std::string& behind : {std::string(), ask, std::string("GET /half")}) {
      HttpRig rig;
      const auto session = rig.server.open(rig.link.machine.now, "http 10.0.0.7", "tcp 10.0.0.7", {});
      const std::string all = ask + behind;
      session->on_bytes(rig.link.machine.now,
                        {reinterpret_cast<const std::uint8_t*>(all.data()), all.size()});
      std::size_t heard = 0;
      for (int i = 0; i < 400; ++i) {
        rig.link.machine.run_for(200ms);
        for (int turn = 0; turn < 4 && session->next_deadline() <= rig.link.machine.now; ++turn)
          session->on_time(rig.link.machine.now);
        EXPECT_GT(session->next_deadline(), rig.link.machine.now)
            << "at " << i / 5 << " s, reads " << reads << ", behind it " << behind;
        const std::size_t taken =
            reads && i % 5 == 0 ? std::min<std::size_t>(session->next_bytes().size(), 10) : 0;
        session->on_bytes_sent(taken);
        heard += taken;
      }
      EXPECT_EQ(heard > 0, reads);
      EXPECT_TRUE(reads || session->ended()) << "after 80 s";
    }
}

TEST(Http, AfterAPauseOfTheWholeComputerEverybodyHasTheirTimeAnew) {
  HttpRig rig;
  Connection& slow_head = rig.connect();
  Connection& slow_body = rig.connect();
  slow_head.to_send = "GET /api/job HTTP/1.1\r\nHost: ";
  slow_body.to_send = HttpRig::head("PUT", "/api/v1/files/local/a.gcode") + "Content-Length: 100\r\n\r\nG1";
  rig.pump();
  rig.link.machine.run_for(240s);
  for (const Connection* connection : {&slow_head, &slow_body})
    connection->session->on_absence(rig.link.machine.now);
  rig.pump();
  EXPECT_EQ(slow_head.heard, "");
  EXPECT_EQ(slow_body.heard, "");
  rig.run_until([&] { return slow_head.session->ended() && slow_body.session->ended(); }, 60s);
  EXPECT_EQ(slow_head.take().status, 408);
  EXPECT_EQ(slow_body.take().status, 408);
}

TEST(Http, ConnectionsThatWaitForNothingGiveWay) {
  HttpRig rig({}, 8);
  Connection& busy = rig.connect("tcp 10.0.0.9");
  busy.to_send = HttpRig::head("PUT", "/api/v1/files/local/a.gcode") + "Content-Length: 10\r\n\r\nG1 X1";
  rig.pump();
  for (int i = 0; i < 200; ++i) {
    rig.connect();
    std::size_t open = 0;
    for (const auto& connection : rig.connections) open += connection->session->ended() ? 0 : 1;
    ASSERT_LE(open, 8U);
  }
  Connection& late = rig.connect("tcp 10.0.0.8");
  EXPECT_EQ(rig.ask(late, HttpRig::head("GET", "/api/job") + "\r\n").status, 200);
  EXPECT_EQ(rig.ask(busy, "\nG1 X").status, 201);
}

TEST(Http, WhenAllPlacesWorkANewOneIsTurnedAway) {
  HttpRig rig({}, 2);
  std::vector<Connection*> busy;
  for (const char* name : {"a", "b"}) {
    busy.push_back(&rig.connect());
    busy.back()->to_send =
        HttpRig::head("PUT", std::string("/api/v1/files/local/") + name) + "Content-Length: 4\r\n\r\nG1";
  }
  rig.pump();
  Connection& third = rig.connect();
  rig.pump();
  EXPECT_EQ(third.take().status, 503);
  for (Connection* connection : busy) EXPECT_EQ(rig.ask(*connection, "\n\n").status, 201);
}

TEST(Http, TheStateIsToldInBothWays) {
  HttpRig rig;
  EXPECT_EQ(rig.get("/api/job").json()["state"], "Offline");
  EXPECT_EQ(rig.get("/api/v1/status").json()["printer"]["state"], "ATTENTION");
  EXPECT_EQ(rig.get("/api/v1/job").status, 204);
  ASSERT_TRUE(rig.link.machine.make_ready());
  rig.pump();
  const auto printer = rig.get("/api/printer").json();
  EXPECT_TRUE(printer["state"]["flags"]["ready"].get<bool>());
  EXPECT_FALSE(printer["state"]["flags"]["closedOrError"].get<bool>());
  EXPECT_TRUE(printer["temperature"].contains("tool0"));
  EXPECT_EQ(rig.get("/api/v1/status").json()["printer"]["state"], "IDLE");
  for (const char* path :
       {"/api/server", "/api/currentuser", "/api/settings", "/api/connection", "/api/printerprofiles",
        "/api/files", "/api/files/local?recursive=true", "/api/v1/info", "/api/v1/files/local"}) {
    const Response response = rig.get(path);
    EXPECT_EQ(response.status, 200) << path;
    EXPECT_TRUE(response.json().is_object()) << path;
  }
  EXPECT_EQ(rig.send("POST", "/api/login", "{\"passive\":true}").json()["name"], "kinebus");
  EXPECT_EQ(rig.send("POST", "/api/login", "{\"user\":\"a\",\"pass\":\"b\"}").status, 403);
}

std::string slow_job() {
  std::string text = "G21 G90\n";
  for (int i = 0; i < 40; ++i) text += i % 2 == 0 ? "G1 X10 F300\n" : "G1 X-10\n";
  return text;
}

TEST(Http, AJobIsPrintedPausedResumedAndCancelled) {
  HttpRig rig;
  ASSERT_TRUE(rig.link.machine.make_ready());
  EXPECT_EQ(rig.ask(HttpRig::head("PUT", "/api/v1/files/local/slow.gcode") + "Print-After-Upload: ?1\r\n" +
                    HttpRig::with_body(slow_job()))
                .status,
            201);
  const auto state = [&] { return rig.get("/api/job").json()["state"].get<std::string>(); };
  ASSERT_TRUE(rig.run_until([&] { return state() == "Printing"; }, 30s));
  const auto job = rig.get("/api/v1/job").json();
  EXPECT_EQ(job["state"], "PRINTING");
  EXPECT_EQ(job["file"]["name"], "slow.gcode");
  const std::string path = "/api/v1/job/" + std::to_string(job["id"].get<int>());
  EXPECT_EQ(rig.get("/api/job").json()["job"]["file"]["size"], slow_job().size());
  EXPECT_EQ(rig.send("DELETE", "/api/files/local/slow.gcode", "").status, 409);
  EXPECT_EQ(rig.send("PUT", "/api/v1/job/77/pause", "").status, 404);
  EXPECT_EQ(rig.send("PUT", path + "/pause", "").status, 204);
  ASSERT_TRUE(rig.run_until([&] { return state() == "Paused"; }, 30s));
  EXPECT_EQ(rig.send("POST", "/api/job", "{\"command\":\"pause\",\"action\":\"toggle\"}").status, 204);
  ASSERT_TRUE(rig.run_until([&] { return state() == "Printing"; }, 30s));
  EXPECT_EQ(rig.send("POST", "/api/job", "{\"command\":\"pause\",\"action\":\"pause\"}").status, 204);
  ASSERT_TRUE(rig.run_until([&] { return state() == "Paused"; }, 30s));
  EXPECT_EQ(rig.send("PUT", path + "/resume", "").status, 204);
  EXPECT_EQ(rig.send("POST", "/api/job", "{\"command\":\"cancel\"}").status, 204);
  ASSERT_TRUE(rig.run_until([&] { return state() == "Operational"; }, 60s));
  EXPECT_EQ(rig.send("POST", "/api/job", "{\"command\":\"cancel\"}").status, 409);
  // Nobody keeps control.
  EXPECT_EQ(rig.link.control.holder(), 0U);
  EXPECT_TRUE(rig.link.control.clients().empty());
  // It was selected by nobody: a start needs a file.
  EXPECT_EQ(rig.send("POST", "/api/job", "{\"command\":\"start\"}").status, 409);
  EXPECT_EQ(rig.send("POST", "/api/files/local/slow.gcode", "{\"command\":\"select\"}").status, 204);
  EXPECT_EQ(rig.send("POST", "/api/job", "{\"command\":\"start\"}").status, 204);
  EXPECT_EQ(state(), "Printing");
  EXPECT_EQ(rig.get("/api/v1/job").json()["id"].get<int>(), job["id"].get<int>() + 1);
}

TEST(Http, AJobThatIsRefusedSaysWhy) {
  HttpRig rig;
  const auto put = [&](const std::string& text) {
    return rig.ask(HttpRig::head("PUT", "/api/v1/files/local/a.gcode") +
                   "Overwrite: ?1\r\nPrint-After-Upload: ?1\r\n" + HttpRig::with_body(text));
  };
  const Response off = put("G1 X1\n");
  EXPECT_EQ(off.status, 409);
  EXPECT_FALSE(off.json()["error"].get<std::string>().empty());
  EXPECT_EQ(rig.stored("a.gcode"), "G1 X1\n");
  ASSERT_TRUE(rig.link.machine.make_ready());
  const Response far_away = put("G21\nG1 X9000 F1000\n");
  EXPECT_EQ(far_away.status, 409);
  EXPECT_NE(far_away.json()["error"].get<std::string>().find("line 2"), std::string::npos) << far_away.body;
  LinkedClient& anna = rig.link.connect("anna");
  rig.link.ask(anna, take_control());
  const Response foreign = put("G1 X1\n");
  EXPECT_EQ(foreign.status, 409);
  EXPECT_NE(foreign.json()["error"].get<std::string>().find("anna"), std::string::npos) << foreign.body;
  EXPECT_EQ(rig.send("POST", "/api/files/local/none", "{\"command\":\"select\",\"print\":true}").status, 404);
}

}  // namespace
}  // namespace kinebus::http
