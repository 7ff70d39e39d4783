#pragma once
// An interrupted job: what is left of it, whether it can go on, and the way back to its exact place.

#include <memory>
#include <optional>
#include <vector>

#include "gateway/bus_nodes/bring_up.hpp"
#include "gateway/description/machine_description.hpp"
#include "gateway/gcode/canonical.hpp"
#include "gateway/jobs/byte_source.hpp"
#include "gateway/jobs/journal/journal_queue.hpp"
#include "gateway/jobs/journal/journal_state.hpp"
#include "gateway/kinematics/kinematics.hpp"
#include "gateway/machine/position.hpp"
#include "gateway/result.hpp"
#include "gateway/run/planned_pose.hpp"
#include "gateway/status/refusal.hpp"

namespace kinebus {

class Recovery {
 public:
  Recovery(const MachineDescription& machine, const Kinematics& kinematics, journal::Queue& journal)
      : machine_(machine), kinematics_(kinematics), journal_(journal) {}

  // What the gateway before has left.
  struct Left {
    journal::State state;
    std::unique_ptr<ByteSource> job;
    bool replaying = false;  ///< its text is read up to its place; the print job has it
  };
  void take_up(journal::State state, std::unique_ptr<ByteSource> job);
  std::optional<Left>& left() { return left_; }
  const std::optional<Left>& left() const { return left_; }
  /// Path time up to which the job left is done.
  PathTime left_tau() const;

  // Where the nodes were found.
  /// Before a bring-up: the gateway's own path time.
  void bring_up_begins(PathTime tau) { tau_before_ = tau; }
  /// A bring-up has read the nodes' path times and may change them: the journal must know them first.
  void note_found(BusTime now, const BringUp& bring_up);
  /// What was found is not yet on the disk, and the nodes are about to lose it.
  bool waits_for_journal(BusTime now) const;
  /// The path time of the nodes after a bring-up, of those that lie in the run from `start` on.
  PathTime found_tau(const BringUp& bring_up, PathTime start) const {
    return found_tau(bring_up, start, tau_before_);
  }

  // Going on: bring-up, homing and return follow one another.
  void go_on() { going_on_ = true; }
  void do_not_go_on() { going_on_ = false; }
  bool going_on() const { return going_on_; }
  /// Once after the start, when the machine file says so: nobody has commanded it.
  bool begins_by_itself();
  void commanded() { by_itself_ = false; }
  void goes_by_itself() { by_itself_ = true; }
  /// Not by itself: the nodes have lost their positions.
  bool must_ask_to_home() const;

  /// Nobody knows where the filament stands.
  void lose_filament() { filament_lost_ = true; }
  /// The job itself is wrong: it cannot go on.
  void fail_job() { job_failed_ = true; }
  bool take_job_failed() { return std::exchange(job_failed_, false); }

  /// Moves that lead from `from` (Frame::kMachine) to where the job goes on.
  Result<std::vector<canonical::Line>, Refusal> way_back(const PlannedPose& place, const Pose& from,
                                                         const Position& position) const;
  /// The tool is back at `place`. How far the filament stands from where the job believes it, mm, when that
  /// is right so; 0: it goes on as planned.
  double finish_return(const PlannedPose& place, const std::optional<Pose>& here);
  void job_begins() { filament_lost_ = false; }

  // Held, and goes on as soon as the spindle turns as it did: in one visit of the state alone.
  void await_spindle(std::uint64_t visit) { spindle_visit_ = visit; }
  bool awaits_spindle(std::uint64_t visit) const { return spindle_visit_ == visit; }

 private:
  static PathTime found_tau(const BringUp& bring_up, PathTime start, PathTime otherwise);
  void add_approach(std::vector<canonical::Line>& commands, const Pose& from, Pose target) const;

  const MachineDescription& machine_;
  const Kinematics& kinematics_;
  journal::Queue& journal_;
  std::optional<Left> left_;
  std::optional<BusTime> found_noted_;
  PathTime tau_before_{0};
  bool going_on_ = false;
  bool by_itself_ = false;     ///< nobody has commanded it
  bool asked_itself_ = false;  ///< once is enough
  bool filament_lost_ = false;
  bool job_failed_ = false;
  std::optional<std::uint64_t> spindle_visit_;
};

}  // namespace kinebus
