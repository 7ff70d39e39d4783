#include "gateway/recorder/flight_report.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "protocol/can/candump.hpp"

namespace kinebus {
namespace {

TEST(FlightReport, KeepsTheLastMinuteAndSaysWhoAskedForTheStop) {
  const auto ring = std::make_unique<FlightRing>();
  FlightRing::put(ring->machine, "M\"1");
  for (int i = 0; i < 300'000; ++i)
    ring->add_frame(BusTime{std::int64_t{i} * 1'000'000}, CanFrame::make(0x80, {1}), true);
  ring->add_frame(BusTime{300'000'000'000}, CanFrame::make(0x82, {0x06, 0xFF, 0x81, 0x05, 0, 0, 0, 0}),
                  false);
  FlightRing::Event& event = ring->next_event();
  event.when_ns = 300'000'000'000;
  event.kind = 1;
  FlightRing::put(event.words, "a line\nwith \"quotes\"");
  const std::string log = flight_log(*ring, "can0");
  const auto lines = static_cast<std::size_t>(std::count(log.begin(), log.end(), '\n'));
  EXPECT_EQ(lines, 60'001u);
  EXPECT_TRUE(parse_candump(log.substr(0, log.find('\n'))));
  const auto json = nlohmann::json::parse(flight_json(*ring, "alarm", "a.log"));
  ASSERT_EQ(json.at("emergencies").size(), 1u);
  EXPECT_EQ(json.at("emergencies")[0].at("node"), 2);
  EXPECT_EQ(json.at("emergencies")[0].at("stops"), 1);
  EXPECT_EQ(json.at("events")[0].at("s"), 0);
}

}  // namespace
}  // namespace kinebus
