#pragma once
// One CAN node with two CiA 402 axes, whole, as a state machine without input or output of its own. A port
// feeds it frames, switch edges and time, and pulls frames, positions and storage images out:
//
//   on_frame / on_switch / on_drive_fault / on_time  ->  Node  ->  next_frame / position / drive / storage
//
// Nothing ticks: position() is evaluated when asked, for any time from the last input on. The node is a
// standard two-axis drive for any CANopen master; with the gateway's SYNC, time stamps and rate broadcasts it
// also streams.

#include <cstdint>
#include <optional>
#include <span>

#include "protocol/can/frame.hpp"
#include "protocol/time.hpp"

namespace kinebus {

/// 1018h: who this board is, for LSS and for the gateway's check at bring-up.
struct NodeIdentity {
  std::uint32_t vendor_id = 0;
  std::uint32_t product_code = 0;
  std::uint32_t revision = 0;
  std::uint32_t serial = 0;
};

struct NodeOptions {
  NodeIdentity identity;
  std::uint8_t node_id = 0;  ///< 1..127; 0: as stored, and without that the node waits for LSS
};

/// What the power stage of one axis is to do. The currents are objects of the parameter set.
struct DriveOutput {
  bool power = false;    ///< half-bridges on
  bool holding = false;  ///< hold current is enough: the axis rests
};

class Node {
 public:
  static constexpr int kSwitchInputs = 7;

  /// `stored_image`: what store_image() gave once, as the port's memory returns it; empty: nothing stored. A
  /// damaged image leaves the defaults in force and is told by EMCY 5530h.
  Node(const NodeOptions& options, LocalTime now, std::span<const std::uint8_t> stored_image = {});

  // In. `now` and `at` never decrease by more than an interrupt's delay (about a millisecond).
  /// `at`: receive time stamp, as close to the end of the frame as the port can tell.
  void on_frame(LocalTime at, const CanFrame& frame);
  /// A raw edge (or the level at power-up) of input 0..6, before polarity and debouncing.
  void on_switch(LocalTime at, int input, bool level);
  /// Hardware fault of a power stage: its power is off from now on. `emcy_code`: for example 2310h
  /// over-current.
  void on_drive_fault(LocalTime at, int axis, std::uint16_t emcy_code);
  /// Needed at next_deadline(); allowed at any time.
  void on_time(LocalTime now);

  // Out.
  /// Most urgent first; pull when the bus can take a frame.
  std::optional<CanFrame> next_frame();
  LocalTime next_deadline() const;

  /// Commanded position of axis 0 or 1: counts (microsteps) with 32 fractional bits, continuous in time.
  /// Calls in order of time are O(1) on average; `at` before the last input gives the position at that input.
  std::int64_t position(LocalTime at, int axis);
  DriveOutput drive(int axis) const;

  /// Path time and its rate (0..1 in 2^-32) by this node's own clock estimate.
  PathTime path_time(LocalTime at);
  std::uint32_t path_rate_q32(LocalTime at);

  // Storage: set when 1010h, 1011h or LSS asked for it. The answer on the bus waits for on_image_stored().
  /// The image to write, once; empty: nothing to do. Valid until the next call of any member.
  std::span<const std::uint8_t> image_to_store();
  void on_image_stored(bool good);

  /// NMT reset node asked for, after which the port may restart the processor; the node has reset itself
  /// already.
  bool take_reset_request();
  /// Watchdog: true as long as every timed job has been served within its time. Feed the watchdog only then.
  bool healthy(LocalTime now) const;
  std::uint8_t node_id() const;
};

}  // namespace kinebus
