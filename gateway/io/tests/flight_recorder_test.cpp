// The recorder beside a control loop: it never asks for time that is over, whatever its writer does.

#include "gateway/io/flight_recorder.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "gateway/description/machine_description.hpp"
#include "gateway/jobs/store/tests/temporary_folder.hpp"
#include "gateway/machine/gateway.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

bool has_report(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".json") return true;
  return false;
}

TEST(FlightRecorder, AsksForNoPastTimeWhileAReportIsWritten) {
  const TemporaryFolder folder;
  const MachineDescription machine = default_m1();
  const Gateway gateway(machine);
  FlightRecorder recorder({.folder = folder.path() / "flight", .machine = "M1", .interface = "vcan0"},
                          gateway);
  ASSERT_EQ(recorder.open(), "");
  LocalTime now = 100s;
  for (int i = 0; i < 200'000; ++i) recorder.on_frame(now, CanFrame::make(0x80, {1}), true);
  MachineEvent alarm;
  alarm.kind = MachineEvent::Kind::kAlarm;
  alarm.when = now;
  alarm.words = Sentence::verbatim("node 1 is silent");
  recorder.on_event(alarm);
  int turns = 0;
  for (; turns < 100'000'000 && !has_report(folder.path() / "flight"); ++turns) {
    now = recorder.next_deadline();
    recorder.on_time(now);
    ASSERT_GT(recorder.next_deadline(), now) << "turn " << turns << ": a loop would spin";
  }
  EXPECT_LT(turns, 100'000'000) << "no report";
}

}  // namespace
}  // namespace kinebus
