#include "gateway/machine/recovery.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/jobs/machine_setup.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// The stream may begin so far from where an axis stands; its first segments take it back.
constexpr double kExactCounts = 3;
/// Nearer than this the tool goes back straight; farther away it comes from above, mm.
constexpr double kNear_mm = 0.5;
/// Farther than this the gateway does not go back by itself, mm.
constexpr double kByItself_mm = 0.1;
/// Filament that stands elsewhere by more than this was moved on purpose, mm.
constexpr double kFilament_mm = 0.5;
/// Back on the path from next to it, mm/s.
constexpr double kReturnSpeed = 5;
constexpr double kPrimeSpeed = 3;
/// Path time stands there before a run is let go.
constexpr PathTime kBeforeStart = 3ms;
constexpr BusTime kJournalPatience = 500ms;

double distance_mm(const Pose& a, const Pose& b) {
  return std::hypot(a[kX] - b[kX], a[kY] - b[kY], a[kZ] - b[kZ]);
}

}  // namespace

void Recovery::take_up(journal::State state, std::unique_ptr<ByteSource> job) {
  left_ = Left{std::move(state), std::move(job)};
}

PathTime Recovery::left_tau() const {
  const journal::State& state = left_->state;
  return state.found.value_or(state.run ? state.run->start : PathTime{});
}

void Recovery::note_found(BusTime now, const BringUp& bring_up) {
  if (!left_ || !left_->state.run || left_->state.found || bring_up.found_path_times().empty()) return;
  const journal::State& state = left_->state;
  const PathTime tau =
      found_tau(bring_up, state.run->start, state.progress ? state.progress->tau : state.run->start);
  left_->state.found = tau;
  journal_.push(journal::Found{tau});
  found_noted_ = now;
}

bool Recovery::waits_for_journal(BusTime now) const {
  return found_noted_ && !journal_.all_stored() && now - *found_noted_ < kJournalPatience;
}

PathTime Recovery::found_tau(const BringUp& bring_up, PathTime start, PathTime otherwise) {
  std::optional<PathTime> least;
  for (const PathTime tau : bring_up.found_path_times())
    if (tau >= start - kBeforeStart && (!least || tau < *least)) least = tau;
  return least.value_or(otherwise);
}

bool Recovery::begins_by_itself() {
  if (!left_ || std::exchange(asked_itself_, true)) return false;
  by_itself_ = machine_.resume.after_restart == ResumeDescription::Then::kGoOn;
  return by_itself_;
}

bool Recovery::must_ask_to_home() const {
  return by_itself_ && machine_.resume.after_power_loss == ResumeDescription::Then::kAsk;
}

/// From far away the tool goes up, over its place, and down; from next to it, straight.
void Recovery::add_approach(std::vector<canonical::Line>& commands, const Pose& from, Pose target) const {
  constexpr auto kFrame = Frame::kMachine;
  const bool turned = std::abs(target[kA] - from[kA]) > 0.01 || std::abs(target[kC] - from[kC]) > 0.01;
  const auto reachable = [&](const Pose& pose) { return static_cast<bool>(kinematics_.check(kFrame, pose)); };
  if (distance_mm(target, from) > kNear_mm || turned) {
    const double e_mm = std::exchange(target[kE], from[kE]);
    Pose above = target;
    above[kZ] += machine_.resume.lift_mm;
    if (!reachable(above)) above = target;
    Pose up = from;
    up[kZ] = std::max(from[kZ], above[kZ]);
    if (up[kZ] > from[kZ] && reachable(up)) commands.push_back({0, canonical::Traverse{up, kFrame}});
    Pose over = above;
    over[kZ] = std::max(up[kZ], above[kZ]);
    if (reachable(over)) commands.push_back({0, canonical::Traverse{over, kFrame}});
    commands.push_back({0, canonical::Traverse{above, kFrame}});
    commands.push_back(
        {0, canonical::Feed{
                .target = target, .frame = kFrame, .feed_per_s = machine_.resume.approach_mm_per_s}});
    target[kE] = e_mm;
    if (target[kE] == from[kE]) return;
  }
  commands.push_back({0, canonical::Feed{.target = target, .frame = kFrame, .feed_per_s = kReturnSpeed}});
}

Result<std::vector<canonical::Line>, Refusal> Recovery::way_back(const PlannedPose& place, const Pose& from,
                                                                 const Position& position) const {
  JointVector wanted{};
  if (const auto found = kinematics_.inverse(place.frame, place.pose, wanted); !found)
    return refused(say("the job's place cannot be reached: %1", to_string(found.error())));
  const auto machine_place = convert_pose(kinematics_, place.frame, place.pose, Frame::kMachine);
  if (!machine_place)
    return refused(say("the job's place cannot be reached: %1", to_string(machine_place.error())));

  Pose target = *machine_place;
  const Position::Distance distance = position.distance_to(wanted, place);
  const bool filament_elsewhere = filament_lost_ || std::abs(target[kE] - from[kE]) > kFilament_mm;
  if (filament_elsewhere) target[kE] = from[kE];
  const double away_mm = distance_mm(target, from);
  if (by_itself_ && position.homed() && away_mm > kByItself_mm && !filament_lost_)
    return refused(
        say("the tool was found %1 mm from its place: resume brings it back", printed("%.3f", away_mm)));

  std::vector<canonical::Line> commands;
  const bool exact =
      distance.others <= kExactCounts && (filament_elsewhere || distance.filament <= kExactCounts);
  if (!exact) add_approach(commands, from, target);
  if (filament_lost_ && machine_.resume.prime_mm > 0) {
    target[kE] += machine_.resume.prime_mm;
    commands.push_back(
        {0, canonical::Feed{.target = target, .frame = Frame::kMachine, .feed_per_s = kPrimeSpeed}});
  }
  return commands;
}

double Recovery::finish_return(const PlannedPose& place, const std::optional<Pose>& here) {
  going_on_ = false;
  const double elsewhere_mm = here ? (*here)[kE] - place.pose[kE] : 0;
  const bool right_so = std::exchange(filament_lost_, false) || std::abs(elsewhere_mm) > kFilament_mm;
  return right_so ? elsewhere_mm : 0;
}

}  // namespace kinebus
