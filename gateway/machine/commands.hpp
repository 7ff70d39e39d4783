#pragma once
// What may be asked of the machine. A command is a struct here, a row of the table in commands.cpp (its name
// and the states in which it may be given), and a handler Gateway::Core::on(); whoever takes requests (job
// link, console, print host, tests) only makes the struct. Gateway::may() tells whether it may be given now.

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gateway/description/device_description.hpp"
#include "gateway/devices/device.hpp"
#include "gateway/jobs/byte_source.hpp"
#include "gateway/motors/motor_settings.hpp"
#include "gateway/pose.hpp"
#include "gateway/sentence.hpp"
#include "gateway/status/state.hpp"

namespace kinebus {

namespace command {

struct BringUp {};
struct Home {};
struct GoToReference {};
/// A relative move of the tool in the machine frame. While one is under way, further ones wait for their
/// turn; those that go on alike are joined.
struct Jog {
  Pose delta{};            ///< mm, mm, mm, rad, rad, mm
  double speed_per_s = 0;  ///< of the tool tip, mm/s, or of the turning axis, rad/s; 0: the machine's default
  /// As long as a key is held: along `delta` as far as the machine can go of it, and only while this command
  /// is given again at least every kHeldJogPatience. A delta of 0 lets go.
  bool while_held = false;
};
inline constexpr std::chrono::milliseconds kHeldJogPatience{200};
/// Checks the whole job (kChecking), then runs it. Problems come as kProblem events; with errors nothing
/// moves.
struct Run {
  std::unique_ptr<ByteSource> job;
  std::string name;
};
/// Lines as they come from a print host or a console, instead of a whole job (Gateway::take_line).
struct OpenLines {
  std::string name;
};
struct Hold {};
/// From a hold; or an interrupted job, from wherever the machine is: brings up, homes and heats as needed.
struct Resume {};
struct Cancel {};
struct Stop {  ///< latched, in every state
  Sentence why = say("stop by command");
  bool heaters_off = false;  ///< whatever on_stop says, as M112; a job that goes on heats again first
};
struct Clear {};  ///< lifts a stop or an alarm
struct SetFeedOverride {
  double ratio = 1;  ///< 0.01 .. 5
};
struct MotorsOff {};
struct SetTemperature {
  HeaterId heater = kFirstHotend;
  double celsius = 0;  ///< 0: off
};
struct SetFan {
  double ratio = 0;  ///< 0..1
  std::uint8_t index = 0;
};
struct SetOutput {
  double ratio = 0;  ///< 0..1
  std::uint8_t index = 0;
};
struct SetSpindle {
  double rpm = 0;  ///< > 0 clockwise, < 0 the other way, 0: off
};
/// Of the machine, as G10 L2 and L20 set it: lines use it, jobs begin with it, the journal keeps it.
struct SetWorkOffset {
  std::uint32_t system = 1;  ///< 1 (G54) .. 9 (G59.3)
  Pose offset{};  ///< of the work zero in table coordinates; with `here`: what the tool's place is to be
                  ///< called
  bool here = false;
};
struct SetMotorCurrents {
  std::vector<MotorSetting> motors;
};
/// The node measures the motor's winding while it stands.
struct TuneMotor {
  std::size_t joint = 0;
};
/// The heater's node heats it part of the way and finds its model. SetTemperature with 0 ends it.
struct TuneHeater {
  HeaterId heater = kFirstHotend;
  double celsius = 0;  ///< it shall be good at; 0: where its kind usually works
};
/// The pin of a probe that has one. How it ends is told.
struct MovePin {
  ContactProbe::PinOrder order = ContactProbe::PinOrder::kIn;
};
/// One joint alone, all others end where they were.
struct JogMotor {
  std::size_t joint = 0;
  double distance = 0;     ///< mm or rad
  double speed_per_s = 0;  ///< of the joint; 0: slow
};
/// An object of the print under way is left out, from what is not planned yet on.
struct ExcludeObject {
  std::string name;  ///< in any case, or M486's number
};
/// The job that is held is interrupted at its place: the tool rises and parks, and the machine is the
/// operator's, to jog, to extrude, to heat, until Resume brings it back.
struct StepAside {};
/// As far and as fast as [pause] of the machine file says.
struct MoveFilament {
  enum class What : std::uint8_t { kUnload, kLoad, kPurge } what = What::kUnload;
};

}  // namespace command

using Command =
    std::variant<command::BringUp, command::Home, command::GoToReference, command::Jog, command::Run,
                 command::OpenLines, command::Hold, command::Resume, command::Cancel, command::Stop,
                 command::Clear, command::SetFeedOverride, command::MotorsOff, command::SetTemperature,
                 command::SetFan, command::SetOutput, command::SetSpindle, command::SetWorkOffset,
                 command::SetMotorCurrents, command::TuneMotor, command::JogMotor, command::TuneHeater,
                 command::ExcludeObject, command::MovePin, command::StepAside, command::MoveFilament>;

/// A kind of command: its place in Command.
using CommandKind = std::size_t;
inline constexpr CommandKind kCommandKinds = std::variant_size_v<Command>;

namespace command {
template <typename C, typename Variant>
struct KindOf;
template <typename C, typename... All>
struct KindOf<C, std::variant<All...>> {
  static constexpr CommandKind value() {
    constexpr std::array<bool, sizeof...(All)> kSame{std::is_same_v<C, All>...};
    CommandKind at = 0;
    while (!kSame[at]) ++at;
    return at;
  }
};
/// kind<command::Jog>
template <typename C>
inline constexpr CommandKind kind = KindOf<C, Command>::value();
}  // namespace command

/// "go to the bed reference"
Sentence sentence(CommandKind command);
/// Whether it may be given in `state`, as far as the state alone decides.
bool allowed(CommandKind command, MachineState state);

}  // namespace kinebus
