#pragma once
// The whole gateway as one sans-IO state machine: it brings up the nodes, homes, plans and streams motion,
// holds and stops it, and tells what it does. Whoever owns it feeds frames and time in, and pulls frames and
// events out:
//
//   on_frame / on_frame_sent / on_time  ->  Gateway  ->  next_frame (until empty) / next_event /
//   next_deadline
//
// All times are the owner's monotonic bus clock. on_frame_sent must report every frame of next_frame() that
// really went out, with the time of its end of frame: the time stamp of SYNC is made of it. The work in one
// call is bounded (Options::planning_budget), so that an event loop stays responsive.

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/devices/devices.hpp"
#include "gateway/jobs/byte_source.hpp"
#include "gateway/jobs/journal/journal_state.hpp"
#include "gateway/kinematics/kinematics.hpp"
#include "gateway/machine/commands.hpp"
#include "gateway/result.hpp"
#include "gateway/run/planned_pose.hpp"
#include "gateway/sentence.hpp"
#include "gateway/status/event.hpp"
#include "gateway/status/refusal.hpp"
#include "gateway/status/state.hpp"
#include "gateway/status/status.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/motion/siphash.hpp"
#include "protocol/time.hpp"

namespace kinebus {

struct MachineDescription;  // gateway/description
class BedLevel;             // gateway/run

class Gateway {
 public:
  struct Options {
    std::uint8_t epoch = 1;     ///< of the time stamps: another value after every start of the gateway
    int planning_budget = 400;  ///< G-code lines interpreted in one on_time() call, at most
    double unix_s_at_zero = 0;  ///< wall time at time 0 of the bus clock, for what is kept with its date
    /// Random, of this start: sessions on the bus derive their keys from it (bus.trust of the machine file).
    SipHashKey bus_secret{};
    bool journal = false;  ///< somebody stores next_journal_record(); a run waits (briefly) for it
  };

  explicit Gateway(const MachineDescription& machine);
  Gateway(const MachineDescription& machine, Options options);
  /// With devices that are not those of the registry.
  Gateway(const MachineDescription& machine, Options options, Devices devices);
  ~Gateway();
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;

  // The bus and the time.
  void on_frame(BusTime when, const CanFrame& frame);  ///< `when`: as the receiver time-stamped it
  void on_frame_sent(BusTime when,
                     const CanFrame& frame);  ///< a frame of next_frame() was on the bus at `when`
  void on_time(BusTime now);
  /// What to send now, most urgent first: rate and stop, SYNC, stamp, NMT, SDO, records by earliest deadline.
  /// Pull when the bus can take a frame, not ahead: the order is decided late.
  std::optional<CanFrame> next_frame(BusTime now);
  BusTime next_deadline() const;  ///< when on_time is next needed: always later than the last time given
  BusTime sync_due() const;       ///< when next_frame() has the next SYNC; max: the bus is not spoken to
  /// The owner was not run for `length`, up to now, and so nothing was heard or said; before the frames that
  /// waited.
  void on_stall(BusTime now, BusTime length, const Sentence& why);
  /// The bus controller reported bus-off or lost its carrier: motion cannot be commanded any more.
  void on_bus_failure(BusTime now, std::string_view what);

  /// Carries a command out, or begins to. Refused: why, and nothing has changed; but a machine that is held
  /// and cannot go back to its job is ready then, to be moved by hand.
  Result<void, Refusal> carry_out(Command command);
  /// Whether such a command may be given now (command::kind<command::Jog>), and if not, why. What it asks for
  /// in particular may be refused all the same.
  Result<void, Refusal> may(CommandKind command) const;

  // Lines as they come from a print host or a console: open from command::OpenLines on; the state is kRunning
  // until close_lines() and the last motion's end (or a cancel). Every line is checked before it is taken.
  // The host may be slow: motion then ends in a planned stop and goes on with the next line.
  /// One line. Refused: why, and nothing has changed. When not open lines that do not move are taken,
  /// too: modes and limits count from then on. Heaters are set at once, others take effect in their order.
  /// Give no more than line_room().
  Result<void, Refusal> take_line(std::string_view line, std::uint32_t number);
  /// Lines that can be taken now, of kLineRoom; 0 while closing, and when the motion taken and not carried
  /// out takes as long as the machine file's serial.lead_s.
  std::size_t line_room() const;
  bool lines_open() const;
  bool lines_idle() const;  ///< every line taken is carried out, and nothing moves
  void close_lines();
  /// close_lines() of a host that has gone: what is not carried out within the lead is given up, on the path.
  void leave_lines();
  void skip_heating();       ///< a line's wait for a temperature is over
  void forget_line_modes();  ///< G-code modes and limits of lines are as after switching on
  /// Of G54 .. G59.3: lines set them, jobs begin with them, the journal keeps them.
  const gcode::WorkOffsets& work_offsets() const;
  /// What a job finds the first hot end set to, deg C; none: nobody knows.
  HotendTargets hotends_found() const;
  /// The bed's meshes.
  const BedLevel& bed() const;
  static constexpr std::size_t kLineRoom = 32;
  /// One line of a text session (M105, M114, M115, M119, G28, M112, M24, M25 ...): the reply, without "ok".
  Result<std::string, Refusal> text_line(std::string_view line);

  // The journal: what another gateway needs to take up the job of this one.
  std::optional<journal::Record> next_journal_record();
  /// The first `count` records are stored, or never will be.
  void on_journal_stored(std::uint64_t count);
  /// Right after the start: what the gateway before has noted, and the text of its job, if there was one.
  /// command::Resume takes that up; the machine's work offsets count again at once.
  Result<void, Refusal> recover(journal::State state, std::unique_ptr<ByteSource> job);

  MachineState state() const;
  MachineStatus status() const;
  /// Somebody looks at status(): the motors' currents are read for the next seconds.
  void watch_currents();
  std::optional<MachineEvent> next_event();
  /// Path time by the gateway's own copy of the nodes' arithmetic.
  PathTime path_time(BusTime at) const;
  /// The planned pose at a path time of the motion that is queued or running; nullopt: no motion there, or
  /// more than about a second ago. For checkers and displays.
  std::optional<PlannedPose> planned_pose(PathTime tau) const;

 private:
  class Core;
  std::unique_ptr<Core> core_;
};

}  // namespace kinebus
