#pragma once
// Everything that the interpreter remembers between two lines. Plain data: copy it to save a point to resume
// from.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "gateway/gcode/canonical.hpp"
#include "gateway/gcode/curves/cutter.hpp"
#include "gateway/gcode/curves/nurbs.hpp"
#include "gateway/gcode/dialects.hpp"

namespace kinebus::gcode {

enum Axis : std::uint8_t { kAxisX, kAxisY, kAxisZ, kAxisA, kAxisC, kAxisE };
inline constexpr int kAxes = 6;
inline constexpr int kCoordinateSystems = 9;  ///< G54 .. G59, G59.1 .. G59.3
/// Work zeros of G54 .. G59.3 in the machine's coordinates: X Y Z A C, and at kSystemTurn the angle of G10 R.
using WorkOffsets = std::array<Pose, kCoordinateSystems>;
/// Where E of a pose would stand: how far a coordinate system is turned about Z, rad.
inline constexpr std::size_t kSystemTurn = kAxisE;

enum class Motion : std::uint8_t { kNone, kTraverse, kFeed, kArcClockwise, kArcCounterclockwise };
enum class Plane : std::uint8_t { kXy, kZx, kYz };

using Matrix3 = std::array<std::array<double, 3>, 3>;
inline constexpr Matrix3 kIdentity{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// Modal codes, offsets and position. Trivially copyable. Lengths mm, angles rad, whatever units the job
/// uses.
struct ModalState {
  Motion motion = Motion::kNone;
  Plane plane = Plane::kXy;
  Frame frame = Frame::kMachine;   ///< of `position`
  bool inches = false;             ///< G20
  bool incremental = false;        ///< G91
  bool incremental_e = false;      ///< M83, or since G91
  bool relative_extruder = false;  ///< M83: what G90 goes back to
  bool absolute_centre = false;    ///< G90.1
  bool inverse_time = false;       ///< G93
  bool feed_per_turn = false;      ///< G95: feed_mm_per_s follows from F and the last S
  bool tool_centre_point = false;  ///< G43.4
  bool exact_path = false;         ///< G61, G61.1
  bool g92_active = false;
  bool tilted = false;  ///< G68.2
  bool feed_known = false;
  bool traverse_limited = false;  ///< an F stood with G0: it limits G0 (Options::traverse_uses_feed)
  bool retracted = false;         ///< G10
  bool ended = false;             ///< M2, M30 or the closing % was read
  bool g28_stored = false, g30_stored = false;  ///< by G28.1, G30.1
  bool surface_speed = false;                   ///< G96
  bool content_seen = false;                    ///< a block came before: a % now is the closing one
  bool merge_lines = true;                      ///< not G64 Q0
  bool threads = false;                         ///< the machine has a spindle: G33 is a thread
  bool a_extrudes = false;                      ///< A of this text is E (Mach3, Machinekit)
  int spindle_turns = 0;                        ///< M3 1, M4 -1, M5 0
  int tool = 0;
  double per_turn_rpm = 0;               ///< as canonical::FeedPerTurn has told it last
  double thread_mm = 0;                  ///< K of the G33 under way; 0: none is
  double spindle_rpm = 0;                ///< the last S, or what G96 has made of it
  double surface_m_per_min = 0;          ///< the last S under G96
  double surface_most_rpm = 0;           ///< D of G96; 0: the spindle's own limit
  int tools = 1, hotends = 1;            ///< the machine has
  int coordinate_system = 0;             ///< 0: G54
  int tool_in_spindle = -1;              ///< by M6; -1: not known
  CutterSide cutter = CutterSide::kOff;  ///< G41, G42; not kOff: the tool is where State::cutter has it
  Dialect dialect = Dialect::kGeneral;
  bool retract_to_r = false;  ///< G99
  int cycle = 0;              ///< canned cycle in force, in tenths (810); 0: none

  double cycle_initial_mm = 0;  ///< where the first of its row began
  double cycle_r_mm = 0, cycle_bottom_mm = 0, cycle_peck_mm = 0, cycle_dwell_s = 0;  ///< G91: as increments
  std::array<double, 2> spline_end_mm{};  ///< G5 P Q of the line before
  bool spline = false;                    ///< the line before was a G5
  int nurbs = 0;                          ///< 52, 62: G5.2 or G6.2 has begun State::nurbs; 0: neither
  Pose nurbs_start{};                     ///< where it begins, as the job would write it
  bool plane_rotation = false;            ///< `tilted` by G68: the tool does not turn with the plane

  std::array<double, 8> hotend_celsius{};  ///< targets, for M116
  double bed_celsius = 0, chamber_celsius = 0;

  int object = -1;               ///< of the print, at work; -1: none
  bool objects_by_code = false;  ///< codes say where objects begin: comments of slicers do not count
  bool left_out = false;         ///< it is excluded: its moves are not given out
  bool away = false;             ///< moves were left out: the machine stands at real_position
  Pose real_position{};          ///< while away; position is where the text has the tool
  Frame real_frame = Frame::kMachine;
  double e_max_mm = 0;       ///< the farthest that canonical E has been: behind it filament is retracted
  double real_e_max_mm = 0;  ///< while away

  double path_tolerance_mm = 0;        ///< G64 P
  double merge_tolerance_mm = 0;       ///< G64 Q
  double tool_length_mm = 0;           ///< G43 H; 0 after G49
  std::array<double, 2> tool_xy_mm{};  ///< G43 of a tool to which G10 L1, L10 or L11 gave X and Y

  double feed_mm_per_s = 0;   ///< the last F as a tool speed
  double feed_rad_per_s = 0;  ///< the same F for a move of only A and C
  double feed_ratio = 1;      ///< M220
  double flow_ratio = 1;      ///< M221

  WorkOffsets coordinate_offsets{};
  Pose g92_offset{};  ///< X Y Z A C; E unused

  std::array<double, 3> tilt_origin_mm{};
  Matrix3 tilt = kIdentity;  ///< columns: the plane's X, Y, Z in work coordinates

  /// E: canonical = e_canonical_base + flow_ratio * (programmed - e_program_base), less the retraction.
  double e_program_base_mm = 0, e_canonical_base_mm = 0;
  double retracted_mm = 0, lifted_mm = 0;  ///< what G10 took back, and how high it lifted
  double retract_length_mm = 0, retract_mm_per_s = 0, retract_lift_mm = 0;  ///< M207
  double recover_extra_mm = 0, recover_mm_per_s = 0;                        ///< M208

  Pose program{};   ///< the current point as the job would write it (mm, rad)
  Pose position{};  ///< the same point as the last canonical command left it
};

/// Of RepRapFirmware's expressions; monostate: null.
using MetaValue = std::variant<std::monostate, bool, double, std::string>;
struct MetaVariable {
  static constexpr std::size_t kMost = 200;
  std::string name;
  MetaValue value;
  std::size_t indent = 0;  ///< of the line that made it: it is gone where a line stands farther out
};

using NamedValues = std::vector<std::pair<std::string, double>>;

/// #1 .. #5602 and #<name>.
struct ParameterState {
  static constexpr int kCount = 5603;
  static constexpr std::size_t kLocals = 30;  ///< #1 .. #30 belong to the subroutine at work
  static constexpr std::size_t kMaxNamed = 1000;
  static constexpr std::size_t kMaxNameLength = 64;
  std::array<double, kCount> numbered{};
  NamedValues named;       ///< those that begin with _: everybody's; sorted by name
  NamedValues locals;      ///< the others: of the subroutine at work; sorted by name
  double iterations = -1;  ///< of the meta while at work, that are done; below 0: none is at work
  std::vector<MetaVariable> meta_locals, meta_globals;  ///< var. (of the text or macro at work), global.
};

/// An object of a print, as EXCLUDE_OBJECT_DEFINE or M486 name it.
struct PrintObject {
  static constexpr std::size_t kMost = 1000, kMaxName = 200;
  std::string name;  ///< lower case
  int number = -1;   ///< M486 S; -1: none
  bool excluded = false;
};

/// A tool as G10 L1, L10 and L11 have written it.
struct ToolEntry {
  static constexpr std::size_t kMost = 1000;
  int tool = 0;
  std::array<double, 3> offset_mm{};
  double diameter_mm = 0;
  int orientation = 0;  ///< of a lathe's tool: where its tip is, as LinuxCNC counts; 0 and 9: in its middle
};

/// Of M70 and M73; without modes nothing is kept.
struct SavedModes {
  std::optional<ModalState> modes;
  bool at_return = false;  ///< M73: taken back where the subroutine ends
};

struct State {
  ModalState modal;
  CutterPath cutter;
  Nurbs nurbs;  ///< of the lines since ModalState::nurbs was set
  std::vector<PrintObject> objects;
  /// Of all objects that were defined with their shape: X Y least and greatest, as the text writes them.
  std::optional<std::array<double, 4>> print_area{};
  ParameterState parameters;
  std::vector<ToolEntry> tools{};  ///< those that differ from the machine file's
  SavedModes saved;                ///< of the subroutine at work
};

}  // namespace kinebus::gcode
