#pragma once
// A snapshot of the whole machine, for displays and for answers to queries. Plain values, made on demand.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gateway/devices/devices.hpp"
#include "gateway/kinematics/kinematics.hpp"
#include "gateway/sentence.hpp"
#include "gateway/status/state.hpp"
#include "protocol/time.hpp"

namespace kinebus {

struct NodeStatus {
  std::uint8_t id = 0;
  bool present = false;  ///< heard within the heartbeat time
  std::uint8_t nmt_state =
      0;  ///< as in the heartbeat: 0 boot-up, 4 stopped, 5 operational, 127 pre-operational
  bool has_axes = true;
  std::array<std::uint16_t, 2> statusword{};  ///< CiA 402, axis A and B
  std::uint32_t inputs = 0;                   ///< 60FDh
  /// Commanded less measured by the axis' encoder, mm or rad; empty without one.
  std::array<std::optional<double>, 2> off_course{};
  /// Where the joint's linear scale has it; empty: none, or not read since the machine came to rest.
  std::array<std::optional<double>, 2> by_scale_mm{};
  /// Measured amplitude; empty: not read lately (Gateway::watch_currents).
  std::array<std::optional<double>, 2> current_a{};
  std::array<double, 2> run_current_a{}, hold_current_a{};  ///< what the motor is given; 0 without one
  /// Of the power stage; empty: not read lately, or the node has no sensor.
  std::array<std::optional<double>, 2> stage_celsius{};
  std::array<std::int32_t, 2> position_counts{};  ///< 6064h
  std::array<bool, 2> measures{};                 ///< it measures the motor's winding
  bool synchronised = false;
  int sync_error_us = 0;     ///< bound of its clock estimate's error
  int queue_records = 0;     ///< records in its queue
  int queue_capacity = 120;  ///< room for records when it is empty
  bool stopped = false;      ///< its stop latch
  std::uint64_t records_sent = 0;
  std::uint32_t emergencies = 0;  ///< EMCY frames heard from it
};

struct MachineCounters {
  std::uint64_t frames_sent = 0, frames_received = 0, segments_sent = 0;
  std::uint32_t malformed_frames = 0;  ///< frames that no part could read
  std::uint32_t foreign_frames = 0;    ///< from a second gateway or an unknown node
  std::uint32_t sequence_errors = 0, underruns = 0, checkpoint_errors = 0;
  std::uint32_t sdo_aborts = 0, sdo_timeouts = 0;
  std::uint32_t bus_slowdowns = 0;     ///< times the path was slowed to keep within the bus budget
  std::uint32_t starvation_holds = 0;  ///< times planning did not keep up and the path was held
};

/// An object of the print under way.
struct ObjectStatus {
  std::string name;
  bool left_out = false;
};

struct MachineStatus {
  MachineState state = MachineState::kOff;
  Sentence doing;  ///< plain words: what the machine does now
  BusTime now{0};
  bool positions_known = false;
  Pose pose{};                        ///< tool relative to the part (Frame::kPart), mm and rad
  Pose machine_pose{};                ///< Frame::kMachine
  std::optional<Pose> measured_pose;  ///< as `pose`, by the axes' encoders; empty: none is there
  JointVector joints{};               ///< mm or rad
  /// Commanded less measured by the joint's encoder, mm or rad; empty without one.
  std::array<std::optional<double>, kMaxJoints> off_course{};
  int joint_count = 0;
  double path_time_s = 0;  ///< tau
  double rate = 0;         ///< d tau / dt now
  double feed_override = 1;

  std::string job;               ///< name; empty: none
  bool interrupted = false;      ///< `job` waits for resume or cancel, wherever the machine is
  bool filament_change = false;  ///< the job waits for one
  std::uint32_t line = 0;        ///< in motion now
  double progress = 0;           ///< 0..1, by path time
  double elapsed_s = 0;
  std::optional<double>
      job_filament_mm;                ///< what `job` has fed, less what it has drawn back; empty: not known
  std::vector<ObjectStatus> objects;  ///< of the job, in its order
  double remaining_s = 0;             ///< estimate at the present override

  std::uint32_t work_system = 1;  ///< of lines from outside: 1 (G54) .. 9 (G59.3)
  Pose work_offset{};             ///< of it: work zero in table coordinates, mm and rad

  std::vector<NamedHeaterStatus> heaters;
  HeaterId tool{};  ///< the hot end in use
  std::vector<OutputStatus> fans, outputs;
  std::vector<InputStatus> inputs;
  std::vector<SensorStatus> sensors;
  std::vector<FilamentStatus> filaments;
  SpindleStatus spindle;
  std::optional<bool> probe_touches;  ///< empty: there is no probe
  ContactProbe::Pin probe_pin = ContactProbe::Pin::kNone;
  /// Cold and off when there is none.
  HeaterStatus heater(HeaterId id) const {
    for (const NamedHeaterStatus& h : heaters)
      if (h.id == id) return static_cast<const HeaterStatus&>(h);
    return {};
  }

  double bus_load = 0;  ///< fraction of 1 Mbit/s over the last second
  double bus_load_peak = 0;
  std::vector<NodeStatus> nodes;
  MachineCounters counters;
};

}  // namespace kinebus
