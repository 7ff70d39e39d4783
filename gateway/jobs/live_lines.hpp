#pragma once
// G-code that comes line by line (print host, console) instead of as a whole job. Nobody has checked it
// before, so each line is checked before it is taken: what it would move through is within the machine's
// reach, what it would heat is allowed. A refused line has no effect at all: the next one goes on from where
// the tool is.

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/gcode/interpreter.hpp"
#include "gateway/jobs/problem.hpp"
#include "gateway/jobs/way_rules.hpp"
#include "gateway/result.hpp"

namespace kinebus {

class LiveLines {
 public:
  /// All must outlive this. `printed`: what stands on the table; nullptr: nobody looks.
  LiveLines(const MachineDescription& machine, const Kinematics& kinematics,
            const bodies::PrintedPart* printed = nullptr);

  /// Modal state and limits are forgotten, as after switching on. Work offsets stay: they are the machine's.
  void forget() { restart(gcode::WorkOffsets(work_offsets())); }
  /// The same, with the offsets that were kept since another time.
  void restart(const gcode::WorkOffsets& offsets);
  /// The machine stands at `pose` (Frame::kMachine) and may move from here on. Modal state is kept, also the
  /// program's E. `hotends`: their targets, as far as they are known. Appends what is in force to `out`.
  void begin(const Pose& pose, const HotendTargets& hotends, gcode::CommandBuffer& out);
  /// Lines that move are refused from here on, until begin().
  void end(Sentence why) { still_ = std::move(why); }

  /// Carries out one line (without its end). Refused: why, and nothing has changed.
  Result<void, Problem> take(std::string_view line, std::uint32_t number, gcode::CommandBuffer& out);

  /// A line that was taken probes: none may be taken that moves or looks at what it measures until probed().
  bool probes() const { return answers_due_ > 0; }
  void probed(const gcode::ProbeResult& result);
  /// The same of a line that reads an input.
  void input_read(double value);
  /// A levelling command of a line is carried out; the tool's place is named so from then on.
  void levelled(const std::optional<Pose>& stand, Frame frame);

  /// Sets a work zero as G10 L2 does, or with `here` as L20: `system` 0 is G54. `where`: the machine has been
  /// moved to there (Frame::kMachine) since the last line.
  Result<void, Sentence> set_work_offset(int system, const Pose& offset, bool here,
                                         const std::optional<Pose>& where);
  /// Work coordinates in force: 0 is G54.
  int work_system() const { return interpreter_.state().modal.coordinate_system; }
  const Pose& work_offset() const { return work_offsets()[static_cast<std::size_t>(work_system())]; }
  const gcode::WorkOffsets& work_offsets() const { return interpreter_.state().modal.coordinate_offsets; }

  /// Where the lines lead, or the tool at `where` (Frame::kMachine), as a line would write it: mm and
  /// degrees.
  Pose program_position(const std::optional<Pose>& where);
  double feed_ratio() const { return interpreter_.state().modal.feed_ratio; }  ///< M220
  double flow_ratio() const { return interpreter_.state().modal.flow_ratio; }  ///< M221

  /// What was accepted without effect since the last call, in words.
  std::vector<Sentence> take_notes();

 private:
  struct Place {
    Pose pose{};
    Frame frame = Frame::kMachine;
  };
  void stand_at(const Pose& pose);
  std::uint8_t hotend_in_use() const;
  std::optional<Sentence> check(const canonical::Command& command);
  std::optional<Sentence> check_straight(const Pose& target, Frame frame);
  std::optional<Sentence> check_arc(const canonical::Arc& arc);
  std::optional<Sentence> check_home(const canonical::Home& home);
  std::optional<Sentence> check_thermal(const canonical::Thermal& thermal);
  std::optional<Sentence> check_extrusion(const Pose& target);

  const MachineDescription& machine_;
  const Kinematics& kinematics_;
  WayRules way_;
  gcode::Interpreter interpreter_;
  std::optional<Sentence> still_;  ///< why nothing may move
  Place place_;                    ///< where the lines taken so far lead
  struct Melt {
    HotendTargets celsius{};
    std::uint8_t tool = 0;     ///< the hot end in use
    double hot_e_mm = -1e300;  ///< the farthest that it was fed hot
  } melt_;
  bool cold_noted_ = false, fan_noted_ = false;
  int answers_due_ = 0;
  canonical::Limits limits_{};  ///< in force
  canonical::PressureAdvance advance_{};
  canonical::InputShaping shaping_{};
  std::optional<canonical::PathMode> path_mode_;
  std::vector<Sentence> notes_;
};

/// Values that are stated (not 0) take the place of the ones before.
void merge_limits(canonical::Limits& all, const canonical::Limits& more);

}  // namespace kinebus
