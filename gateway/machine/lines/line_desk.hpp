#pragma once
// Lines as they come from a print host or a console, each checked before it is taken; and the machine's work
// offsets, which they set.

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/jobs/journal/journal_queue.hpp"
#include "gateway/jobs/live_lines.hpp"
#include "gateway/result.hpp"
#include "gateway/run/planned_pose.hpp"
#include "gateway/status/refusal.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class LineDesk {
 public:
  LineDesk(const MachineDescription& machine, const Kinematics& kinematics, journal::Queue& journal,
           const bodies::PrintedPart* printed);

  /// As the gateway before has left them.
  void restart(const gcode::WorkOffsets& offsets) { lines_.restart(offsets); }
  /// Lines may move from here on; what is in force goes before them.
  const gcode::CommandBuffer& open(const Pose& pose, const HotendTargets& hotends);
  /// No more lines are taken: those that were are carried out.
  void close() { closing_ = true; }
  bool closing() const { return closing_; }
  /// What is not carried out by then is not wanted any more.
  void give_up_from(BusTime when) { give_up_from_ = when; }
  bool given_up(BusTime now) const { return closing_ && give_up_from_ && now >= *give_up_from_; }

  /// What one line means, valid until the next one. `still`: why it may not move.
  Result<std::span<const canonical::Line>, Refusal> take(std::optional<Sentence> still, std::string_view line,
                                                         std::uint32_t number);
  bool probes() const { return lines_.probes(); }
  void probed(const gcode::ProbeResult& result) { lines_.probed(result); }
  void input_read(double value) { lines_.input_read(value); }
  void levelled(const std::optional<PlannedPose>& stand) {
    lines_.levelled(stand ? std::optional(stand->pose) : std::nullopt,
                    stand ? stand->frame : Frame::kMachine);
  }
  std::vector<Sentence> take_notes() { return lines_.take_notes(); }
  void forget_modes() { lines_.forget(); }

  /// `where`: the tool's pose, Frame::kMachine, when it is not where the lines have led it.
  Result<void, Refusal> set_work_offset(std::uint32_t system, const Pose& offset, bool here,
                                        const std::optional<Pose>& where);
  Pose program_position(const std::optional<Pose>& where) { return lines_.program_position(where); }
  double feed_ratio() const { return lines_.feed_ratio(); }
  double flow_ratio() const { return lines_.flow_ratio(); }
  const gcode::WorkOffsets& work_offsets() const { return lines_.work_offsets(); }
  /// 1 (G54) .. 9 (G59.3)
  int work_system() const { return lines_.work_system() + 1; }
  const Pose& work_offset() const { return lines_.work_offset(); }

 private:
  void note_offsets(const gcode::WorkOffsets& before);

  const MachineDescription& machine_;
  journal::Queue& journal_;
  LiveLines lines_;
  gcode::CommandBuffer commands_;  ///< of the line at work
  bool closing_ = false;
  std::optional<BusTime> give_up_from_;
};

}  // namespace kinebus
