#pragma once
// Homing of all joints that have a switch, stage after stage of the plan (gateway/homing/plan.hpp), those of
// a stage together.
//
// The method: every node homes its own axes (CiA 402 mode 6: fast to the switch, off it, slowly over the
// edge), all started within one frame time of each other and with equal speeds, so that the platform of a
// parallel machine first moves as one towards the switches; each carriage stops at its own. A coordinated
// approach in streamed mode would not be safer: positions are unknown, so nothing about the mechanism's pose
// could be computed, and each carriage has to go its own last way to its own switch in either case. What
// makes it safe is watched here: the carriages' travels since the start may differ by
// HomingRun::max_spread_mm at most, every carriage must come to its switch within its search travel (the
// node) and within the time (here), and whatever goes wrong with one stops them all at once: halt in the
// controlwords of all nodes, two frames one behind the other. A carriage that has come to its switch stands
// there until all have; then the nodes let theirs leave, one node after the other. So a switch whose wire
// goes to another carriage is found out: it does not go off when the carriage leaves, or goes off when
// another one does.
//
// Carriages that go at different speeds begin with the plan's lift where it has one: their nodes are lent its
// speeds (6099h:1) before the start, and at the first switch all halt, get their own back and start again.

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "gateway/bus_nodes/bring_up.hpp"
#include "gateway/bus_nodes/node_link.hpp"
#include "gateway/description/machine_description.hpp"
#include "gateway/homing/plan.hpp"
#include "gateway/sentence.hpp"

namespace kinebus {

class MachineHoming {
 public:
  enum class Outcome : std::uint8_t { kBusy, kDone, kFailed };

  MachineHoming(const MachineDescription& machine, const homing::Plan& plan, std::deque<NodeLink>& links);

  void start(BusTime now);
  Outcome on_time(BusTime now);
  /// Stops all carriages and ends homing: an outside reason (stop command, fault).
  void abort();
  /// The carriages of this node move, and have told where they are since `from`.
  bool reports(std::size_t node, BusTime from) const;
  bool busy() const { return stage_ != Stage::kIdle; }
  /// After a node has stopped all before it was seen why, and all rest: what it was, where more is to be said
  /// than that a drive has a fault. Once.
  std::optional<StepFailure> explain();
  const StepFailure& failure() const { return failure_; }

 private:
  enum class Stage : std::uint8_t { kIdle, kReports, kMode, kLift, kHalt, kSpeeds, kMove, kBack, kQuiet };
  struct Axis {
    std::size_t joint = 0;  ///< place in the machine's list
    std::size_t node = 0;   ///< place in the list of links
    std::size_t axis = 0;
    std::string name;
    bool linear = true;
    double counts_per_unit = 1;
    double jump_counts = 0;  ///< a greater step between two reports is a new zero, not a motion
    std::uint8_t order = 1;  ///< the stage of the plan, from 1
    double lift_per_s = 0;   ///< 0: takes no part in a lift
    bool attained = false;
    bool waits = false;  ///< stands on its switch
    double travel_counts = 0;
    std::int32_t last_counts = 0;
    bool started = false;
    BusTime rests_since = kMoves;  ///< though it is to home
    bool lowered = false;          ///< its start, to be raised again
  };
  static constexpr BusTime kMoves = BusTime::max();

  void enter(Stage stage, BusTime now);
  void next_order();
  std::vector<Axis*> group();
  std::vector<std::size_t> group_nodes();
  void set_group(std::uint16_t controlword, std::int8_t mode);
  bool group_in_mode(std::int8_t mode);
  bool group_lifts();
  bool group_rests();
  void lend_speeds(bool own);
  bool in_time(BusTime now);
  Sentence error_words(const Axis& axis, std::uint16_t status) const;
  void repeat_control(BusTime now);
  void set_report_period(std::int64_t ms);
  bool requests_done();
  void watch(BusTime now);
  void watch_spread();
  void start_again(Axis& axis, BusTime now);
  void fail(AlarmCode code, std::uint8_t node, Sentence words);
  void let_leave();

  const MachineDescription& machine_;
  std::deque<NodeLink>& links_;
  std::vector<Axis> axes_;
  std::vector<std::uint32_t> reports_;  ///< position frames seen, by node
  Stage stage_ = Stage::kIdle;
  std::uint8_t order_ = 0;
  BusTime entered_{0}, repeated_{0}, began_{0};
  bool failed_ = false;
  bool unexplained_ = false;
  StepFailure failure_;
};

}  // namespace kinebus
