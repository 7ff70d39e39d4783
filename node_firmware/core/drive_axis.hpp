#pragma once
// One CiA 402 axis: power state machine, mode of operation, and which of its motions is the one that counts:
// the trapezoid (profile position, homing, stops), the line from SYNC to SYNC, or the stream of the node.
// Whatever changes, the position goes on from where it is.

#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "node_firmware/core/homing.hpp"
#include "node_firmware/core/linear_interpolator.hpp"
#include "node_firmware/core/path_motion.hpp"
#include "node_firmware/core/profile_position.hpp"
#include "node_firmware/core/switch_inputs.hpp"
#include "protocol/canopen/cia402.hpp"
#include "protocol/canopen/object_dictionary.hpp"

namespace kinebus {

class DriveAxis {
 public:
  DriveAxis(int axis, ObjectDictionary& objects, PathMotion& path, const SwitchInputs& inputs);

  void on_initialised();
  /// NMT reset node: power off, no mode, position unknown; the motor's position goes on.
  void on_reset(LocalTime now);
  void on_controlword(LocalTime now, std::uint16_t word);
  void on_mode(LocalTime now, int mode);
  void on_sync(LocalTime now);
  void on_switch(LocalTime now, const SwitchEvent& event);
  /// `power_lost`: the power stage is off already.
  void on_fault(LocalTime now, std::uint16_t code, bool power_lost);
  void set_fault_present(bool present) { power_.set_fault_present(present); }
  /// The instant of a stop of all nodes has come: own motions brake too.
  void on_path_stop(LocalTime now);
  /// NMT has taken the axis from its master: what 6007h says of a motion of its own.
  void on_connection_lost(LocalTime now);
  /// The stream's queue was dropped in motion: creeps to the nearest whole count.
  void on_stream_cleared(LocalTime now);
  bool creeping(LocalTime at) const { return creeps_ && source_ == Source::kProfile && moving(at); }
  /// Whatever has become due; call after every other input too.
  void on_time(LocalTime now);
  LocalTime next_deadline() const;

  /// In the coordinates of the objects; 32 fractional bits. The path must have been advanced to `at`.
  std::int64_t position(LocalTime at) const;
  /// Where it will be if nothing more comes; `at`: from the last input on, the preview advanced to it.
  std::int64_t position_ahead(LocalTime at, const SegmentStream::Preview& stream) const;
  std::int64_t origin() const { return origin_; }  ///< coordinates of the objects, less those of the motor
  std::int32_t velocity(LocalTime at) const;       ///< counts/s
  bool moving(LocalTime at) const;
  bool powered() const { return power_.powered(); }

  std::uint16_t statusword(LocalTime now) const;
  int mode_display() const { return static_cast<int>(mode_); }
  std::uint16_t error_code() const { return error_code_; }
  std::uint16_t controlword() const { return word_; }
  cia402::State state() const { return power_.state(); }
  bool position_known() const { return position_known_; }
  /// Position at the last home edge, in the coordinates of before, or at the last probe edge.
  std::int64_t home_latch() const { return home_latch_; }
  void set_probe(std::int64_t latched) { home_latch_ = latched; }
  /// What the axis' linear scale counted at the edge that gave the position; none: no switch did.
  std::optional<std::int32_t> scale_at_home() const {
    return position_known_ ? scale_at_home_ : std::nullopt;
  }
  /// The scale counts otherwise from now on.
  void forget_scale() { scale_at_edge_.reset(), scale_at_home_.reset(); }
  /// The other axis of the node, with which this one takes turns in homing.
  void set_neighbour(const DriveAxis& other) { neighbour_ = &other; }
  HomingError homing_error() const { return homing_.error(); }
  /// What the axis' driver tells of the motor's load.
  void set_load(Homing::Load load) { load_ = load; }
  std::uint32_t homing_errors() const { return homing_errors_; }
  /// A homing that runs uses this switch: it is no limit then.
  bool homes_with(SwitchFunction function) const;

  /// Set once when an error of this axis asks for an EMCY; 0: none.
  std::uint16_t take_emergency();
  /// Set-points have stopped all; once, when that stop is over.
  bool take_left_behind() { return std::exchange(left_behind_, false); }
  /// The code of a fault that has been reset, once; 0: none.
  std::uint16_t take_cleared_fault();

 private:
  using Mode = cia402::Mode;
  enum class Source : std::uint8_t { kProfile, kLine, kStream };

  ProfileState state_at(ProfileTicks t) const;
  std::int64_t parameter(AxisSlots slots) const { return objects_.value(slots[index_]); }
  std::uint32_t unsigned_parameter(AxisSlots slots) const {
    return static_cast<std::uint32_t>(parameter(slots));
  }
  cia402::StopOptions stop_options() const;
  ProfileLimits profile_limits(std::uint32_t fastest) const;
  ProfilePosition::SetPoint next_set_point(std::uint16_t word);
  std::int64_t within_limits(std::int64_t target);
  HomingConfig homing_config() const;
  SwitchFunction homing_function() const;

  void to_profile(ProfileTicks t);
  void end_motion(LocalTime now);
  void brake(ProfileTicks t, std::uint32_t deceleration);
  void serve_power(LocalTime now);
  void serve_stop(LocalTime now);
  void serve_mode(LocalTime now);
  void serve_motion(LocalTime now);
  void serve_homing(LocalTime now);
  void enter_mode(LocalTime now, Mode mode);
  void begin_stream(LocalTime now);
  void serve_velocity(LocalTime now);
  void follow(LocalTime now, std::int64_t behind);
  void start_or_end_homing(LocalTime now, bool start);
  bool blocked() const { return path_.stop_latched(); }

  std::size_t index_;
  ObjectDictionary& objects_;
  PathMotion& path_;
  const SwitchInputs& inputs_;

  cia402::PowerStateMachine power_;
  Mode mode_ = Mode::kNone;
  Mode wanted_mode_ = Mode::kNone;
  Source source_ = Source::kProfile;  ///< a line only in modes 7 and 8, the stream only in mode 7
  Trapezoid profile_;
  LinearInterpolator line_{profile_};  // which plans with it while it is the source
  ProfilePosition profile_position_;
  std::optional<ProfilePosition::SetPoint> runs_;  ///< mode 3: to where, if nobody stops it, and how fast
  bool homing_turn() const {
    return (word_ & cia402::control::kHomingStay) == 0 &&
           (neighbour_ == nullptr || !neighbour_->homing_.leaving());
  }

  Homing homing_;
  Homing::Load load_ = Homing::Load::kNone;
  void tell_homing();
  const DriveAxis* neighbour_ = nullptr;
  std::uint16_t word_ = 0;
  cia402::Stop serving_ = cia402::Stop::kNone;
  bool was_enabled_ = false;
  bool halted_ = false;
  bool position_known_ = false;
  LocalTime behind_since_ =
      LocalTime::max();  // set-points of SYNC are farther than the following error window
  bool left_behind_ = false;
  bool creeps_ = false;   // after the stream was dropped; the flag outlives that motion's end
  bool leaving_ = false;  // brakes for a change of mode
  ProfileTicks served_until_ = std::numeric_limits<ProfileTicks>::min();
  bool limited_ = false;  // a target was cut to a limit
  std::int64_t origin_ = 0;
  std::int64_t home_latch_ = 0;
  std::optional<std::int32_t> scale_at_edge_, scale_at_home_;
  std::uint16_t error_code_ = 0;
  std::uint16_t emergency_ = 0;
  std::uint16_t cleared_fault_ = 0;
  std::uint32_t homing_errors_ = 0;
};

}  // namespace kinebus
