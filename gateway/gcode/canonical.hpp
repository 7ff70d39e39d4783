#pragma once
// The canonical commands: what a G-code job means, free of dialect, offsets, units and modal state.
// The seam between interpreter and planner, and what golden tests compare. All lengths mm, angles rad, speeds
// mm/s or rad/s, absolute poses in `frame`. E of a pose is absolute over the whole job, G92 and retraction
// resolved.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "gateway/pose.hpp"
#include "gateway/shaper_kind.hpp"

namespace kinebus::canonical {

struct Traverse {  ///< G0: as fast as the machine allows
  Pose target{};
  Frame frame{};
  double speed_per_s = 0;  ///< > 0: no faster than this; as Feed::feed_per_s
};

struct Feed {  ///< G1
  Pose target{};
  Frame frame{};
  /// Speed of the tool tip relative to the part, mm/s. A move without tool motion (only A, C or E): the speed
  /// of the axis that moves farthest, in its own unit per second (mm/s or rad/s). Farthest: the greatest
  /// change in mm or rad as numbers; of equals the first in the order of Pose.
  double feed_per_s = 0;
  /// G93: the whole move takes this long, s; 0: feed_per_s counts.
  double inverse_time_s = 0;
};

struct Arc {  ///< G2/G3: circular or helical, in any plane (G68.2 tilts it); A, C, E go along linearly
  Pose target{};
  Frame frame{};
  std::array<double, 3> centre_mm{};
  std::array<double, 3> normal{};  ///< unit vector; the turn is right-handed about it
  double sweep_rad = 0;            ///< > 0; more than 2 pi for several turns
  double feed_per_s = 0;
  double inverse_time_s = 0;
};

/// G38.2 to G38.5: from rest, straight on until the probe touches (or no longer does), at most to the target.
struct Probe {
  Pose target{};
  Frame frame{};
  double feed_per_s = 0;
  bool away = false;  ///< the probe is to let go
  bool must = false;  ///< otherwise it is an error
};

/// Levelling of the bed, for which motion has come to rest. A mesh measured from here on moves what follows.
struct Mesh {
  static constexpr int kMostPoints = 20;  ///< along an axis
  enum class What : std::uint8_t {
    kBegin,      ///< no mesh is in force; the probes that follow measure this grid
    kEnd,        ///< they have: what they found is kept as `name`, and in force
    kOn,         ///< the mesh of this name, or the last one, is in force
    kOff,        ///< none is
    kKeep,       ///< the one in force, as `name`, too
    kForget,     ///< the one of this name
    kFade,       ///< the one in force fades over fade_mm
    kPoint,      ///< the height at `points`, counted from 0, of the one in force
    kTell,       ///< says what is in force
    kTellProbe,  ///< says where the last probe touched
  } what{};
  std::string name{};
  std::array<int, 2> points{};               ///< along X and Y
  std::array<double, 2> from_mm{}, to_mm{};  ///< in table coordinates
  double fade_mm = -1;                       ///< kOn, kFade: below 0: as it is
  double value_mm = 0;                       ///< kPoint
  bool adds = false;                         ///< kPoint: value_mm is added
};

struct Dwell {
  double seconds = 0;
};                 ///< G4: after motion has come to rest
struct PathMode {  ///< G61, G61.1 / G64
  bool exact = false;
  double tolerance_mm = 0;  ///< G64 P; 0: the machine's default
  /// G64 Q, or P without Q: how far the curve through short lines may leave them; 0: the machine's default.
  double merge_tolerance_mm = 0;
  bool merge = true;  ///< false: G64 Q0, short lines stay as they are
};
struct SetPosition {
  Pose pose{};
  Frame frame{};
};               ///< the path's start, or its frame changed in place
struct Limits {  ///< M201/M203/M204/M205; 0: unchanged
  std::array<double, 6> axis_speed_per_s{};
  std::array<double, 6> axis_accel_per_s2{};
  double print_accel_mm_per_s2 = 0;
  double travel_accel_mm_per_s2 = 0;
  double retract_accel_mm_per_s2 = 0;
};
/// M104/M109 (hot end), M140/M190 (bed), M141/M191 (chamber), M106/M107 (fan), M42 (output): handed to the
/// device in path order.
struct Thermal {
  enum class What : std::uint8_t { kHotend, kBed, kFan, kChamber, kOutput } what{};
  double value = 0;  ///< deg C; 0..1 for a fan or an output
  bool wait = false;
  bool wait_cooling = false;  ///< R form: also waits for it to fall
  int index = 0;              ///< among those of its kind
};
/// T of a machine with several hot ends: from here on this one melts what is fed. Motion rests before it.
struct Tool {
  int hotend = 0;
};
/// M3 > 0 (clockwise seen from the spindle), M4 < 0, M5 0. Motion waits at rest until the speed is reached.
struct Spindle {
  double rpm = 0;
};
/// A thread: the moves that follow, planned for a spindle of this speed, go with its angle, from an index
/// pulse on. 0: path time goes by itself again. Motion rests before it.
struct SpindleSync {
  double rpm = 0;         ///< a little more than the spindle is told: path time can be slower, not faster
  double feed_per_s = 0;  ///< of the thread at that speed
  /// > 0: a tap. After this much of its way, where the tool turns back, the spindle turns the other way.
  double turns_back_mm = 0;
};
/// G95 where the spindle is measured: the moves that follow are planned for this speed of it, and are as much
/// slower as it is. 0: no more. Motion goes on.
struct FeedPerTurn {
  double rpm = 0;
};
/// M401, M402, M280: of a probe that has a pin. Motion waits at rest until it is there.
struct ProbePin {
  enum class What : std::uint8_t {
    kOut,
    kIn,
    kSelfTest,  ///< in and out by itself, until it is told something else
    kReset,     ///< ends its alarm, and draws it in
  } what{};
};
/// M66: at rest until the input is as asked, or the time is over. #5399 tells which.
struct AwaitInput {
  enum class Until : std::uint8_t {
    kNow,    ///< nothing is waited for
    kRises,  ///< comes on, after it was off
    kFalls,
    kOn,
    kOff
  } until{};
  int index = 0;
  double seconds = 0;  ///< at most
};
struct Home {             ///< G28
  std::uint8_t axes = 0;  ///< bit per axis in the order of Pose (X bit 0 ... C bit 4); 0: all
  Pose afterwards{};  ///< where the machine has to stand when homing is done (axes not named: as before; E:
                      ///< unchanged)
  Frame frame{};
};
struct Pause {  ///< M0 / M1
  bool optional = false;
  bool filament_change = false;  ///< M600
};
struct MotorsOff {
  std::uint8_t axes = 0;
};                   ///< M18 / M84: bit per axis in the order of Pose; 0: all
struct MotorsOn {};  ///< M17
struct WaitIdle {};  ///< M400
/// M220/M221, ratios; 0: unchanged. For status only: the feeds and E of the commands that follow contain
/// them.
struct Override {
  double feed = 0;
  double flow = 0;
};
struct Message {
  std::string text;
};              ///< M117, (MSG,...)
struct Query {  ///< answered to whoever sent the line
  enum class What : std::uint8_t { kPosition, kFirmware, kSwitches, kTemperature, kSettings } what{};
};
struct EmergencyStop {};  ///< M112
struct StoredJob {        ///< M20..M32
  enum class What : std::uint8_t {
    kList,
    kInit,
    kRelease,
    kSelect,
    kStart,
    kPause,
    kSetPosition,
    kStatus,
    kBeginWrite,
    kEndWrite,
    kDelete,
    kRun
  } what{};
  std::string name;
  std::uint64_t position = 0;  ///< M26 S: byte of the job to go on from
};
/// M900 K, M572 S, SET_PRESSURE_ADVANCE: for the moves that follow. Below 0: unchanged.
struct PressureAdvance {
  double advance_s = -1;
  double smooth_s = -1;
};
/// M593, SET_INPUT_SHAPER: how X, Y and Z are shaped in the moves that follow, from rest. Below 0, or no
/// shaper: unchanged; a frequency of 0: not shaped.
struct InputShaping {
  struct Axis {
    std::optional<ShaperKind> shaper;
    /// Where no shaper was named, and none is in force.
    ShaperKind usual = ShaperKind::kZv;
    double frequency_hz = -1;
    double damping_ratio = -1;
    bool asks() const { return shaper || frequency_hz >= 0 || damping_ratio >= 0; }
  };
  std::array<Axis, 3> axes;
};
struct Settings {
  enum class What : std::uint8_t { kStore, kLoad, kReset, kReport } what{};
};              ///< M500..M503
struct End {};  ///< M2 / M30, or the end of the text

using Command = std::variant<Traverse, Feed, Arc, Dwell, PathMode, SetPosition, Limits, Thermal, Spindle,
                             Home, Pause, MotorsOff, MotorsOn, WaitIdle, Override, Message, Query,
                             EmergencyStop, StoredJob, Settings, End, PressureAdvance, Probe, InputShaping,
                             Mesh, ProbePin, AwaitInput, SpindleSync, Tool, FeedPerTurn>;

/// One command with the line of the job that it came from (1-based).
struct Line {
  std::uint32_t line = 0;
  Command command;
};

}  // namespace kinebus::canonical
