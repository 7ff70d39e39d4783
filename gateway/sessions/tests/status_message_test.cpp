// A status and an event as messages: every value is where its name says, and what is not known is not there.

#include <functional>

#include "gateway/sessions/messages.hpp"
#include "gateway/sessions/tests/message_text.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// Alone in a status.
joblink::Status told(const std::function<void(MachineStatus&)>& set) {
  MachineStatus status;
  set(status);
  return to_message(status);
}
joblink::AxisStatus axis_told(const std::function<void(NodeStatus&)>& set, double rate = 0) {
  return told([&](MachineStatus& s) {
           s.rate = rate;
           s.nodes.emplace_back();
           set(s.nodes.back());
         })
      .nodes(0)
      .axes(0);
}

TEST(StatusMessage, TellsWhereTheMachineIsAndWhatItDoes) {
  MachineStatus s;
  s.now = 1500ms;
  s.state = MachineState::kRunning;
  s.doing = say("homes %1", "x");
  s.positions_known = true;
  s.pose = {1, 2, 3, 4, 5, 6};
  s.machine_pose = {11, 12, 13, 14, 15, 16};
  s.measured_pose = Pose{21, 22, 23, 24, 25, 26};
  s.joints = {31, 32, 33};
  s.joint_count = 2;
  s.path_time_s = 41;
  s.rate = 0.5;
  s.feed_override = 1.25;
  s.job = "part";
  s.interrupted = s.filament_change = true;
  s.line = 51;
  s.progress = 0.25;
  s.elapsed_s = 52;
  s.job_filament_mm = 53;
  s.remaining_s = 54;
  s.work_system = 3;
  s.work_offset = {61, 62, 63, 64, 65, 66};
  s.bus_load = 0.125;
  s.bus_load_peak = 0.75;
  s.spindle = {.actual_rpm = 72, .target_rpm = 71};
  s.counters = {81, 82, 83, 84, 85, 86, 87, 88, 89, 90, 91, 92};
  joblink::Status m = to_message(s);
  m.clear_bed();
  m.clear_hotend();
  expect_says(m, R"(time_s: 1.5 state: STATE_RUNNING state_words: "running" doing: "homes x"
      doing_said { text: "homes %1" parts { text: "x" verbatim: true } }
      positions_known: true
      tool { x_mm: 1 y_mm: 2 z_mm: 3 a_rad: 4 c_rad: 5 e_mm: 6 }
      machine { x_mm: 11 y_mm: 12 z_mm: 13 a_rad: 14 c_rad: 15 e_mm: 16 }
      measured_tool { x_mm: 21 y_mm: 22 z_mm: 23 a_rad: 24 c_rad: 25 e_mm: 26 }
      joints: 31 joints: 32 path_time_s: 41 rate: 0.5 feed_override: 1.25
      job: "part" interrupted: true filament_change: true line: 51 progress: 0.25 elapsed_s: 52
      job_filament_mm: 53 remaining_s: 54 work_system: 3
      work_offset { x_mm: 61 y_mm: 62 z_mm: 63 a_rad: 64 c_rad: 65 e_mm: 66 }
      bus_load: 0.125 bus_load_peak: 0.75 spindle_target_rpm: 71 spindle_rpm: 72
      counters { frames_sent: 81 frames_received: 82 segments_sent: 83 malformed_frames: 84 foreign_frames: 85
        sequence_errors: 86 underruns: 87 checkpoint_errors: 88 sdo_aborts: 89 sdo_timeouts: 90
        bus_slowdowns: 91 starvation_holds: 92 })");
}

TEST(StatusMessage, TellsOfEveryDevice) {
  MachineStatus s;
  for (const HeaterId id : {kFirstHotend, HeaterId{HeaterKind::kHotend, 1}, kFirstBed}) {
    NamedHeaterStatus heater;
    heater.id = id;
    heater.name = id == kFirstBed ? "bed" : "hot";
    heater.actual_celsius = id == kFirstBed ? 50 : 200;
    heater.target_celsius = id == kFirstBed ? 60 : 210 + id.index;
    if (id == kFirstBed) {
      heater.power = 0.5;
      heater.measured = Measured::kYes;
      heater.tuning = {
          .stage = TuningStage::kDone, .celsius = 1, .model = {2, 3, 4, 5, 6}, .failure = say("no room")};
    }
    s.heaters.push_back(heater);
  }
  s.tool = {HeaterKind::kHotend, 1};
  s.fans = {{"part", 0, 0.25}, {"case", 1, 0.75}};
  s.outputs = {{"lamp", 2, 0.5}};
  s.inputs = {{"door", 1, InputLevel::kOn}, {"lid", 2, InputLevel::kOff}, {"key", 3, InputLevel::kUnknown}};
  s.sensors = {{"board", 41}};
  s.filaments = {{"spool", FilamentCondition::kOut}, {"other", FilamentCondition::kInOrder}};
  s.objects = {{"cube", true}, {"ball", false}};
  s.probe_touches = true;
  s.probe_pin = ContactProbe::Pin::kOut;
  joblink::Status m = to_message(s);
  EXPECT_FALSE(m.filament_sensors(0).words().text().empty());
  m.mutable_filament_sensors(0)->clear_words();
  joblink::Status devices;
  for (const int number : {18, 19, 20, 34, 58, 35, 36, 37, 56, 38, 55, 45, 52}) {
    const auto* field = joblink::Status::descriptor()->FindFieldByNumber(number);
    m.GetReflection()->SwapFields(&m, &devices, {field});
  }
  expect_says(devices, R"(
      hotend { actual_celsius: 200 target_celsius: 210 }
      bed { actual_celsius: 50 target_celsius: 60 kind: HEATER_BED power: 0.5 measured: true }
      fan: 0.25 hotend_in_use: 1
      heaters { actual_celsius: 200 target_celsius: 210 name: "hot" }
      heaters { actual_celsius: 200 target_celsius: 211 index: 1 name: "hot" }
      heaters { actual_celsius: 50 target_celsius: 60 kind: HEATER_BED name: "bed" power: 0.5 measured: true
        tuning { stage: TUNING_DONE celsius: 1 power_w: 2 capacity_j_per_k: 3 loss_w_per_k: 4 lag_s: 5 dead_s: 6
          failure { text: "no room" } } }
      fans { name: "part" ratio: 0.25 } fans { name: "case" index: 1 ratio: 0.75 }
      outputs { name: "lamp" index: 2 ratio: 0.5 }
      inputs { name: "door" index: 1 on: true } inputs { name: "lid" index: 2 on: false } inputs { name: "key" index: 3 }
      sensors { name: "board" celsius: 41 }
      filament_sensors { name: "spool" condition: FILAMENT_OUT } filament_sensors { name: "other" }
      objects { name: "cube" left_out: true } objects { name: "ball" }
      probe_touches: true probe_pin: PROBE_PIN_OUT)");
}

TEST(StatusMessage, OfAJobsObjectsAHundredAreTold) {
  for (const int all : {99, 100, 101})
    EXPECT_EQ(told([&](MachineStatus& s) { s.objects.resize(static_cast<std::size_t>(all)); }).objects_size(),
              std::min(all, 100));
}

TEST(StatusMessage, TellsOfEveryNodeAndItsAxes) {
  NodeStatus node;
  node.id = 7;
  node.present = node.synchronised = node.stopped = true;
  node.nmt_state = 5;
  node.statusword = {0x0637, 0x0608};
  node.inputs = 9;
  node.off_course = {0.25, std::nullopt};
  node.by_scale_mm = {10, std::nullopt};
  node.current_a = {1.5, std::nullopt};
  node.run_current_a = {2, 3};
  node.hold_current_a = {0.5, 1};
  node.stage_celsius = {40, std::nullopt};
  node.position_counts = {-100, 200};
  node.measures = {true, false};
  node.sync_error_us = 500'000;
  node.queue_records = 11;
  node.queue_capacity = 12;
  node.records_sent = 13;
  node.emergencies = 14;
  MachineStatus s;
  s.nodes = {node};
  expect_says(to_message(s).nodes(0),
              R"(id: 7 present: true nmt_state: 5 inputs: 9 synchronised: true sync_error_s: 0.5
      queue_records: 11 queue_capacity: 12 stopped: true records_sent: 13 emergencies: 14
      axes { statusword: 1591 enabled: true off_course: 0.25 by_scale_mm: 10 current_a: 1.5 run_current_a: 2
        hold_current_a: 0.5 configured_current_a: 0.5 stage_celsius: 40 position_counts: -100 measures: true }
      axes { statusword: 1544 fault: true run_current_a: 3 hold_current_a: 1 position_counts: 200 })");
  s.nodes[0].has_axes = false;
  s.nodes[0].queue_records = -3;
  EXPECT_EQ(to_message(s).nodes(0).axes_size(), 0);
  EXPECT_EQ(to_message(s).nodes(0).queue_records(), 0U);
}

TEST(StatusMessage, AMotorIsToHaveItsRunCurrentInMotionAndNoneWhenItIsOff) {
  const auto of = [](std::uint16_t word, bool present, double rate) {
    return axis_told(
        [&](NodeStatus& node) {
          node.present = present;
          node.statusword[0] = word;
          node.run_current_a[0] = 2;
          node.hold_current_a[0] = 1;
        },
        rate);
  };
  EXPECT_EQ(of(0x27, true, 0.5).configured_current_a(), 2);
  EXPECT_EQ(of(0x27, true, 0).configured_current_a(), 1);
  EXPECT_EQ(of(0x23, true, 0.5).configured_current_a(), 0) << "switched on, not enabled";
  EXPECT_EQ(of(0x27, false, 0.5).configured_current_a(), 0);
  EXPECT_FALSE(of(0x27, false, 0).enabled());
  EXPECT_FALSE(of(0x27, true, 0).fault());
  // CiA 402: fault, and the reaction to it.
  for (const int word : {0x08, 0x0F, 0x1F}) {
    EXPECT_EQ(of(static_cast<std::uint16_t>(word), true, 0).fault(), word != 0x07) << word;
    EXPECT_FALSE(of(static_cast<std::uint16_t>(word), false, 0).fault()) << "of a node that is not there";
  }
}

TEST(StatusMessage, WhatIsNotKnownIsNotThere) {
  const joblink::Status m = told([](MachineStatus& s) { s.nodes.emplace_back(); });
  EXPECT_FALSE(m.has_measured_tool());
  EXPECT_FALSE(m.has_job_filament_mm());
  EXPECT_FALSE(m.has_probe_touches());
  EXPECT_FALSE(m.has_doing_said());
  EXPECT_FALSE(m.hotend().has_power());
  EXPECT_FALSE(m.hotend().has_measured());
  EXPECT_FALSE(m.nodes(0).axes(0).has_current_a());
  EXPECT_EQ(m.joints_size(), 0);
}

TEST(StatusMessage, TheMachineRestsOnlyWhereNothingMovesByItself) {
  using M = MachineState;
  for (const M state :
       {M::kOff, M::kBringUp, M::kUnhomed, M::kHoming, M::kReady, M::kMoving, M::kChecking, M::kRunning,
        M::kHolding, M::kHeld, M::kCancelling, M::kStopping, M::kStopped, M::kAlarm}) {
    const bool rests = state == M::kOff || state == M::kUnhomed || state == M::kReady || state == M::kHeld ||
                       state == M::kStopped || state == M::kAlarm;
    EXPECT_EQ(told([&](MachineStatus& s) { s.state = state; }).at_rest(), rests) << static_cast<int>(state);
  }
}

TEST(StatusMessage, AnEventTellsWhatWhereAndWhatToDo) {
  MachineEvent event{.kind = MachineEvent::Kind::kAlarm,
                     .when = 2500ms,
                     .state = MachineState::kStopping,
                     .code = 0xFF02,
                     .node = 3,
                     .line = 17,
                     .words = say("a record was lost"),
                     .advice = say("clear")};
  expect_says(to_message(event),
              R"(kind: EVENT_ALARM time_s: 2.5 state: STATE_STOPPING code: 65282 node: 3 line: 17
      words: "a record was lost" advice: "clear" said { text: "a record was lost" } advice_said { text: "clear" })");
  event.advice = {};
  EXPECT_FALSE(to_message(event).has_advice_said());
}

}  // namespace
}  // namespace kinebus
