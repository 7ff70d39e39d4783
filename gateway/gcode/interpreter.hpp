#pragma once
// G-code lines to canonical commands: RS274/NGC and the 3D-printing dialect in one interpreter.
// The supported codes are listed in gateway/gcode/README.md.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/gcode/canonical.hpp"
#include "gateway/gcode/error.hpp"
#include "gateway/gcode/words/expression.hpp"
#include "gateway/gcode/words/state.hpp"
#include "gateway/result.hpp"

namespace kinebus::gcode {

/// Canonical commands are appended here; the caller clears and reuses it, so that nothing is allocated per
/// line.
using CommandBuffer = std::vector<canonical::Line>;

/// A subroutine of the machine file: "start_print" in lower case, and its lines.
struct Macro {
  std::string name;
  std::string text;
};

/// What a line asks of whoever gives the interpreter its lines (Program).
struct ProgramCall {
  enum class What : std::uint8_t { kNone, kProgram, kReturn, kMacro, kProfile } what = What::kNone;
  std::uint32_t column = 0;
  int number = 0;                ///< M98 P, G71 Q
  int times = 1;                 ///< M98 L
  std::string name;              ///< of the macro
  NamedValues arguments;         ///< sorted by name
  std::vector<double> numbered;  ///< #1 ...
};

/// A line of a meta command, to be carried out.
struct MetaLine {
  std::string_view text, word;  ///< "set"
  std::size_t rest_at = 0;      ///< what follows the word
  std::size_t indent = 0;
  std::uint32_t number = 0, column = 1;
};

/// What belongs to one subroutine at work alone.
struct Locals {
  std::array<double, ParameterState::kLocals> numbers{};
  NamedValues names;
  std::vector<MetaVariable> variables;
  SavedModes saved;
};

enum class DwellUnit : std::uint8_t { kByDialect, kMilliseconds, kSeconds };

/// What the machine file says about the dialect.
enum class ProbeFitted : std::uint8_t { kNone, kSimulated, kFitted };

/// How a probing move has ended.
struct ProbeResult {
  bool contact = false;
  Pose at{};     ///< the tool when the probe touched, or at the end of a move without contact
  Pose stand{};  ///< where it has come to rest
  Frame frame{};
};

/// #5399 behind M66 when the time is over.
inline constexpr double kNoInput = -1;

/// What G29 probes, unless its words say less. In table coordinates.
struct MeshOptions {
  std::array<int, 2> points{5, 5};
  std::array<double, 2> from_mm{-50, -50}, to_mm{50, 50};
  double lift_mm = 5;   ///< of the probe over the table between two points
  double depth_mm = 2;  ///< so far below the table it looks for the bed
};

struct Options {
  Pose start{};                ///< where the machine stands when the job begins, machine frame (mm, rad)
  Pose home{};                 ///< where it stands after G28, machine frame; E unused
  WorkOffsets work_offsets{};  ///< in force when the program begins
  /// kGeneral: as a text's header says, if it does.
  Dialect dialect = Dialect::kGeneral;
  /// G4 P counts milliseconds in printer firmware and seconds in RS274/NGC. G4 S is always seconds.
  DwellUnit dwell_p_unit = DwellUnit::kByDialect;
  double default_feed_mm_per_s = 0;  ///< until the first F; 0: a feed move without F is refused
  /// Of kGeneral. As Cura writes travel: once a program has written an F with G0, G0 goes no faster than the
  /// F in force.
  bool traverse_uses_feed = false;
  bool block_delete = false;  ///< lines that begin with / are skipped
  /// How far the start and end radius of an arc may differ. Arcs within it are corrected to go through both
  /// ends.
  double arc_radius_tolerance_mm = 0.005;
  double a_min_rad = -0.7853981633974483, a_max_rad = 0.7853981633974483;  ///< what G53.1 may choose from
  bool spindle = false;                                                    ///< there is one: M3, M4, M5 and S
  bool spindle_encoder = false;                     ///< it tells its angle: G33 and G76
  double tap_rpm_per_s = 0;                         ///< how fast a tap turns it back; 0: no taps
  double spindle_min_rpm = 0, spindle_max_rpm = 0;  ///< what G96 may ask for; 0: no limit
  int tools = 1;                                    ///< T0 .. T(tools - 1)
  int hotends = 1;                                  ///< M104 T0 .. T(hotends - 1)
  std::vector<double> tool_length_mm;               ///< G43 H1 is the first entry
  std::vector<double> tool_diameter_mm;             ///< G41 D1 is the first entry; 0: not known
  std::vector<double> tool_orientation;             ///< of the same: where a lathe's tip is, 1 to 8; 0: none
  double retract_length_mm = 1, retract_mm_per_s = 40, retract_lift_mm = 0;  ///< until M207
  double recover_extra_mm = 0, recover_mm_per_s = 40;                        ///< until M208
  ProbeFitted probe = ProbeFitted::kNone;
  bool probe_pin = false;                   ///< it has a pin that M401, M402 and M280 move
  double probe_mm_per_s = 10;               ///< no probing is faster
  std::array<double, 3> probe_offset_mm{};  ///< where the probe touches, from the tool's tip, A and C at 0
  MeshOptions mesh;
  std::vector<Macro> macros;
  /// Lines of loops and subroutines that a text carries out at most, so that one without end is an error.
  std::uint64_t most_recorded_steps = 10'000'000;
};

class Core;

/// Reads lines one after the other. Sans-IO, no exceptions; a plain G1 line costs no allocation.
class Interpreter {
 public:
  explicit Interpreter(Options options = {});
  ~Interpreter();
  Interpreter(Interpreter&&) noexcept;
  Interpreter& operator=(Interpreter&&) noexcept;

  /// Carries out one line (without its line end). Appends canonical commands; the first call appends
  /// SetPosition first. On an error nothing of the line is done: state and `out` are as before the call.
  /// Lines after the program's end (M2, M30, second %) begin a new program, with the modal state reset as
  /// RS274/NGC says.
  Result<void, ParseError> execute(std::string_view line, std::uint32_t line_number, CommandBuffer& out);

  /// The text is at its end: appends End unless the job did.
  void finish(std::uint32_t line_number, CommandBuffer& out);

  /// M2, M30 or the closing % was read: the rest of a file is not part of the program.
  bool ended() const { return state().modal.ended; }

  /// Cutter compensation is on: moves are held back.
  bool compensates() const;
  /// A NURBS has begun: its end has still to come.
  bool in_nurbs() const { return state().modal.nurbs != 0; }

  const State& state() const;
  /// Goes on from a saved state; the next line appends SetPosition first.
  void restore(const State& state);
  /// The machine was moved by something else (jog, homing, reset) and stands here; E is kept. The next line
  /// appends SetPosition first.
  void set_position(const Pose& pose, Frame frame);

  /// What a canonical::Probe has come to: #5061 to #5070 tell it, and the next line goes on from where the
  /// tool stands. Until then lines are read as if it had touched at its target.
  void set_probed(const ProbeResult& result);
  /// What a canonical::AwaitInput has come to: #5399 tells it. 1 or 0: the input; kNoInput: it did not come.
  /// Until then lines are read as if what was waited for had come.
  void set_input(double value);

  /// From the next line on an object of the print is left out, as by EXCLUDE_OBJECT NAME= in the text.
  /// `name`: in any case, or the number that M486 gave it. Refused while cutter compensation holds moves
  /// back.
  Result<void, Sentence> exclude_object(std::string_view name);

  /// Sets a work zero (X Y Z A C; `system` 0 is G54) as G10 L2 does; with `here` as G10 L20: the current
  /// point gets these coordinates. Refused in a tilted plane.
  Result<void, Sentence> set_work_offset(int system, const Pose& offset, bool here);

  // For Program, which carries out lines in the order of O words.
  /// Reads the value at line[at] and leaves `at` behind it.
  bool evaluate(std::string_view line, std::size_t& at, double& value, SyntaxError& error) const;
  void swap_locals(Locals& locals);
  /// A subroutine ends, its locals still there: what M73 kept is in force from the next line on.
  void end_subroutine();
  /// var, global, set, echo, abort.
  Result<void, ParseError> run_meta(const MetaLine& line, CommandBuffer& out);
  /// What stands behind if, elif and while.
  Result<bool, ParseError> meta_condition(const MetaLine& line);
  /// Of the meta while at work, that are done; below 0: none is at work.
  void set_iterations(double done);
  /// The text may hold meta commands: its dialect is RepRapFirmware's, or not stated.
  bool takes_meta() const;
  /// The subroutine that G70, G71 or G72 asked for has ended: the cycle's moves. Without it nothing of its
  /// line is done.
  Result<void, ParseError> cut_profile(CommandBuffer& out);
  void drop_profile();
  /// endsub, return: #<_value> and #<_value_returned>.
  void set_returned(double value, bool given);
  const Options& options() const;
  /// A comment of the text's beginning. Where it names a slicer or firmware whose A is extrusion, A is E from
  /// here on, with a note when it is first used; where it names a dialect and Options does not, the text is
  /// read as that, with a note. Refused: one that measures extrusion in mm^3.
  Result<void, ParseError> read_header(std::string_view comment, std::uint32_t line_number);
  bool has_macro(std::string_view name) const { return find_macro(name) != nullptr; }
  /// Which exists; lives as long as this.
  std::string_view macro_text(std::string_view name) const { return find_macro(name)->text; }
  /// What the last line asked for.
  const ProgramCall& call() const;
  ProgramCall take_call();

  /// The current point as the job would write it: mm and degrees.
  Pose program_position() const;
  /// "G1 G17 G21 G90 G91.1 G94 G54 G49 G64 G69 M82": for status displays.
  std::string modal_codes() const;

  /// What was accepted without effect since clear_notes(), once for each code.
  std::span<const Note> notes() const;
  void clear_notes();

 private:
  const Macro* find_macro(std::string_view name) const;

  std::unique_ptr<Core> core_;
};

}  // namespace kinebus::gcode
