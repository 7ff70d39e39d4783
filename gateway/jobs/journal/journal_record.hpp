#pragma once
// What the gateway notes of a job under way, so that another gateway (after a crash, a restart, a power loss)
// can take it up from the exact place. Path time at rest is what the nodes remember themselves; the journal
// tells which place of the job it is.

#include <array>
#include <cstdint>
#include <string>
#include <variant>

#include "gateway/description/device_description.hpp"
#include "gateway/gcode/words/state.hpp"
#include "gateway/jobs/job_place.hpp"
#include "gateway/kinematics/bed_mesh.hpp"
#include "gateway/kinematics/kinematics.hpp"
#include "protocol/time.hpp"

namespace kinebus::journal {

/// A gateway began to speak, with this time epoch.
struct Epoch {
  std::uint8_t epoch = 0;
  friend bool operator==(const Epoch&, const Epoch&) = default;
};
/// A job begins; whatever was noted before is void.
struct JobBegin {
  std::string name;
  std::uint64_t bytes = 0;       ///< read of its text
  std::uint64_t hash = 0;        ///< of them: fnv1a64()
  Pose start{};                  ///< Frame::kMachine
  gcode::WorkOffsets offsets{};  ///< the machine's, when the job began
  friend bool operator==(const JobBegin&, const JobBegin&) = default;
};
/// A run of motion begins at a path time.
struct RunBegin {
  PathTime start{0};
  JobPlace from;
  double ramp_s = 0;
  double extruder_shift_mm = 0;
  friend bool operator==(const RunBegin&, const RunBegin&) = default;
};
/// So many waits (dwell, heating, pause) of the job are over.
struct WaitsDone {
  std::uint64_t count = 0;
  friend bool operator==(const WaitsDone&, const WaitsDone&) = default;
};
/// Feed override above 100 %, from this motion command on.
struct Scale {
  FeedScale scale;
  friend bool operator==(const Scale&, const Scale&) = default;
};
struct Override {
  double ratio = 1;
  friend bool operator==(const Override&, const Override&) = default;
};
/// What the devices were told: heaters' targets, deg C (0: off), fans and outputs, 0..1, and the spindle.
/// Records name a target by its place here.
struct Heat {
  static constexpr std::size_t kFans = kHeaterKinds * kMostOfAKind, kOutputs = kFans + kMostOfAKind,
                               kTool = kOutputs + kMostOfAKind, kSlots = kTool + 1;
  std::array<double, kSlots> targets{};
  double spindle_rpm = 0;

  double& heater(HeaterId id) { return targets[slot(id)]; }
  double heater(HeaterId id) const { return targets[slot(id)]; }
  double& fan(std::uint8_t index) { return targets[kFans + index % kMostOfAKind]; }
  double fan(std::uint8_t index) const { return targets[kFans + index % kMostOfAKind]; }
  double& output(std::uint8_t index) { return targets[kOutputs + index % kMostOfAKind]; }
  double output(std::uint8_t index) const { return targets[kOutputs + index % kMostOfAKind]; }
  /// The hot end in use.
  std::uint8_t tool() const {
    const double told = targets[kTool];
    return told > 0 && told < kMostOfAKind ? static_cast<std::uint8_t>(told) : 0;
  }
  void set_tool(std::uint8_t hotend) { targets[kTool] = hotend; }
  friend bool operator==(const Heat&, const Heat&) = default;

 private:
  static std::size_t slot(HeaterId id) {
    return static_cast<std::size_t>(id.kind) * kMostOfAKind + id.index % kMostOfAKind;
  }
};
/// The same of a gateway that knew one hot end, one bed and one fan: read, not written.
struct Thermal {
  double hotend_celsius = 0, bed_celsius = 0, fan = 0, spindle_rpm = 0;
  friend bool operator==(const Thermal&, const Thermal&) = default;
};
/// Now and then in motion: the place that counts when the nodes have lost theirs.
struct Progress {
  PathTime tau{0};
  std::uint32_t line = 0;
  JointVector joints{};  ///< mm or rad: for who looks
  friend bool operator==(const Progress&, const Progress&) = default;
};
/// The job was interrupted at this place; no path time means anything any more.
struct Interrupted {
  JobPlace place;
  double extruder_shift_mm = 0;
  friend bool operator==(const Interrupted&, const Interrupted&) = default;
};
/// After a restart: the nodes were found at this path time of the run. From now on path time is another.
struct Found {
  PathTime tau{0};
  friend bool operator==(const Found&, const Found&) = default;
};
/// The job is done, or given up.
struct JobEnd {
  friend bool operator==(const JobEnd&, const JobEnd&) = default;
};
/// The machine's own work offsets from now on; jobs come and go. `machine`: identity() of its description.
struct Offsets {
  std::string machine;
  gcode::WorkOffsets offsets{};
  friend bool operator==(const Offsets&, const Offsets&) = default;
};
/// How far the job has come, for who looks.
struct JobTime {
  std::uint32_t line = 0;
  double elapsed_s = 0;             ///< since the job began, under all gateways
  double done_s = 0, motion_s = 0;  ///< of its motion at 100 %, and all of it
  friend bool operator==(const JobTime&, const JobTime&) = default;
};

/// What the job under way has found out: its text cannot be read again without it.
struct Learned {
  enum class What : std::uint8_t {
    kProbed,     ///< how a probe's move has ended
    kMesh,       ///< the mesh in force from a levelling command on
    kBeginning,  ///< the mesh in force when the job began
    kInput,      ///< what M66 has read: X of `at` is #5399
  } what{};
  std::uint64_t phases = 0;  ///< of the job, given out until then; it goes on behind them, from rest
  bool contact = false;
  Frame frame{};
  Pose at{},
      stand{};      ///< of a probe as in ProbeResult; else `stand` is the tool, as it is named from then on
  MeshGrid mesh{};  ///< without heights: none
  friend bool operator==(const Learned&, const Learned&) = default;
};
/// A mesh of the machine's bed, kept under its name.
struct Mesh {
  std::string machine;         ///< identity() of its description
  std::uint64_t geometry = 0;  ///< geometry_mark()
  std::string name;
  double unix_s = 0;  ///< when it was measured
  MeshGrid grid;      ///< without heights: it is forgotten
  friend bool operator==(const Mesh&, const Mesh&) = default;
};
/// Which of them is in force from now on; empty: none.
struct MeshInForce {
  std::string machine, name;
  friend bool operator==(const MeshInForce&, const MeshInForce&) = default;
};

/// While the job ran.
struct ObjectLeftOut {
  LeftOut object;
  friend bool operator==(const ObjectLeftOut&, const ObjectLeftOut&) = default;
};

/// How high the job has printed so far, table coordinates: after power loss a part of this height stands
/// there, wherever the tool does.
struct Printed {
  double top_mm = 0;
  friend bool operator==(const Printed&, const Printed&) = default;
};

using Record =
    std::variant<Epoch, JobBegin, RunBegin, WaitsDone, Scale, Override, Thermal, Progress, Interrupted, Found,
                 JobEnd, Offsets, Heat, JobTime, Learned, Mesh, MeshInForce, ObjectLeftOut, Printed>;

}  // namespace kinebus::journal
