#pragma once
// The job as a whole: its name and text, its check before anything moves, and the runner that carries it out.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "gateway/description/machine_description.hpp"
#include "gateway/jobs/hashed_source.hpp"
#include "gateway/jobs/journal/journal_state.hpp"
#include "gateway/jobs/preflight.hpp"
#include "gateway/kinematics/kinematics.hpp"
#include "gateway/run/runner.hpp"
#include "gateway/status/event_queue.hpp"

namespace kinebus {

class PrintJob {
 public:
  PrintJob(const MachineDescription& machine, const Kinematics& kinematics, StreamGroup& group,
           PathRate& rate, Heat& heat, EventQueue& events, journal::Queue& journal,
           bodies::PrintedPart* printed)
      : machine_(machine),
        kinematics_(kinematics),
        events_(events),
        runner_(machine, kinematics, group, rate, heat, events, journal, printed) {}

  Runner& runner() { return runner_; }
  const Runner& runner() const { return runner_; }
  /// Empty: none.
  const std::string& name() const { return name_; }
  void rename(std::string name) { name_ = std::move(name); }
  void forget_name() { name_.clear(); }

  // The check.
  /// Of a text at its beginning, which begins in `offsets`. `hotends`: their targets, as far as they are
  /// known.
  void begin_check(std::unique_ptr<ByteSource> source, const HotendTargets& hotends,
                   const gcode::WorkOffsets& offsets);
  /// Worth about `budget` lines; what is found is told. True: done, errors() counts.
  bool check(BusTime now, int budget);
  void abort_check() { preflight_.reset(); }
  std::uint64_t errors() const { return errors_; }
  /// The text, for another reading of it.
  bool rewind() { return source_->rewind(); }
  bool is_the_text_of(const journal::JobBegin& begun) const;
  /// Gives the text back; nullptr: none is there.
  std::unique_ptr<ByteSource> take_source() { return std::move(source_); }
  void drop_source() { source_.reset(); }
  /// As the check found it; empty of lines that come from outside.
  const JobReport& report() const { return report_; }
  void forget_report() { report_ = {}; }

  // Its time, from its beginning on, with the interruptions in which a gateway ran.
  void begin_clock(BusTime now, double elapsed_s = 0) {
    clock_from_ = now;
    elapsed_before_s_ = elapsed_s;
  }
  /// It stands until begin_clock.
  void stop_clock_at(double elapsed_s) {
    clock_from_.reset();
    elapsed_before_s_ = elapsed_s;
  }
  double elapsed_s(BusTime now) const {
    return elapsed_before_s_ + (clock_from_ ? to_seconds(now - *clock_from_) : 0);
  }
  bool clock_runs() const { return clock_from_.has_value(); }

  // The run.
  /// What the journal has to know when it begins at `start`, Frame::kMachine.
  journal::JobBegin record(const Pose& start) const;
  void start(const Pose& start) {
    noted_top_mm_.reset();
    filament_from_mm_ = start[kE];
    runner_.start_job(std::move(source_), start, offsets_);
  }
  /// Of a gateway before: its text, which was checked, is read up to its place.
  void replay(const journal::State& state, PathTime tau) {
    filament_from_mm_ = state.job->start[kE];
    runner_.start_replay(std::move(source_), state, tau);
  }
  /// What it has fed so far, mm, less what it has drawn back. `motor_mm`: E of the motor.
  double filament_mm(double motor_mm) const {
    const double here_mm = runner_.suspended() ? runner_.rest_pose().pose[kE] : motor_mm;
    return here_mm - runner_.extruder_shift_mm() - filament_from_mm_;
  }
  /// Now and then in motion (`moving`: path time runs) its place is noted.
  bool progress_is_due(BusTime now, bool moving);
  /// The part is higher than was noted, by as much as it is known to; then it counts as noted.
  bool growth_is_due(double top_mm);

 private:
  void tell_problems(BusTime now);

  const MachineDescription& machine_;
  const Kinematics& kinematics_;
  EventQueue& events_;
  Runner runner_;
  std::string name_;
  std::unique_ptr<HashedSource> source_;
  std::unique_ptr<Preflight> preflight_;
  std::size_t told_ = 0;      ///< problems
  std::uint64_t errors_ = 0;  ///< of the last check
  JobReport report_;
  gcode::WorkOffsets offsets_{};
  std::uint64_t bytes_ = 0, hash_ = 0;  ///< of the text that was checked
  BusTime progress_due_{0};
  std::optional<double> noted_top_mm_;  ///< none: nothing was noted of this job
  std::optional<BusTime> clock_from_;
  double elapsed_before_s_ = 0;
  double filament_from_mm_ = 0;
};

}  // namespace kinebus
