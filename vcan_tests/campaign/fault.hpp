#pragma once
// The faults that the simulation knows, and a run's share of them: all drawn from one seed.

#include <array>
#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

#include "protocol/time.hpp"

namespace kinebus {

enum class FaultKind : std::uint8_t {
  kNone,
  kCrystals,          ///< +-100 ppm
  kInterruptLatency,  ///< up to 300 us
  kReceiveOverrun,    ///< one node misses all frames for a while, and knows it
  kBitErrors,         ///< frames destroyed for all and sent again
  kBusOff,            ///< one station's transmitter fails until it is bus-off
  kFramesDropped,     ///< one receiver does not get some frames
  kFramesDelayed,
  kFramesDoubled,
  kFramesReordered,
  kFramesCorrupted,  ///< wrong data in spite of the CRC
  kSwitchBounces,
  kSwitchDead,
  kSwitchStuck,
  kSwitchesExchanged,  ///< of the two carriages of one node, or of two nodes
  kLostSteps,
  kLateStatus,  ///< the gateway hears the nodes late
  kSlowGateway,
  kGatewayDies,    ///< kill -9, and a new one later
  kNodeDies,       ///< power lost, back later
  kNodeRestarts,   ///< a reset
  kNodeStalls,     ///< its main loop hangs for a while
  kEmergencyStop,  ///< the input of any node
  kDriveFault,
  kBabblerAbove,    ///< a device that never ends sending, with the highest identifier
  kBabblerBelow,    ///< with the lowest
  kForeignTraffic,  ///< another CANopen system on the same bus
  kNodeIdCollision,
  kWrongIdentity,
  kWrongParameters,  ///< of another machine, or a dictionary that does not keep what is written
  kSecondGateway,
  kHold,  ///< no fault: the operator holds, resumes
  kCancel,
  kOperatorStop,
  // Of heat: the machine has a heat node, and the job heats first.
  kSensorOpen,  ///< the hot end's, or the bed's
  kSensorShorted,
  kSensorLoose,  ///< out of its hole
  kHeaterLoose,
  kHeaterStuck,  ///< its MOSFET does not open
  kHotEndFanStands,
  kHeatNodeDies,    ///< power lost, back later
  kHeatNodeOffBus,  ///< its plug is out
  kHotGatewayDies,  ///< kill -9 while it is hot, and a new one later
  kFilamentOut,
  kFilamentJams,
  kCount,
};
inline constexpr int kFaultKinds = static_cast<int>(FaultKind::kCount);
std::string_view to_string(FaultKind kind);
/// By its name; kCount: none has it.
FaultKind fault_kind_of(std::string_view name);

constexpr bool of_heat(FaultKind kind) {
  return kind >= FaultKind::kSensorOpen && kind < FaultKind::kCount;
}
/// The heat node's place, after those with axes.
inline constexpr int kHeatNode = 3;

/// When a fault comes.
enum class FaultPhase : std::uint8_t { kFromPowerUp, kHoming, kJob, kPrint /**< the job has heated */ };

struct Fault {
  FaultKind kind = FaultKind::kNone;
  FaultPhase phase = FaultPhase::kJob;
  BusTime after{0};   ///< from the phase's begin
  BusTime length{0};  ///< how long its cause lasts
  int node = 0;
  int axis = 0;         ///< of heat: 0 hot end, 1 bed
  double strength = 0;  ///< 0..1: how bad
};

/// How late a node may hear of a frame by kInterruptLatency: from what every node has to bear to three times
/// that.
constexpr std::chrono::nanoseconds kUsualLatency = std::chrono::microseconds{20};
constexpr std::chrono::nanoseconds latency_of(const Fault& fault) {
  return kUsualLatency + std::chrono::nanoseconds{static_cast<std::int64_t>(40e3 * fault.strength)};
}

/// Of kSwitchesExchanged: the wires go to each other's node.
constexpr bool between_nodes(const Fault& fault) {
  return fault.axis == 1;
}
/// Of kWrongParameters: the node has others, and takes those that it is told.
constexpr bool keeps_parameters(const Fault& fault) {
  return fault.strength < 0.5;
}

struct FaultPlan {
  std::uint64_t seed = 0;
  std::vector<Fault> faults;  ///< the first one names the run
};

/// Node faults strike one of `nodes`. `only`: this kind, whatever the seed says; kCount: all in turn.
FaultPlan draw_faults(std::uint64_t seed, int nodes, FaultKind only = FaultKind::kCount);

/// 0 <= value < 1, the same on every platform.
inline double unit(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}
inline BusTime between(std::mt19937_64& random, BusTime low, BusTime high) {
  return low + BusTime{static_cast<std::int64_t>(unit(random) * static_cast<double>((high - low).count()))};
}

}  // namespace kinebus
