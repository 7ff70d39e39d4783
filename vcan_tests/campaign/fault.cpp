#include "vcan_tests/campaign/fault.hpp"

#include <cmath>

namespace kinebus {
namespace {

using namespace std::chrono_literals;
using enum FaultKind;

struct Row {
  FaultKind kind;
  std::string_view name;
  FaultPhase phase;
  BusTime shortest, longest;
};
constexpr std::array<Row, kFaultKinds> kRows{{
    {kNone, "none", FaultPhase::kJob, 0s, 0s},
    {kCrystals, "crystals", FaultPhase::kFromPowerUp, 0s, 0s},
    {kInterruptLatency, "interrupt-latency", FaultPhase::kFromPowerUp, 0s, 0s},
    {kReceiveOverrun, "receive-overrun", FaultPhase::kJob, 200us, 20ms},
    {kBitErrors, "bit-errors", FaultPhase::kFromPowerUp, 0s, 0s},
    {kBusOff, "bus-off", FaultPhase::kJob, 50ms, 500ms},
    {kFramesDropped, "frames-dropped", FaultPhase::kJob, 20ms, 1s},
    {kFramesDelayed, "frames-delayed", FaultPhase::kJob, 20ms, 1s},
    {kFramesDoubled, "frames-doubled", FaultPhase::kJob, 20ms, 2s},
    {kFramesReordered, "frames-reordered", FaultPhase::kJob, 20ms, 1s},
    {kFramesCorrupted, "frames-corrupted", FaultPhase::kJob, 20ms, 500ms},
    {kSwitchBounces, "switch-bounces", FaultPhase::kFromPowerUp, 0s, 0s},
    {kSwitchDead, "switch-dead", FaultPhase::kFromPowerUp, 0s, 0s},
    {kSwitchStuck, "switch-stuck", FaultPhase::kFromPowerUp, 0s, 0s},
    {kSwitchesExchanged, "switches-exchanged", FaultPhase::kFromPowerUp, 0s, 0s},
    {kLostSteps, "lost-steps", FaultPhase::kJob, 0s, 0s},
    {kLateStatus, "late-status", FaultPhase::kJob, 100ms, 2s},
    {kSlowGateway, "slow-gateway", FaultPhase::kJob, 100ms, 2s},
    {kGatewayDies, "gateway-dies", FaultPhase::kJob, 20ms, 2s},
    {kNodeDies, "node-dies", FaultPhase::kJob, 1s, 3s},
    {kNodeRestarts, "node-restarts", FaultPhase::kJob, 1ms, 50ms},
    {kNodeStalls, "node-stalls", FaultPhase::kJob, 500us, 45ms},
    {kEmergencyStop, "emergency-stop", FaultPhase::kJob, 50ms, 1s},
    {kDriveFault, "drive-fault", FaultPhase::kJob, 100ms, 500ms},
    {kBabblerAbove, "babbler-above", FaultPhase::kJob, 5ms, 1s},
    {kBabblerBelow, "babbler-below", FaultPhase::kJob, 100ms, 2s},
    {kForeignTraffic, "foreign-traffic", FaultPhase::kFromPowerUp, 0s, 0s},
    {kNodeIdCollision, "node-id-collision", FaultPhase::kFromPowerUp, 0s, 0s},
    {kWrongIdentity, "wrong-identity", FaultPhase::kFromPowerUp, 0s, 0s},
    {kWrongParameters, "wrong-parameters", FaultPhase::kFromPowerUp, 0s, 0s},
    {kSecondGateway, "second-gateway", FaultPhase::kJob, 500ms, 2s},
    {kHold, "hold", FaultPhase::kJob, 10ms, 600ms},
    {kCancel, "cancel", FaultPhase::kJob, 0s, 0s},
    {kOperatorStop, "operator-stop", FaultPhase::kJob, 10ms, 300ms},
    {kSensorOpen, "sensor-open", FaultPhase::kPrint, 20ms, 10s},
    {kSensorShorted, "sensor-shorted", FaultPhase::kPrint, 20ms, 10s},
    {kSensorLoose, "sensor-loose", FaultPhase::kPrint, 500ms, 20s},
    {kHeaterLoose, "heater-loose", FaultPhase::kPrint, 500ms, 20s},
    {kHeaterStuck, "heater-stuck", FaultPhase::kPrint, 500ms, 20s},
    {kHotEndFanStands, "hot-end-fan-stands", FaultPhase::kPrint, 500ms, 10s},
    {kHeatNodeDies, "heat-node-dies", FaultPhase::kPrint, 20ms, 20s},
    {kHeatNodeOffBus, "heat-node-off-bus", FaultPhase::kPrint, 20ms, 20s},
    {kHotGatewayDies, "hot-gateway-dies", FaultPhase::kPrint, 20ms, 20s},
    {kFilamentOut, "filament-out", FaultPhase::kPrint, 200ms, 5s},
    {kFilamentJams, "filament-jams", FaultPhase::kPrint, 5s, 10s},
}};

constexpr bool in_order() {
  for (std::size_t i = 0; i < kRows.size(); ++i)
    if (static_cast<std::size_t>(kRows[i].kind) != i) return false;
  return true;
}
static_assert(in_order());

/// Lengths over orders of magnitude: as many short as long ones.
BusTime length_of(std::mt19937_64& random, const Row& row) {
  if (row.shortest <= 0s) return row.shortest;
  const double low = std::log(static_cast<double>(row.shortest.count()));
  const double high = std::log(static_cast<double>(row.longest.count()));
  return BusTime{std::llround(std::exp(low + (high - low) * unit(random)))};
}

Fault draw(std::mt19937_64& random, FaultKind kind, int nodes) {
  const Row& row = kRows[static_cast<std::size_t>(kind)];
  Fault fault{.kind = kind, .phase = row.phase};
  fault.length = length_of(random, row);
  fault.node = static_cast<int>(random() % static_cast<std::uint64_t>(nodes));
  fault.axis = static_cast<int>(random() & 1);
  fault.strength = unit(random);
  // Some that strike at any time strike in homing.
  const bool anywhen =
      row.phase == FaultPhase::kJob && kind != kHold && kind != kCancel && kind != kLostSteps;
  if (anywhen && unit(random) < 0.2) fault.phase = FaultPhase::kHoming;
  fault.after = row.phase == FaultPhase::kFromPowerUp ? BusTime{0} : between(random, 50ms, 2500ms);
  if (!of_heat(kind)) return fault;
  fault.node = kHeatNode;
  fault.strength = 1;
  const bool of_filament = kind == kFilamentOut || kind == kFilamentJams;
  if (of_filament || unit(random) < 0.7) return fault;
  fault.phase = FaultPhase::kJob;  // while it heats
  fault.after = between(random, 100ms, 30s);
  return fault;
}

/// Those that change neither what a run must come to nor its bounds: they join the others.
constexpr std::array kMild{kCrystals, kInterruptLatency, kForeignTraffic, kSwitchBounces, kFramesDoubled};

}  // namespace

std::string_view to_string(FaultKind kind) {
  return kRows[static_cast<std::size_t>(kind)].name;
}

FaultKind fault_kind_of(std::string_view name) {
  for (const Row& row : kRows)
    if (row.name == name) return row.kind;
  return kCount;
}

FaultPlan draw_faults(std::uint64_t seed, int nodes, FaultKind only) {
  std::mt19937_64 random(seed * 0x9E3779B97F4A7C15ULL + 1);
  const auto turn = static_cast<FaultKind>(seed % kFaultKinds);
  FaultPlan plan{.seed = seed, .faults = {draw(random, only == kCount ? turn : only, nodes)}};
  if (unit(random) < 0.3) {
    const FaultKind second = kMild[random() % kMild.size()];
    if (second != plan.faults[0].kind) plan.faults.push_back(draw(random, second, nodes));
  }
  return plan;
}

}  // namespace kinebus
