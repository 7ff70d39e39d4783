#include "gateway/fleet/wall/wall_session.hpp"

#include <gtest/gtest.h>

namespace kinebus::fleet {
namespace {

/// What the wall answers to these bytes, in pieces of one.
std::string answered(const std::string& request, bool* ended = nullptr) {
  WallText text;
  text.set("{\"machines\":[]}");
  WallSession session(text);
  std::string out;
  for (const char c : request) {
    const auto byte = static_cast<std::uint8_t>(c);
    session.on_bytes(LocalTime{0}, std::span(&byte, 1));
    const auto bytes = session.next_bytes();
    out.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    session.on_bytes_sent(bytes.size());
  }
  if (ended != nullptr) *ended = session.ended();
  return out;
}

TEST(Wall, ShowsPageAndMachinesOnOneConnection) {
  bool ended = true;
  const std::string out = answered(
      "GET / HTTP/1.1\r\nHost: localhost:7450\r\n\r\nGET /fleet.json?x HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
      &ended);
  EXPECT_TRUE(out.starts_with("HTTP/1.1 200 OK\r\nContent-Type: text/html"));
  EXPECT_TRUE(out.ends_with("\r\n\r\n{\"machines\":[]}"));
  EXPECT_FALSE(ended);
}

TEST(Wall, TellsPrometheusWhatWasSetForIt) {
  WallText text;
  text.set_metrics("kinebus_fleet_database_up 1\n");
  WallSession session(text);
  const std::string request = "GET /metrics HTTP/1.1\r\nHost: 127.0.0.1:7450\r\n\r\n";
  session.on_bytes(LocalTime{0},
                   std::span(reinterpret_cast<const std::uint8_t*>(request.data()), request.size()));
  const auto bytes = session.next_bytes();
  const std::string out(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  EXPECT_NE(out.find("Content-Type: text/plain; version=0.0.4"), std::string::npos) << out;
  EXPECT_TRUE(out.ends_with("\r\n\r\nkinebus_fleet_database_up 1\n")) << out;
}

TEST(Wall, RefusesWhatIsNotItsOwn) {
  const struct {
    const char *request, *answer;
  } kCases[] = {
      {"GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n", "HTTP/1.1 403"},
      {"GET / HTTP/1.1\r\nHost: localhost.evil.example:80\r\n\r\n", "HTTP/1.1 403"},
      {"GET / HTTP/1.1\r\n\r\n", "HTTP/1.1 403"},
      {"POST / HTTP/1.1\r\nHost: [::1]:80\r\nContent-Length: 2\r\n\r\nhi", "HTTP/1.1 405"},
      {"GET /../x HTTP/1.1\r\nHost: [::1]\r\n\r\n", "HTTP/1.1 404"},
      {"nonsense\r\n\r\n", "HTTP/1.1 400"},
  };
  for (const auto& c : kCases) EXPECT_TRUE(answered(c.request).starts_with(c.answer)) << answered(c.request);
}

TEST(Wall, AClientThatAsksWithoutReadingWaitsAndASilentOneIsLetGo) {
  WallText text;
  WallSession session(text);
  const std::string request = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";
  session.on_bytes(LocalTime{0},
                   std::span(reinterpret_cast<const std::uint8_t*>(request.data()), request.size()));
  const std::size_t one = session.next_bytes().size();
  session.on_bytes(LocalTime{0},
                   std::span(reinterpret_cast<const std::uint8_t*>(request.data()), request.size()));
  EXPECT_EQ(session.next_bytes().size(), one);
  session.on_bytes_sent(one);
  EXPECT_EQ(session.next_bytes().size(), one);
  EXPECT_FALSE(session.wants_bytes());
  EXPECT_FALSE(session.ended());
  session.on_time(session.next_deadline());
  EXPECT_TRUE(session.ended());
}

}  // namespace
}  // namespace kinebus::fleet
