// Who may ask for what: keys with roles, and networks without.

#include "gateway/sessions/http/users.hpp"

#include "gateway/sessions/http/tests/socket_rig.hpp"

namespace kinebus::http {
namespace {

constexpr const char* kWatchKey = "a-key-that-watches";
constexpr const char* kOperateKey = "a-key-that-operates";
constexpr const char* kFile = R"(
[[user]]
name = "wall"
role = "watch"
key = "a-key-that-watches"
[[user]]
name = "anna"
role = "operate"
key = "a-key-that-operates"
[[trusted]]
network = "10.0.0.0/24"
role = "operate"
[[trusted]]
network = "fd00:7::/32"
role = "watch"
)";

std::string wrong_of(const std::string& toml) {
  const auto read = Users::read(kKey, toml);
  return read ? std::string() : read.error();
}

TEST(Users, AreReadWithTheirRoles) {
  const auto users = Users::read(kKey, kFile);
  ASSERT_TRUE(users) << users.error();
  ASSERT_NE(users->by_key(kKey), nullptr);
  EXPECT_EQ(users->by_key(kKey)->visitor.role, Role::kAdminister);
  EXPECT_EQ(users->by_key(kWatchKey)->visitor.role, Role::kWatch);
  EXPECT_EQ(users->by_key(kOperateKey)->visitor.name, "anna");
  for (const char* key : {"", "0123456789abcdeF", "a-key-that-watches "})
    EXPECT_EQ(users->by_key(key), nullptr) << key;

  EXPECT_EQ(users->role_at("10.0.0.255"), Role::kOperate);
  EXPECT_EQ(users->role_at("::ffff:10.0.0.1"), Role::kOperate);
  EXPECT_EQ(users->role_at("fd00:7:ffff::1"), Role::kWatch);
  for (const char* stranger :
       {"10.0.1.0", "9.255.255.255", "fd00:8::1", "", "local", "10.0.0.1 ", "010.0.0.1"})
    EXPECT_EQ(users->role_at(stranger), Role::kNobody) << stranger;
}

TEST(Users, WhatIsWrongWithAFileIsNamed) {
  const std::string user = "[[user]]\nname=\"a\"\nrole=\"watch\"\nkey=\"0123456789abcdefg\"\n";
  EXPECT_EQ(wrong_of(user), "");
  const std::pair<std::string, const char*> cases[] = {
      {"[[user]\n", "line 1"},
      {"[user]\nname=\"a\"", "expected [[user]]"},
      {"user = [1]", "expected [[user]]"},
      {"key = \"0123456789abcdefg\"", "there is no 'key'"},
      {user + "colour=\"red\"", "line 1: there is no key 'colour' here (name, role, key)"},
      {"[[user]]\nname=\"a\"\nrole=\"watch\"", "'key' is missing"},
      {"[[user]]\nname=\"a\"\nrole=1\nkey=\"0123456789abcdefg\"", "'role' is missing, or no text"},
      {"[[user]]\nname=\"a\"\nrole=\"root\"\nkey=\"0123456789abcdefg\"", "there is no role 'root'"},
      {"[[user]]\nname=\"a\"\nrole=\"watch\"\nkey=\"short\"", "the key of 'a' is too short"},
      {"[[user]]\nname=\"\"\nrole=\"watch\"\nkey=\"0123456789abcdefg\"", "a user has a name"},
      {user + user, "'a' has the name or the key of another"},
      {std::string("[[user]]\nname=\"a\"\nrole=\"watch\"\nkey=\"") + kKey + "\"", "or the key of another"},
      {"[[trusted]]\nnetwork=\"10.0.0.1\"\nrole=\"watch\"", "'10.0.0.1' is no network"},
      {"[[trusted]]\nnetwork=\"10.0.0.1/33\"\nrole=\"watch\"", "is no network"},
      {"[[trusted]]\nnetwork=\"10.0.0.1/8x\"\nrole=\"watch\"", "is no network"},
      {"[[trusted]]\nnetwork=\"home/8\"\nrole=\"watch\"", "is no network"},
      {"[[trusted]]\nnetwork=\"0.0.0.0/0\"\nrole=\"watch\"", "too wide to be trusted"},
      {"[[trusted]]\nnetwork=\"::/0\"\nrole=\"watch\"", "too wide to be trusted"},
      {"[[trusted]]\nnetwork=\"10.0.0.0/8\"\nrole=\"administer\"", "who administers shows a key"},
  };
  for (const auto& [toml, expected] : cases)
    EXPECT_NE(wrong_of(toml).find(expected), std::string::npos) << toml << "\n" << wrong_of(toml);
}

/// A machine whose users are those of kFile. Its clients come from 192.168.0.1 unless said otherwise.
struct UsersRig : HttpRig {
  UsersRig() : HttpRig({}, 32, *Users::read(kKey, kFile)) { address = "192.168.0.1"; }
  Response with(const std::string& key, const std::string& method, const std::string& path,
                const std::string& body = {}) {
    std::string request = method + " " + path + " HTTP/1.1\r\nHost: 127.0.0.1:5000\r\n";
    if (!key.empty()) request += "X-Api-Key: " + key + "\r\n";
    request += body.empty() ? "\r\n" : "Content-Type: application/json\r\n" + with_body(body);
    return ask(request);
  }
};

TEST(Roles, WhoWatchesSeesAllAndChangesNothing) {
  UsersRig rig;
  for (const char* seen : {"/api/printer", "/api/files", "/api/v1/status", "/printer/info", "/metrics",
                           "/kinebus/v1/get_status", "/kinebus/v1/read_machine_file"})
    EXPECT_EQ(rig.with(kWatchKey, "GET", seen).status, 200) << seen;
  const std::tuple<const char*, const char*, const char*> commands[] = {
      {"POST", "/kinebus/v1/home", "{}"},
      {"POST", "/api/printer/printhead", R"({"command":"home"})"},
      {"POST", "/api/printer/command", R"({"command":"G28"})"},
      {"POST", "/api/printer/bed", R"({"command":"target","target":40})"},
      {"POST", "/api/files/local/a.gcode", R"({"command":"select"})"},
      {"POST", "/api/job", R"({"command":"pause"})"},
      {"POST", "/server/database/item", R"({"namespace":"a","key":"b","value":1})"},
      {"DELETE", "/server/webcams/item?name=a", ""},
      {"POST", "/api/system/commands/core/restart", "{}"},
  };
  for (const auto& [method, path, body] : commands)
    EXPECT_EQ(rig.with(kWatchKey, method, path, body).status, 403) << path;
  const std::string put = "PUT /api/v1/files/local/a.gcode HTTP/1.1\r\nHost: 127.0.0.1:5000\r\nX-Api-Key: " +
                          std::string(kWatchKey) + "\r\nContent-Type: text/x.gcode\r\n";
  EXPECT_EQ(rig.ask(put + HttpRig::with_body("G28\n")).status, 403);
  EXPECT_EQ(rig.half_uploads(), 0);
  EXPECT_EQ(rig.with(kOperateKey, "GET", "/api/v1/files/local/a.gcode").status, 404);

  const nlohmann::json me = rig.with(kWatchKey, "GET", "/api/currentuser").json();
  EXPECT_EQ(me["name"], "wall");
  EXPECT_EQ(me["admin"], false);
  // Whoever sees that it must.
  EXPECT_EQ(rig.with(kWatchKey, "POST", "/kinebus/v1/stop", "{}").status, 204);
}

TEST(Roles, WhoOperatesLeavesTheMachineAsItIsSetUp) {
  UsersRig rig;
  EXPECT_EQ(rig.with(kOperateKey, "POST", "/api/printer/bed", R"({"command":"target","target":40})").status,
            204);
  for (const char* path : {"/kinebus/v1/restart_gateway", "/kinebus/v1/write_machine_file",
                           "/kinebus/v1/tune_heater", "/kinebus/v1/set_motor_currents"})
    EXPECT_EQ(rig.with(kOperateKey, "POST", path, "{}").status, 403) << path;
  EXPECT_NE(rig.with(kKey, "POST", "/kinebus/v1/set_motor_currents", "{}").status, 403);
}

TEST(Roles, ATrustedNetworkNeedsNoKey) {
  UsersRig rig;
  rig.link.machine.make_ready();
  EXPECT_EQ(rig.with("", "GET", "/api/printer").status, 401);
  rig.address = "10.0.0.9";
  EXPECT_EQ(rig.with("", "GET", "/api/printer").status, 200);
  EXPECT_EQ(rig.with("", "POST", "/kinebus/v1/restart_gateway", "{}").status, 403);
  // A key that says more counts.
  EXPECT_NE(rig.with(kKey, "POST", "/kinebus/v1/write_machine_file", "{}").status, 403);
  // And a wrong one takes nothing away.
  EXPECT_EQ(rig.with("0123456789abcdeF", "GET", "/api/printer").status, 200);
  // Neither is a page of another server let in from there.
  const std::string head = "GET /api/printer HTTP/1.1\r\nHost: 127.0.0.1:5000\r\n";
  EXPECT_EQ(rig.ask(head + "Origin: http://elsewhere\r\n\r\n").status, 403);
  // Nor is a link on one followed, where a GET commands; old browsers do not say where it was.
  const std::string script =
      "GET /printer/gcode/script?script=M140%20S40 HTTP/1.1\r\nHost: 127.0.0.1:5000\r\n";
  EXPECT_EQ(rig.ask(script + "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: navigate\r\n\r\n").status, 400);
  EXPECT_EQ(rig.ask(script + "User-Agent: Mozilla/5.0\r\n\r\n").status, 400);
  const Response scripted = rig.ask(script + "User-Agent: axios/1.8\r\n\r\n");
  EXPECT_EQ(scripted.status, 200) << scripted.body;
  rig.address = "fd00:7::9";
  EXPECT_EQ(rig.with("", "GET", "/api/printer").status, 200);
  EXPECT_EQ(rig.with("", "POST", "/kinebus/v1/home", "{}").status, 403);
}

TEST(Roles, AWebsocketHasThoseOfItsHello) {
  UsersRig rig;
  SocketClient wall(rig, "/kinebus/v1/socket", "");
  const std::string token = "YS1rZXktdGhhdC13YXRjaGVz";  // kWatchKey in base64
  const nlohmann::json hello =
      wall.say(R"({"request_id":1,"hello":{"version_major":2,"token":")" + token + R"("}})").at(0).json();
  EXPECT_EQ(hello["reply"]["hello"]["role"], "watch") << hello;
  EXPECT_EQ(wall.say(R"({"request_id":2,"home":{}})").at(0).json()["reply"]["error"]["code"],
            "ERROR_NOT_ALLOWED");

  rig.address = "10.0.0.9";
  SocketClient trusted(rig, "/kinebus/v1/socket", "");
  EXPECT_EQ(
      trusted.say(R"({"request_id":1,"hello":{"version_major":2}})").at(0).json()["reply"]["hello"]["role"],
      "operate");
}

TEST(Roles, WhoMayNotEvenStopRanksWithTheStrangers) {
  using Rank = ByteSession::Rank;
  UsersRig rig;
  const auto rank_after = [&](const std::string& key, int status) {
    Connection& connection = rig.connect();
    EXPECT_EQ(connection.session->rank(), Rank::kAny);
    const std::string field = key.empty() ? key : "X-Api-Key: " + key + "\r\n";
    const std::string request = "GET /api/job HTTP/1.1\r\nHost: 127.0.0.1:5000\r\n" + field + "\r\n";
    EXPECT_EQ(rig.ask(connection, request).status, status);
    return connection.session->rank();
  };
  EXPECT_EQ(rank_after("", 401), Rank::kAny);
  EXPECT_EQ(rank_after("a-key-that-nobody-has", 401), Rank::kAny);
  EXPECT_EQ(rank_after(kWatchKey, 200), Rank::kMayStop);
  SocketClient stranger(rig, "/websocket", "");
  EXPECT_EQ(stranger.wire.session->rank(), Rank::kAny);
  SocketClient wall(rig, "/kinebus/v1/socket", kWatchKey);
  EXPECT_EQ(wall.wire.session->rank(), Rank::kMayStop);
  SocketClient anna(rig, "/kinebus/v1/socket", kOperateKey);
  anna.say(R"({"request_id":1,"hello":{"version_major":2}})");
  anna.say(R"({"request_id":2,"take_control":{}})");
  EXPECT_EQ(anna.wire.session->rank(), Rank::kInControl);
  anna.wire.session->on_closed(rig.link.machine.now, "gone");
  EXPECT_EQ(anna.wire.session->rank(), Rank::kAny);
  rig.address = "10.0.0.1";  // trusted
  EXPECT_EQ(rank_after("", 200), Rank::kMayStop);
}

TEST(Roles, TheClientsOfAUserBearItsName) {
  UsersRig rig;
  SocketClient client(rig, "/kinebus/v1/socket", kOperateKey);
  client.say(R"({"request_id":1,"take_control":{}})");
  EXPECT_NE(rig.link.control.name_of(rig.link.control.holder()).find("anna: "), std::string::npos);
}

std::string without(std::string file, const std::string& part, const std::string& instead = {}) {
  return file.replace(file.find(part), part.size(), instead);
}

const std::string kAnna = "[[user]]\nname = \"anna\"\nrole = \"operate\"\nkey = \"a-key-that-operates\"\n";
constexpr const char* kSocketPath = "/kinebus/v1/socket";

TEST(ChangedUsers, WhoIsChangedIsPutOutAndNobodyElse) {
  const std::string changes[] = {
      without(kFile, kAnna),
      without(kFile, "\"operate\"", "\"watch\""),
      without(kFile, "\"operate\"", "\"administer\""),
      without(kFile, "a-key-that-operates", "another-key-that-operates"),
      without(kFile, "\"anna\"", "\"berta\""),
  };
  for (const std::string& change : changes) {
    UsersRig rig;
    SocketClient anna(rig, kSocketPath, kOperateKey), wall(rig, kSocketPath, kWatchKey);
    SocketClient owner(rig, kSocketPath, kKey);
    anna.say(R"({"request_id":1,"take_control":{}})");
    EXPECT_NE(rig.link.control.holder(), 0U);
    EXPECT_EQ(rig.server.take_users(rig.link.machine.now, *Users::read(kKey, kFile)), 0U) << "as it was";
    EXPECT_EQ(rig.server.take_users(rig.link.machine.now, *Users::read(kKey, change)), 1U) << change;
    rig.pump();
    EXPECT_TRUE(anna.wire.session->ended()) << change;
    EXPECT_NE(anna.wire.heard.find("may not ask for the same any more"), std::string::npos);
    EXPECT_EQ(rig.link.control.holder(), 0U) << "control goes with who had it";
    EXPECT_FALSE(wall.wire.session->ended());
    EXPECT_EQ(owner.say(R"({"request_id":2,"get_status":{}})").size(), 1U);
  }
}

TEST(ChangedUsers, ARequestOfAnOpenConnectionIsLookedUpAnew) {
  UsersRig rig;
  Connection& connection = rig.connect();
  const std::string request =
      std::string("GET /api/currentuser HTTP/1.1\r\nHost: 127.0.0.1:5000\r\nX-Api-Key: ") + kOperateKey +
      "\r\n\r\n";
  EXPECT_EQ(rig.ask(connection, request).status, 200);
  rig.server.take_users(rig.link.machine.now, *Users::read(kKey, without(kFile, kAnna)));
  EXPECT_EQ(rig.ask(connection, request).status, 401);
}

TEST(ChangedUsers, AnUploadOfWhoIsNoUserAnyMoreBreaksOff) {
  UsersRig rig;
  Connection& connection = rig.connect();
  connection.to_send =
      std::string("PUT /api/v1/files/local/a.gcode HTTP/1.1\r\nHost: 127.0.0.1:5000\r\nX-Api-Key: ") +
      kOperateKey + "\r\nContent-Type: text/x.gcode\r\nContent-Length: 100\r\n\r\nG28\n";
  rig.pump();
  EXPECT_EQ(rig.half_uploads(), 1);
  EXPECT_EQ(rig.server.take_users(rig.link.machine.now, *Users::read(kKey, without(kFile, kAnna))), 1U);
  rig.pump();
  EXPECT_TRUE(connection.session->ended());
  EXPECT_EQ(rig.half_uploads(), 0);
}

TEST(ChangedUsers, ATrustedNetworkIsLookedUpAnew) {
  UsersRig rig;
  rig.address = "10.0.0.9";
  SocketClient page(rig, kSocketPath, "");
  page.say(R"({"request_id":1,"hello":{"version_major":2}})");
  Connection& connection = rig.connect();
  const std::string request = "GET /api/currentuser HTTP/1.1\r\nHost: 127.0.0.1:5000\r\n\r\n";
  EXPECT_EQ(rig.ask(connection, request).status, 200);
  EXPECT_EQ(rig.server.take_users(rig.link.machine.now,
                                  *Users::read(kKey, without(kFile, "10.0.0.0/24", "10.1.0.0/24"))),
            1U);
  rig.pump();
  EXPECT_TRUE(page.wire.session->ended());
  EXPECT_EQ(rig.ask(connection, request).status, 401);
}

TEST(ChangedUsers, ALoginLivesAsLongAsItsUser) {
  UsersRig rig;
  const nlohmann::json login = rig.with(kOperateKey, "POST", "/api/login", R"({"passive":true})").json();
  const nlohmann::json wall = rig.with(kWatchKey, "POST", "/api/login", R"({"passive":true})").json();
  rig.server.take_users(rig.link.machine.now, *Users::read(kKey, without(kFile, kAnna)));
  EXPECT_FALSE(rig.server.logins().find(login["session"].get<std::string>(), rig.link.machine.now));
  EXPECT_TRUE(rig.server.logins().find(wall["session"].get<std::string>(), rig.link.machine.now));
}

}  // namespace
}  // namespace kinebus::http
