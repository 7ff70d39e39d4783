#pragma once
// One CAN node with two CiA 402 axes, whole, as a state machine without input or output of its own. A port
// feeds it frames, switch edges and time, and pulls frames, positions and storage images out:
//
//   on_frame / on_switch / on_drive_fault / on_time  ->  Node  ->  next_frame / position / drive / storage
//
// Nothing ticks: position() is evaluated when asked, for any time from the last input on. The node is a
// standard two-axis drive for any CANopen master; with the gateway's SYNC, time stamps and rate broadcasts it
// also streams.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "node_firmware/core/drive_axis.hpp"
#include "node_firmware/core/parameter_image.hpp"
#include "node_firmware/core/path_motion.hpp"
#include "node_firmware/core/reset_report.hpp"
#include "node_firmware/core/scale_correction.hpp"
#include "node_firmware/core/switch_inputs.hpp"
#include "node_firmware/core/touch_probe.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/canopen/emcy.hpp"
#include "protocol/canopen/heartbeat.hpp"
#include "protocol/canopen/lss.hpp"
#include "protocol/canopen/nmt.hpp"
#include "protocol/canopen/node_guard.hpp"
#include "protocol/canopen/object_dictionary.hpp"
#include "protocol/canopen/pdo_engine.hpp"
#include "protocol/canopen/sdo_server.hpp"
#include "protocol/canopen/sync.hpp"
#include "protocol/motion/session_guard.hpp"
#include "protocol/time.hpp"

namespace kinebus {

/// 1018h: who this board is, for LSS and for the gateway's check at bring-up.
struct NodeIdentity {
  std::uint32_t vendor_id = kVendorId;
  std::uint32_t product_code = kProductCode;
  std::uint32_t revision = kRevisionNumber;
  std::uint32_t serial = 0;
};

/// Linear scales that an axis' inputs can take, added together.
enum class ScaleInput : std::uint8_t {
  kNone = 0,
  kQuadrature = 1,
  kAbsolute = 2,
  // They have the pins of its motor's encoder (2150h:6): one or the other.
  kQuadratureOrEncoder = kQuadrature << 2 | kQuadrature,
  kAbsoluteOrEncoder = kAbsolute << 2 | kAbsolute,
};
constexpr ScaleInput operator+(ScaleInput a, ScaleInput b) {
  return static_cast<ScaleInput>(static_cast<int>(a) | static_cast<int>(b));
}

class Node;

struct NodeOptions {
  NodeIdentity identity{};
  std::uint8_t node_id = 0;       ///< 1..127; 0: as stored, and without that the node waits for LSS
  std::uint32_t program_crc = 0;  ///< 1F56h; 0: a program that no boot loader has started
  ResetReport reset{};            ///< 2121h
  /// The board's objects: those of kNodeTable, which this core serves, at the same places, and perhaps more.
  const ObjectTable* table = &kNodeTable;
  /// What scales the board can count at each axis (2160h), and Node::may_fit_scale where there are any:
  /// others have no room for what they never need.
  std::array<ScaleInput, kAxesPerNode> scale_inputs{};
  AbortCode (*may_fit_scale)(const Node& node, int axis, std::uint8_t kind) = nullptr;
  // Of a board with several nodes:
  /// The node has its id from its board, and LSS is another's business.
  bool id_from_board = false;
  std::uint8_t consecutive_ids = 1;  ///< that go with the id that LSS gives
  /// The motors are told what follows from an input only later, after on_time(): a motion of an axis' own
  /// that has to stop brakes from the time given there on. From that of the input it would step back.
  bool stops_on_time = false;
};

/// What the power stage of one axis is to do. The currents are objects of the parameter set.
struct DriveOutput {
  bool power = false;     ///< half-bridges on
  bool holding = false;   ///< hold current is enough: the axis rests
  bool inverted = false;  ///< positive counts turn the motor the other way round: the port's business
};

/// What a port with sensors knows of one axis.
struct DriveFeedback {
  std::int32_t following_error = 0;  ///< counts: command less encoder; 0 without encoder
  std::uint16_t supply_mv = 0;
  std::int16_t temperature_dc = 0;  ///< 0.1 C
  std::int16_t current_ma = 0;      ///< amplitude, measured
  std::uint8_t tune_state = 0;      ///< 0 idle, 1 runs, 2 done, 3 failed
};

/// What a port with stepper drivers that can be asked knows of one (2170h).
struct DriverReport {
  std::uint8_t state = 0;
  std::uint32_t status = 0;
  std::uint16_t stall_guard = 0;
  std::uint16_t found = 0;  ///< 2209, 5160, 2130; 0: none

  static constexpr std::uint8_t kConfigured = 2, kSilent = 4;
  Homing::Load load() const {
    if (state == 0 || state >= kSilent) return Homing::Load::kNone;
    return state == kConfigured ? Homing::Load::kReady : Homing::Load::kBusy;
  }
};

class Node : private ObjectOwner {
 public:
  static constexpr int kSwitchInputs = kinebus::kSwitchInputs;

  /// `clock`: of all nodes behind the same CAN controller; it outlives them.
  /// `stored_image`: what image_to_store() gave once, as the port's memory returns it; empty: nothing stored.
  /// A damaged image leaves the defaults in force and is told by EMCY 5530h.
  Node(const NodeOptions& options, BusClock& clock, LocalTime now,
       std::span<const std::uint8_t> stored_image = {});
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  // In. `now` and `at` never decrease by more than an interrupt's delay (about a millisecond).
  /// `at`: receive time stamp, as close to the end of the frame as the port can tell.
  void on_frame(LocalTime at, const CanFrame& frame);
  /// A raw edge (or the level at power-up) of input 0..6, before polarity and debouncing.
  void on_switch(LocalTime at, int input, bool level);
  /// Hardware fault of a power stage: its power is off from now on. `emcy_code`: for example 2310h
  /// over-current.
  void on_drive_fault(LocalTime at, int axis, std::uint16_t emcy_code);
  /// The cause of that fault has gone: a fault reset works again.
  void on_drive_fault_gone(LocalTime at, int axis);
  /// Something is wrong with an axis that keeps its power (lost steps, supply, heat, encoder): all nodes stop
  /// on the path, and the axis holds. Told once until on_axis_trouble_gone().
  void on_axis_trouble(LocalTime at, int axis, std::uint16_t emcy_code);
  void on_axis_trouble_gone(std::uint16_t emcy_code) { emcy_.clear(emcy_code); }
  /// Told by EMCY, stops nobody: 8110h receive overrun, 8140h back from bus-off.
  void report(std::uint16_t emcy_code) { emcy_.raise(emcy_code); }
  /// The auto-tune of an axis was asked for; once.
  bool take_tune_request(int axis) {
    return std::exchange(tune_requested_[static_cast<std::size_t>(axis & 1)], false);
  }
  /// What an auto-tune found; 1010h keeps it.
  void set_motor(int axis, std::uint32_t resistance_mohm, std::uint32_t inductance_uh,
                 std::int32_t encoder_offset);
  /// What the port measures, for the objects that show it.
  void set_feedback(int axis, const DriveFeedback& feedback) {
    feedback_[static_cast<std::size_t>(axis & 1)] = feedback;
    measures_ = true;
  }
  void set_driver(int axis, const DriverReport& report) {
    drivers_[static_cast<std::size_t>(axis & 1)] = report;
    axes_[static_cast<std::size_t>(axis & 1)].set_load(report.load());
  }
  /// What an axis' linear scale counts now, wrapping around; told before the inputs that it is to be seen
  /// with.
  void set_scale(int axis, std::int32_t counts);
  /// It does not answer, told again and again: until it does nobody knows what it counts, and until the axis
  /// has homed anew, where home is by it. An axis that it leads stops with all others.
  void lose_scale(int axis);
  struct Scale {
    std::uint8_t kind = 0;           ///< 2160h:1
    std::uint32_t counts_per_m = 0;  ///< 0: not told
    static constexpr int kQuadrature = 1, kFewestBits = 8, kMostBits = 30, kGray = 32;
    constexpr bool quadrature() const { return kind == kQuadrature; }
    /// Of an absolute one.
    constexpr unsigned bits() const { return kind % kGray; }
    constexpr bool gray() const { return kind > kGray; }
    constexpr bool absolute() const { return bits() >= kFewestBits && bits() <= kMostBits; }
    friend bool operator==(const Scale&, const Scale&) = default;
  };
  static AbortCode may_fit_scale(const Node& node, int axis, std::uint8_t kind);
  /// The scale of this axis that is to be counted.
  Scale scale(int axis) const;
  bool scale_fitted(int axis) const { return axis_parameter(slot_of_axes(object::kScaleFitted), axis) != 0; }
  /// Frames were lost in the receiver. One of them may have been a hold or a start that all others obey: when
  /// motion is queued or under way, all nodes stop together. As soon as the port knows.
  void on_receive_overrun(LocalTime at, std::uint32_t frames);
  /// Something that only the port sees: transmit queue full, bus-off, watchdog reset.
  void count(NodeCounter counter, std::uint32_t times = 1);
  /// Needed at next_deadline(); allowed at any time.
  void on_time(LocalTime now);
  /// With stops_on_time: motions wait for on_time() to stop.
  bool stop_waits() const { return !stop_served_ && path_.stop_latched(); }

  // Out.
  /// Most urgent first; pull when the bus can take a frame.
  std::optional<CanFrame> next_frame();
  LocalTime next_deadline() const;

  /// What the motor of axis 0 or 1 is driven by: counts (microsteps) with 32 fractional bits, 0 at power-up,
  /// continuous in time whatever happens to the coordinates (homing gives 6064h a new zero, not this).
  /// Calls in order of time are O(1) on average; `at` before the last input gives the position at that input.
  std::int64_t position(LocalTime at, int axis);
  /// What of it leads the axis to where its linear scale has it (2160h:7).
  std::int64_t correction(LocalTime at, int axis) const {
    return scale_corrections_[static_cast<std::size_t>(axis & 1)].at(at);
  }
  /// The same in the coordinates of 6064h and of the stream, without that.
  std::int64_t user_position(LocalTime at, int axis);
  bool moving(LocalTime at) const;
  /// An axis has power: no flash is written then, for that holds up the control of the motors.
  bool powered() const { return axes_[0].powered() || axes_[1].powered(); }
  /// Another node of the same board has power: this one's program does not end then, either.
  void set_neighbours_powered(bool powered) { neighbours_powered_ = powered; }
  DriveOutput drive(int axis) const;
  /// COB-IDs of the receive PDOs that are on, for a port that filters; 0: off.
  std::array<std::uint16_t, kRpdoCount> rpdo_cob_ids() const;
  /// Nodes whose heartbeat is watched (1016h); 0: none.
  std::array<std::uint8_t, 2> watched_nodes() const;
  /// It answers remote frames of node guarding.
  bool answers_guarding() const { return heartbeat_.period().count() == 0; }
  /// A parameter of an axis, by its slot: currents, windows and what else the port's control needs.
  std::int64_t axis_parameter(AxisSlots slots, int axis) const {
    return objects_.value(slots[static_cast<std::size_t>(axis & 1)]);
  }

  /// Path time and its rate (0..2^32) by this node's own clock estimate.
  PathTime path_time(LocalTime at) const { return path_.tau(at); }
  std::uint64_t path_rate_q32(LocalTime at) const { return path_.rate_q32(at); }
  const PathMotion& path() const { return path_; }
  const DriveAxis& axis(int index) const { return axes_[static_cast<std::size_t>(index)]; }

  // Storage: asked for by 1010h, 1011h or LSS, whose answer on the bus waits for on_image_stored().
  /// The image to write, once; empty: nothing to do, or refused because power has come since it was asked
  /// for. Valid until the next call of any member.
  std::span<const std::uint8_t> image_to_store();
  void on_image_stored(bool good);

  /// NMT reset node asked for, after which the port may restart the processor; the node has reset itself
  /// already.
  bool take_reset_request();
  /// 1F51h = 0: the program is to give way to the boot loader when its answer is on the bus. No axis has
  /// power.
  bool program_stop_requested() const { return program_stop_requested_; }
  /// Watchdog: true as long as every timed job has been served within its time. Feed the watchdog only then.
  bool healthy(LocalTime now) const;
  const ResetReport& reset_report() const { return options_.reset; }
  std::uint8_t node_id() const { return node_id_; }
  NmtState nmt_state() const { return nmt_.state(); }

 private:
  enum class Storing : std::uint8_t { kNothing, kWanted, kWriting };

  AbortCode read(const ObjectEntry& entry, std::int64_t& value) override;
  AbortCode write(const ObjectEntry& entry, std::int64_t value) override;
  AbortCode check(const ObjectEntry& entry, std::int64_t value) const override;
  bool read_node_object(ObjectAddress address, std::int64_t& value);
  bool read_axis_object(const DriveAxis& axis, ObjectAddress base, std::int64_t& value);
  /// In the direction of 2160h:3.
  ScaleCounts directed_scales() const;
  std::int64_t told_current(const DriveAxis& axis) const;
  bool follows_badly(const DriveAxis& axis) const;
  AbortCode write_node_object(const ObjectEntry& entry, std::int64_t value);
  AbortCode write_axis_object(const ObjectEntry& entry, std::int64_t value);
  AbortCode command_storage(ObjectAddress address, std::int64_t value);
  std::int64_t counter_value(NodeCounter counter) const;

  void boot();
  void reset_communication();
  void apply_parameters();
  void apply_node_id();
  void on_nmt(NmtCommand command);
  bool parts_from_others(const CanFrame& frame) const;
  /// false: the session's check value is missing, or it is a voucher itself.
  bool obeys(const CanFrame& frame);
  void on_sync(const SyncReception& sync);
  void on_lss();
  void serve();
  void serve_switches();
  void serve_stops();
  void serve_emergencies();
  void serve_lost_masters();
  void serve_stream_status();
  void serve_clearing();
  void serve_scales();
  void follow_scale(int axis);
  void serve_pdo_problems();
  void watch_levels();
  bool clear_allowed() const;
  bool in_motion() const;
  void end_stop();
  void refuse_storing();
  bool board_powered() const { return powered() || neighbours_powered_; }
  void tell_reset();

  NodeOptions options_;
  LocalTime now_;
  std::uint8_t node_id_ = 0;
  ParameterImage image_;
  NodeDictionary objects_;

  PathMotion path_;
  SwitchInputs inputs_;
  std::array<DriveAxis, kAxesPerNode> axes_;

  NmtSlave nmt_;
  HeartbeatProducer heartbeat_;
  HeartbeatConsumer watched_;
  NodeGuard guard_;
  EmcyProducer emcy_;
  SdoServer sdo_;
  PdoEngine pdo_;
  LssSlave lss_;
  SessionGuard session_;

  friend class NodePreview;
  std::array<DriveFeedback, kAxesPerNode> feedback_{};
  std::array<DriverReport, kAxesPerNode> drivers_{};
  ScaleCounts scale_counts_{};
  std::array<bool, kAxesPerNode> scale_lost_{};
  std::array<ScaleCorrection, kAxesPerNode> scale_corrections_{};
  std::array<std::optional<std::int32_t>, kAxesPerNode> corrected_from_{};  ///< the scale at home
  LocalTime scale_look_ = LocalTime::max();
  std::array<TouchProbe, kAxesPerNode> probes_{};
  bool measures_ = false;  ///< the port has sensors
  std::array<bool, kAxesPerNode> tune_requested_{};
  std::optional<CanFrame> boot_up_;
  std::array<std::uint32_t, static_cast<std::size_t>(NodeCounter::kLast) + 1> counters_{};
  Storing storing_ = Storing::kNothing;
  bool storing_for_lss_ = false;
  bool parameters_changed_ = false;
  bool neighbours_powered_ = false;
  bool reset_requested_ = false;
  bool program_stop_requested_ = false;
  bool clearing_ = false;  ///< 60C4h:6 was written, and axes creep to a whole count: the answer waits
  bool stop_known_ = false, stop_served_ = false;
  bool may_brake_ = false;  ///< the time is one at which motors are told
  bool emergency_stop_ = false;
  std::array<bool, 4> limit_active_{};
  std::uint8_t told_flags_ = 0, told_sequence_ = 0;
  std::uint32_t told_consumed_ = 0;
  LocalTime status_look_ = LocalTime::max();
  LocalTime status_told_at_{0};
  std::array<std::int64_t, 2> watched_entries_{};
};

/// A base, so that it is there before the node that uses it.
struct OwnBusClock {
  BusClock own_clock;
};
/// The only node behind its CAN controller.
class LoneNode final : private OwnBusClock, public Node {
 public:
  explicit LoneNode(const NodeOptions& options, LocalTime now,
                    std::span<const std::uint8_t> stored_image = {})
      : Node(options, own_clock, now, stored_image) {}
};

/// Looks ahead of a node without changing it: where the motors will be if nothing more comes. Valid until the
/// node's next input.
class NodePreview {
 public:
  /// `axes`: of interest; where the others will be is not told.
  explicit NodePreview(const Node& node, std::size_t axes = kAxesPerNode)
      : node_(node), stream_(node.path_.stream()), axes_(axes) {}
  /// In order of time, from the node's last input on. As Node::position().
  LatchedPositions positions(LocalTime at);

 private:
  const Node& node_;
  SegmentStream::Preview stream_;
  std::size_t axes_;
};

}  // namespace kinebus
