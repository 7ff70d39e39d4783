#pragma once
// Moves by hand, jog and bed reference, and the machine's own ways: to where a job begins, and back to an
// interrupted job's place.

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/gcode/canonical.hpp"
#include "gateway/jobs/way_rules.hpp"
#include "gateway/kinematics/kinematics.hpp"
#include "gateway/machine/commands.hpp"
#include "gateway/result.hpp"
#include "gateway/run/heat.hpp"
#include "gateway/run/runner.hpp"
#include "gateway/status/refusal.hpp"

namespace kinebus {

class ManualMotion {
 public:
  /// What comes when the move is done.
  enum class Then : std::uint8_t { kNothing, kJob, kReturn, kHeld };

  ManualMotion(const MachineDescription& machine, const Kinematics& kinematics, StreamGroup& group,
               PathRate& rate, Heat& heat, EventQueue& events, journal::Queue& journal,
               const bodies::PrintedPart* printed)
      : kinematics_(kinematics),
        way_(machine, kinematics, printed),
        runner_(machine, kinematics, group, rate, heat, events, journal) {}

  Runner& runner() { return runner_; }
  const Runner& runner() const { return runner_; }

  /// The move that is asked for, whose whole way lies within the workspace; `from`: Frame::kMachine.
  Result<canonical::Feed, Refusal> jog(const command::Jog& asked, const Pose& from, const Heat& heat);

  // Jogs while one is under way.
  enum class Jogs : std::uint8_t { kNone, kBySteps, kWhileHeld };
  void begin_jog(BusTime now, const command::Jog& asked, const canonical::Feed& move, const Pose& from);
  Jogs jogs() const { return jogs_; }
  /// A further one, from where the last one is going to end.
  Result<void, Refusal> add_jog(const command::Jog& asked, const Heat& heat);
  /// The next of those that wait.
  std::optional<canonical::Feed> take_jog();
  /// The jog under way is still wanted. False: it goes another way than this one.
  bool hold_on(BusTime now, const command::Jog& asked);
  /// Nobody has said for too long that it is still wanted.
  bool let_go(BusTime now) const { return jogs_ == Jogs::kWhileHeld && now > wanted_until_; }
  /// The move under way is none, or none any more, that others may follow.
  void end_jogs();
  /// To the bed reference, the filament as it is.
  canonical::Command reference(const Pose& from) const;
  /// Which two bodies would meet on the straight way there; nullopt: none. Bodies that are near at its
  /// beginning may be.
  std::optional<Sentence> in_the_way_to_reference(const Pose& from);
  /// The same of moves one after the other, Frame::kMachine. What is near where a feed ends may be near on
  /// it: the job stood there, and its print is known a little ahead of the tool.
  std::optional<Sentence> in_the_way(const Pose& from, const std::vector<canonical::Line>& moves);
  /// The last answer, and if it was about what has been printed, how that is forgotten.
  Sentence with_way_out(Sentence words) const;

  /// Straight up to `z_mm` of the machine, or as far as every pose on the way is allowed: `kept_from` says
  /// why no farther. nullopt: there is no way up, or none is needed.
  std::optional<canonical::Command> lift(const Pose& from, double z_mm, std::optional<Sentence>& kept_from);

  void start(std::vector<canonical::Line> commands, const Pose& from, double override_ratio, Then then);
  /// Of the move that is done, once.
  Then take_then() { return std::exchange(then_, Then::kNothing); }
  bool leads_to(Then then) const { return then_ == then; }
  /// The move may be gone on with, but leads nowhere any more.
  void forget_then() { then_ = Then::kNothing; }

 private:
  /// `leaving`: of what is near at the beginning, until it is not.
  std::optional<Sentence> in_the_way(const Pose& from, const Pose& to, bool& leaving);

  const Kinematics& kinematics_;
  WayRules way_;
  Runner runner_;
  Then then_ = Then::kNothing;
  Jogs jogs_ = Jogs::kNone;
  std::deque<canonical::Feed> waiting_;
  Pose last_begin_{}, last_end_{};  ///< of the last one that waits, or of the one under way
  Pose direction_{};                ///< of the one that is held
  BusTime wanted_until_{0};
};

}  // namespace kinebus
