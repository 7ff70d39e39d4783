#pragma once
// Inside of the interpreter. One block is carried out step by step in the order of RS274/NGC, table 8; each
// step is a function that returns false after fail(). One bool, because an expected<void, ParseError> per
// step would cost more than the step itself.
//   core.cpp            lines, order of execution, errors      modes.cpp       modal codes, feed, dwell
//   moves.cpp           G0-G3, G53, retraction                 offsets.cpp     coordinate systems, frames,
//   G28 machine_codes.cpp   M codes                        cutter_codes.cpp G40-G42.1

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/gcode/curves/turning.hpp"
#include "gateway/gcode/dialects.hpp"
#include "gateway/gcode/interpreter.hpp"
#include "gateway/gcode/words/block.hpp"
#include "gateway/gcode/words/rotation.hpp"

namespace kinebus::gcode {

/// Changes smaller than this (mm, rad) are rounding, not motion.
inline constexpr double kNoMotion = 1e-9;

class Core {
 public:
  /// Where G29 probes; what is not stated is the machine's.
  struct MeshArea {
    std::array<std::optional<double>, 2> from_mm{}, to_mm{};  ///< canonical X and Y
    std::array<int, 2> points{};                              ///< 0: the machine's
    bool adaptive = false;  ///< fewer points where the area is smaller than the machine's
  };
  /// A word of a Klipper command by its name, in lower case.
  using WordOf = std::function<std::optional<std::string_view>(std::string_view)>;

  explicit Core(Options options);

  bool execute(std::string_view line, std::uint32_t line_number, CommandBuffer& out);
  void finish(std::uint32_t line_number, CommandBuffer& out);
  void restore(const State& state);
  void set_position(const Pose& pose, Frame frame);

  void set_probed(const ProbeResult& result);
  void set_input(double value) { state_.parameters.numbered[kInputRead] = value; }
  bool set_work_offset(int system, const Pose& offset, bool here);
  bool exclude_object(std::string_view name);

  const State& state() const { return state_; }
  const ParseError& error() const { return error_; }
  std::vector<Note>& notes() { return notes_; }
  const Options& options() const { return options_; }

  void swap_locals(Locals& locals);
  bool meta_command(const MetaLine& line, CommandBuffer& out);
  bool meta_condition(const MetaLine& line, bool& holds);
  void set_iterations(double done) { state_.parameters.iterations = done; }
  void set_returned(double value, bool given);
  void end_subroutine();
  bool read_header(std::string_view comment, std::uint32_t line_number);
  const Macro* find_macro(std::string_view name) const;
  /// The lines that come are the profile of G70 to G72.
  bool in_profile() const { return profile_.open; }
  bool execute_in_profile(std::string_view line, std::uint32_t line_number, CommandBuffer& out);
  bool cut_profile(CommandBuffer& out);
  void drop_profile();
  const ProgramCall& call() const { return call_; }
  ProgramCall take_call() { return std::exchange(call_, {}); }

 private:
  static constexpr std::size_t kInputRead = 5399;
  /// Of G70 to G72, while its lines come.
  struct Profile {
    bool open = false;
    std::uint32_t column = 0, line = 0;
    ModalState before, after;  ///< of the cycle's line
    Turning turning;
    Point2 start{}, here{};  ///< Z and X, canonical
    std::vector<Curve> moves;
    bool at_work = false;  ///< one of its lines is
    std::size_t from = 0;  ///< where the output of that line begins
  };
  struct FeedRate {
    bool known = false;
    double mm_per_s = 0, rad_per_s = 0;
  };

  // core.cpp
  bool fail(std::uint32_t column, Sentence message);
  /// The axes of the plane: counterclockwise is from u to v, seen from the positive end of w.
  struct PlaneAxes {
    std::size_t u, v, w;
  };
  PlaneAxes plane_axes() const;
  bool run_careful();  ///< any block; state and output are put back on an error
  bool run_block();
  bool run_nonmodal(Code code);
  bool run_stop();
  bool ends_program(Code code) const;
  bool assign_parameters();
  bool check_leftovers();
  void begin_program();
  void announce();
  canonical::Command& emit(canonical::Command command);
  void note(int key, Sentence text);

  void set_dialect(Dialect dialect);
  void follow_dialect();  ///< the state's
  bool call_code_macro(std::string_view line);
  bool is_harmless() const;  ///< the line's first code has no effect here, so that a macro may have its name

  // Words. take(): the word belongs to the code at work; refused when it has no number or another code took
  // it.
  bool has(char letter) const { return block_.has(letter) && (used_ & Block::bit(letter)) == 0; }
  bool take(char letter, double& value);
  bool take_if_given(char letter, double& value);
  bool take_integer(char letter, int lowest, int highest, int& value);
  void pass_over(char letter) { used_ |= Block::bit(letter) & block_.present; }
  double length(double value) const { return state_.modal.inches ? value * 25.4 : value; }
  /// A word's value for an axis, in mm or rad.
  double axis_value(int axis, double value) const;

  // modes.cpp
  bool run_modes();
  bool run_feed_word();
  bool feed_from(double value, FeedRate& feed);
  bool dwell();
  /// P of G4 and of canned cycles.
  double dwell_s(double p) const;
  bool change_tool();
  /// Which of the machine's hot ends M104 means, and what is fed.
  int hotend_in_use() const;
  void tell_hotend(int before);
  canonical::PathMode path_mode() const;
  bool set_path_mode(Code code);

  // polar.cpp
  bool has_polar() const { return block_.polar_radius || block_.polar_angle; }
  bool polar_words();

  // moves.cpp
  bool run_motion();
  bool run_straight(bool traverse);
  bool run_arc(bool clockwise);
  bool run_machine_coordinates();
  void program_target(Pose& program) const;
  bool move_to(const Pose& program, const Pose& target, bool traverse);
  bool check_turning();
  bool speed_for(bool turns_alone, const FeedRate& feed, double& feed_per_s, double& inverse_time_s);
  bool arc_words(const Pose& start, bool& by_radius, double& radius_mm, std::array<double, 2>& centre,
                 int& turns);
  bool retract();
  bool recover();

  // cycles.cpp
  bool run_cycle();
  bool cycle_words(Code code, bool fresh);
  bool drill(std::size_t w, double r, double bottom, double clear);
  bool cycle_move(const Vector3& program, bool traverse);

  // threading_codes.cpp
  struct ThreadCycle;
  bool may_thread(Code code, const std::string& name);
  bool thread(Code code);
  bool thread_target(Code code, const std::string& name, double& pitch_mm, Vector3& point);
  bool rigid_tap(Code code);
  bool taps_rigidly() const;
  /// To `bottom` and back to `clear`, program coordinates; then the spindle turns as before.
  bool tap(const Vector3& bottom, const Vector3& clear, double pitch_mm);
  bool threading_cycle(Code code);
  bool thread_words(Code code, ThreadCycle& cycle);
  bool thread_pass(const ThreadCycle& cycle, const Vector3& start, double depth);
  bool thread_move(const Vector3& program, double pitch_mm);
  void begin_thread(double pitch_mm);
  void end_thread();  ///< of G33, where one is under way

  // turning_codes.cpp
  bool begin_turning(Code code);
  bool turning_words(Code code, Turning& turning);
  bool take_profile();

  // probing.cpp
  bool probe(Code code);
  bool probe_target(Code code, Pose& program, Pose& target);
  void tell_probed(const Pose& program, bool contact);

  // levelling.cpp
  static constexpr int kNoteForMesh = 150000;
  bool level_bed();
  bool probe_once(Code code);
  bool mesh_code(Code code);
  bool mesh_word(const std::string& name, const WordOf& word);
  bool mesh_command(std::uint32_t column, canonical::Mesh command);
  bool measure_mesh(std::uint32_t column, std::string name, const MeshArea& area);
  void see_pin_in();
  void probe_down(Pose at, double clear);
  void probe_within(const ProbeResult& result);
  bool note_no_levelling(int code, const std::string& name);
  void add_to_print_area(std::string_view points);

  // spiral.cpp
  bool is_spiral(const std::array<double, 2>& from, const std::array<double, 2>& to,
                 const std::array<double, 2>& centre) const;
  bool run_spiral(const Pose& program, const std::array<double, 2>& centre, bool clockwise, int turns);

  // stored_positions.cpp
  bool is_stored(Code code) const;
  bool store_position(Code code);
  bool go_to_stored(Code code);

  // splines.cpp
  bool run_spline(Code code);

  // nurbs_codes.cpp
  bool run_nurbs();
  bool begin_nurbs(Code code);
  bool end_nurbs(Code code);
  bool nurbs_order(char letter);
  void add_nurbs_point(double weight);
  bool check_beside_nurbs();

  // moves.cpp
  void move_lift(double height_mm);

  // offsets.cpp
  bool select_coordinate_system(Code code);
  bool set_coordinate_system();
  void set_offset(std::size_t system, std::size_t axis, double value, bool here);
  /// A work zero in a turned system: those given, else as they are; program coordinates.
  void set_turned_offset(std::size_t system, const std::array<std::optional<double>, 2>& xy);
  bool set_tool_table(Code code, int l);
  ToolEntry tool_entry(int tool) const;
  bool is_turned() const { return turned_; }
  Matrix3 turn_of(std::size_t system) const;
  /// The directions of the program's axes (G68, G68.2, G10 R) in canonical coordinates.
  Matrix3 program_axes() const;
  bool set_g92(Code code);
  bool set_tool_length(Code code);
  bool set_tilt(Code code);
  bool rotate_plane(Code code);
  bool set_local_offset(Code code);
  bool orient_tool();
  bool home();
  bool refuse_in_tilt(Code code);
  Frame wanted_frame() const;
  void change_frame();
  void refresh_shift();
  void refresh();  ///< after any change of an offset: shift_ and the program's current point
  Vector3 offset_xyz() const;
  Vector3 to_canonical_xyz(const Vector3& program) const;
  double canonical_e(double program_e) const;
  Pose canonical_pose(const Pose& program) const;
  void base_e_here(double program_e);  ///< the current point's E gets this number

  // cutter_codes.cpp: cutter compensation
  bool cutter_is_on() const {
    return state_.modal.cutter == CutterSide::kLeft || state_.modal.cutter == CutterSide::kRight;
  }
  bool cutter_on(Code code);
  bool cutter_tool(Code code, double& diameter, int& orientation);
  bool cutter_off();
  bool check_beside_cutter();
  bool refuse_beside_cutter(Code code, const std::string& name);
  bool compensate();  ///< what the line has given out since the last call
  void end_beside();

  // saved_modes.cpp
  bool saved_modes(Code code);
  bool restore_modes(std::uint32_t column);
  bool restore_due_modes();

  // machine_codes.cpp
  bool run_machine_code(Code code);
  bool spindle(Code code);
  /// An S that no code of the line owns: the spindle's speed.
  bool spindle_speed();
  bool spindle_mode();
  /// Under G96: the speed for where the tool is.
  void follow_surface(bool now);
  /// Whether feed goes by the measured speed, and which it is planned for.
  void tell_feed_per_turn();
  double surface_rpm() const;
  bool thermal(Code code);
  bool value_by_p(Code code);
  double target_of(const canonical::Thermal& thermal) const;
  bool fan(Code code);
  bool await_input(Code code);
  bool motors(Code code);
  bool axis_limits(Code code);
  bool axis_acceleration(Code code);
  bool acceleration_limits();
  bool jerk();
  bool firmware_setting(Code code);
  bool retract_settings(Code code);
  bool override_ratio(Code code);
  bool probe_pin(Code code);
  bool stored_job(Code code);
  bool tool_temperature(char tool_letter);
  bool wait_for_temperatures();
  void remember(const canonical::Thermal& thermal);
  bool program_call(Code code);

  // pressure_advance.cpp
  bool pressure_advance(Code code);
  /// What is not given stays as it is.
  bool set_pressure_advance(std::uint32_t column, std::optional<double> advance_s,
                            std::optional<double> smooth_s);

  // input_shaping.cpp
  bool input_shaping();
  /// SET_INPUT_SHAPER: a word and what stands behind its =.
  struct ShaperWord {
    std::string_view name, text;
    std::optional<double> value;
  };
  bool set_input_shaper(std::uint32_t column, std::span<const ShaperWord> words);

  // objects.cpp: objects of a print that are left out
  struct ObjectCommand {
    std::string_view word;  ///< "exclude_object_start", lower case
    std::string name;
    bool current = false, reset = false;
  };
  bool object_command(const ObjectCommand& command);
  bool object_code(Code code);
  std::size_t object_named(std::string_view name);
  std::size_t object_numbered(int number);
  /// True: it says where an object begins or ends.
  bool read_object_comment(std::string_view comment);
  void begin_object(std::size_t object);
  void exclude(std::size_t object, bool out);
  void look_whether_left_out();
  bool leave_out(std::size_t from, const ModalState& before);
  void come_back(const Pose& goal, double shift_e, std::uint32_t line);

  // meta_commands.cpp
  bool macro_file_call();
  void leave_meta_blocks(std::size_t indent);

  // commands.cpp: words of Klipper and macros
  bool run_command();

  Options options_;
  State state_;
  Block block_;
  ParseError error_;
  std::vector<Note> notes_;
  std::vector<int> noted_;
  ProgramCall call_;  ///< what the line at work asks for
  Profile profile_;
  SavedModes modes_due_;  ///< before the next line: of the subroutine that has ended
  CommandBuffer* out_ = nullptr;
  std::size_t uncompensated_ = 0;  ///< where in out_ the line's commands begin that compensate() has not seen
  std::uint32_t line_ = 0;
  std::uint32_t used_ = 0;  ///< words of the block that a code has taken
  Pose shift_{};            ///< canonical = program + shift for X Y Z A C, where no plane is tilted or turned
  const DialectRules* rules_ = nullptr;  ///< of the dialect in force
  bool traverse_has_feed_ = false;
  std::array<double, 2> polar_step_{};  ///< of the line at work under G91: radius, mm, and angle, rad
  bool probe_goes_on_ = false;          ///< behind its probe the line at work has moves of its own
  bool probe_sets_z_ = false;           ///< what it touches gets Z 0
  bool turned_ = false;                 ///< the coordinate system in force is turned (G10 R)
  bool announce_ = true;                ///< SetPosition is due before the next command
};

/// The letters of the axes, in the order of Pose.
inline constexpr std::array<char, kAxes> kAxisLetters = {'X', 'Y', 'Z', 'A', 'C', 'E'};

}  // namespace kinebus::gcode
