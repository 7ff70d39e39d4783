#pragma once
// From a bus that nothing is known of to drives that hold and follow: identity, parameters, clocks, path
// time, CiA 402 enable. All nodes at once, each at its own pace; the next step begins when every node is
// through the last.

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "gateway/bus_nodes/node_configuration.hpp"
#include "gateway/bus_nodes/node_link.hpp"
#include "gateway/description/machine_description.hpp"
#include "gateway/sentence.hpp"
#include "gateway/status/alarm.hpp"
#include "gateway/stream/path_rate.hpp"
#include "protocol/motion/segment.hpp"

namespace kinebus {

/// What went wrong in bring-up or homing.
struct StepFailure {
  AlarmCode code{};
  std::uint8_t node = 0;
  Sentence words;
};

class BringUp {
 public:
  enum class Outcome : std::uint8_t { kBusy, kDone, kFailed };

  BringUp(const MachineDescription& machine, std::deque<NodeLink>& links, PathRate& rate);

  /// `alone`: this gateway speaks on the bus already, so there is no other to listen for. `key`: tells nodes
  /// with axes or heaters the session's key; empty: there is none.
  void start(BusTime now, bool alone, const std::vector<ParameterWrite>& key = {});
  Outcome on_time(BusTime now);
  /// Ends it: drives stay as they are.
  void abort();
  /// A frame that only another gateway sends was heard.
  void on_foreign_gateway() { foreign_ = true; }

  /// NMT command frames to send; pulled by the owner.
  std::optional<CanFrame> next_frame();
  /// From the listening pause on, SYNC and heartbeat may be sent.
  bool may_speak() const { return stage_ != Stage::kListen; }
  const StepFailure& failure() const { return failure_; }
  Sentence doing() const;
  /// Where the nodes' path time stood, before it was made equal; empty: not read yet.
  const std::vector<PathTime>& found_path_times() const { return found_; }
  bool busy() const { return stage_ != Stage::kIdle; }
  /// Of the nodes with axes, one that does not follow smooth ramps of path time; only asked of machines with
  /// limits of jerk. Empty: all do.
  std::optional<std::uint8_t> node_without_smooth_ramps() const { return without_smooth_; }

 private:
  enum class Stage : std::uint8_t {
    kIdle,
    kListen,
    kIdentify,
    kConfigure,
    kOperational,
    kSynchronise,
    kPathTime,
    kLatch,
    kEnable,
    kEnd
  };
  enum class Config : std::uint8_t {
    kCheck,
    kWriting,
    kVerify,
    kStoring,
    kSettling,
    kRestoring,
    kRestarting,
    kSettings,
    kDone
  };
  struct Node {
    NodeConfiguration configuration;
    Config config = Config::kCheck;
    int attempts = 0;
    bool done = false;       ///< with the present stage
    bool requested = false;  ///< SDO requests of the stage are under way
    bool rewritten = false;
    bool differs = false;  ///< a setting is not the machine file's
    std::size_t compared = 0;
    std::array<std::uint32_t, 4> identity{};
    std::int64_t path_ticks = 0;
    std::array<bool, kAxesPerNode> used{};
    BusTime asked{0}, stored{0};
  };

  void enter(Stage stage, BusTime now);
  bool all_done() const;
  void fail(AlarmCode code, std::uint8_t node, Sentence words);
  void step(BusTime now, std::size_t i);
  void identify(BusTime now, NodeLink& link, Node& node);
  void note_functions(const NodeLink& link, Node& node, const SdoResult& answer);
  void wake(BusTime now, NodeLink& link, Node& node);
  void configure(BusTime now, NodeLink& link, Node& node);
  void settle(BusTime now, NodeLink& link, Node& node);
  void parameters_are_right(Node& node);
  void compare(NodeLink& link, Node& node);
  void check_load_sensor(const NodeLink& link, const SdoResult& answer);
  void check_fingerprint(NodeLink& link, Node& node, std::uint32_t fingerprint);
  void operational(BusTime now, NodeLink& link, Node& node);
  void synchronise(BusTime now, NodeLink& link, Node& node);
  void path_time(NodeLink& link, Node& node);
  void latch(BusTime now, NodeLink& link, Node& node);
  void enable(BusTime now, NodeLink& link, Node& node);
  /// The next SDO result; reports aborts and silence.
  std::optional<SdoResult> result(NodeLink& link, AlarmCode code);

  const MachineDescription& machine_;
  std::deque<NodeLink>& links_;
  PathRate& rate_;
  std::vector<Node> nodes_;
  std::deque<CanFrame> out_;
  std::vector<PathTime> found_;
  Stage stage_ = Stage::kIdle;
  BusTime entered_{0};
  bool foreign_ = false, failed_ = false, equalising_ = false;
  std::optional<std::uint8_t> without_smooth_;
  StepFailure failure_;
};

}  // namespace kinebus
