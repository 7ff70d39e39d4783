// HTTP Digest: the key as a password. That real clients pass is vcan_tests/http's.

#include <openssl/evp.h>

#include <array>

#include "gateway/sessions/http/gate.hpp"
#include "gateway/sessions/http/tests/http_rig.hpp"
#include "gateway/sessions/http/wire/authorization.hpp"

namespace kinebus::http {
namespace {

using namespace std::chrono_literals;

TEST(Authorization, ParametersAreReadAsTheyAreWritten) {
  const auto read =
      authorization_parameters(R"(digest  UserName="a \"b\", c" ,nc=00000001, qop=auth,x="")", "Digest");
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, (std::map<std::string, std::string>{
                       {"username", "a \"b\", c"}, {"nc", "00000001"}, {"qop", "auth"}, {"x", ""}}));
  for (const char* bad :
       {"", "Bearer a=1", "Digest", "Digest a", "Digest =1", "Digest a=1 b=2", "Digest a=\"1",
        "Digest a=\"\\", "Digest a=1,a=2", "Digest a=1,,b=2", "Digest \"a\"=1"})
    EXPECT_TRUE(std::string(bad) == "Digest" ? authorization_parameters(bad, "Digest")->empty()
                                             : !authorization_parameters(bad, "Digest"))
        << bad;
}

std::string md5(const std::string& text) {
  std::array<unsigned char, 16> sum{};
  EVP_Digest(text.data(), text.size(), sum.data(), nullptr, EVP_md5(), nullptr);
  return hexadecimal(sum);
}

/// A client that has been challenged.
struct Client {
  HttpRig& rig;
  std::string nonce{}, user = "maker", password = kKey, realm = "Printer API", qop = "auth";

  std::string field(const std::string& method, const std::string& path, const std::string& count) const {
    const std::string response = md5(md5(user + ":" + realm + ":" + password) + ":" + nonce + ":" + count +
                                     ":abc:" + qop + ":" + md5(method + ":" + path));
    return "Authorization: Digest username=\"" + user + "\", realm=\"" + realm + "\", nonce=\"" + nonce +
           "\", uri=\"" + path + "\", cnonce=\"abc\", nc=" + count + ", qop=" + qop + ", response=\"" +
           response + "\"\r\n";
  }
  Response ask(const std::string& fields, const std::string& path = "/api/version") const {
    return rig.ask("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n" + fields + "\r\n");
  }
  bool is_challenged() {
    const std::string head = ask("").head;
    const std::size_t at = head.find("nonce=\"");
    if (at == std::string::npos) return false;
    nonce = head.substr(at + 7, head.find('"', at + 7) - at - 7);
    return head.find("Digest realm=\"Printer API\"") != std::string::npos;
  }
};

TEST(Digest, TheKeyIsThePasswordAndEachAnswerCountsOnce) {
  HttpRig rig;
  Client client{rig};
  ASSERT_TRUE(client.is_challenged());
  const std::string first = client.field("GET", "/api/version", "00000001");
  EXPECT_EQ(client.ask(first).status, 200);
  // Who has heard it cannot say it again, and hears why.
  const Response again = client.ask(first);
  EXPECT_EQ(again.status, 401);
  EXPECT_NE(again.head.find("stale=true"), std::string::npos);
  EXPECT_EQ(client.ask(client.field("GET", "/api/version", "00000002")).status, 200);
  // Nor for another request.
  EXPECT_EQ(client.ask(client.field("GET", "/api/version", "00000003"), "/api/job").status, 401);
  EXPECT_EQ(client.ask(client.field("POST", "/api/version", "00000004")).status, 401);

  rig.run_until([] { return false; }, 301s);
  EXPECT_EQ(client.ask(client.field("GET", "/api/version", "00000005")).status, 401);
  ASSERT_TRUE(client.is_challenged());
  EXPECT_EQ(client.ask(client.field("GET", "/api/version", "00000001")).status, 200);
}

TEST(Digest, WhatIsWrongIsNotLetIn) {
  HttpRig rig;
  Client client{rig};
  ASSERT_TRUE(client.is_challenged());
  const auto with = [&](auto change) {
    Client other = client;
    change(other);
    return other.ask(other.field("GET", "/api/version", "00000001"));
  };
  EXPECT_EQ(with([](Client& c) { c.password = "0123456789abcdeF"; }).status, 401);
  EXPECT_EQ(with([](Client& c) { c.password.clear(); }).status, 401);
  EXPECT_EQ(with([](Client& c) { c.realm = "kinebus"; }).status, 401);
  EXPECT_EQ(with([](Client& c) { c.qop = "auth-int"; }).status, 401);
  EXPECT_EQ(with([](Client& c) { c.nonce = "0"; }).status, 401);
  for (const char* field : {"Authorization: Digest\r\n", "Authorization: Digest response=\"\"\r\n",
                            "Authorization: Basic a2luZTpidXM=\r\n"})
    EXPECT_EQ(client.ask(field).status, 401) << field;
  // The page asks for the key itself: no window of the browser.
  EXPECT_EQ(client.ask("Sec-Fetch-Mode: cors\r\nSec-Fetch-Site: same-origin\r\n").head.find("Digest"),
            std::string::npos);
  EXPECT_EQ(with([](Client&) {}).status, 200);
}

/// Where OctoPrint's and PrusaLink's answers differ under one path, who shows no API key has PrusaLink's.
TEST(Digest, WhoLogsInByItHasPrusaLinksForms) {
  HttpRig rig;
  rig.link.machine.make_ready();
  const std::string put =
      HttpRig::head("PUT", "/api/v1/files/local/a.gcode") + "Content-Type: text/x.gcode\r\n";
  ASSERT_EQ(
      rig.ask(put + "Print-After-Upload: ?1\r\n" + HttpRig::with_body("G4 S1\nG1 X1 F60\nG1 X0\n")).status,
      201);
  Client client{rig};
  ASSERT_TRUE(client.is_challenged());
  const auto files = client.ask(client.field("GET", "/api/files", "00000001"), "/api/files").json();
  EXPECT_EQ(files["files"][0]["path"], "/usb");
  EXPECT_EQ(files["files"][0]["children"][0]["path"], "/usb/a.gcode");
  EXPECT_EQ(rig.get("/api/files").json()["files"][0]["path"], "a.gcode");
  EXPECT_TRUE(rig.run_until([&] { return rig.link.machine.gateway->status().progress > 0.5; }, 30s));
  const double share =
      client.ask(client.field("GET", "/api/job", "00000002"), "/api/job").json()["progress"]["completion"];
  EXPECT_NEAR(rig.get("/api/job").json()["progress"]["completion"].get<double>() / share, 100, 5);
}

}  // namespace
}  // namespace kinebus::http
