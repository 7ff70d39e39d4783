#include "vcan_tests/campaign/fault_bounds.hpp"

#include <algorithm>
#include <limits>

namespace kinebus {
namespace {

using enum FaultKind;

constexpr double kAny = std::numeric_limits<double>::infinity();

constexpr unsigned bit(FaultOutcome outcome) {
  return 1u << static_cast<unsigned>(outcome);
}
constexpr unsigned kFinished = bit(FaultOutcome::kFinished), kContinued = bit(FaultOutcome::kContinued),
                   kReady = bit(FaultOutcome::kReady), kHomedAgain = bit(FaultOutcome::kHomedAgain),
                   kBegunAgain = bit(FaultOutcome::kBegunAgain), kRefused = bit(FaultOutcome::kRefused);

/// Without the gateway's SYNC: 175 ms from the last one, and the ramp of 100 ms. A silent node: the gateway
/// waits 250 ms for a status, from 250 ms after the motion's begin on; then the ramp.
constexpr double kSyncLoss_ms = 175 + 105, kNodeSilence_ms = 2 * 250 + 20 + 110,
                 kHeartbeatLoss_ms = 1500 + 20 + 110;
/// The node of M1 that has the table and the extruder.
constexpr int kTableNode = 2;

FaultBounds bounds_of(const Fault& fault) {
  FaultBounds b;
  switch (fault.kind) {
    case kCrystals:
    case kNone:
    case kForeignTraffic:
    case kFramesDoubled:
    case kSwitchBounces:
    case kBabblerBelow:
      b.outcomes = kFinished;
      break;
    case kInterruptLatency:
      // What a node makes of SYNCs that come late errs in proportion to how late: 2 us for 20 us.
      b.outcomes = kFinished;
      b.skew_us *=
          static_cast<double>(latency_of(fault).count()) / static_cast<double>(kUsualLatency.count());
      break;
    case kHold:
      b.outcomes = kContinued | kFinished | kBegunAgain;
      b.rest_ms = 5 + 200 + 5;  // its ramp is gentler
      break;
    case kCancel:
      b.outcomes = kReady | kFinished;
      b.rest_ms = 5 + 200 + 5;
      break;
    case kOperatorStop:
    case kEmergencyStop:
      b.outcomes = kFinished | kContinued | kBegunAgain;
      break;
    case kDriveFault:
      // Its motor is let go at once; where it stands nobody knows then.
      b.outcomes = kFinished | kContinued | kHomedAgain | kBegunAgain;
      b.step_ratio = kAny;
      break;
    case kGatewayDies:
      b.outcomes = kContinued | kHomedAgain | kFinished | kBegunAgain;
      b.rest_ms = kSyncLoss_ms;
      break;
    case kNodeDies:
    case kNodeRestarts:
      b.outcomes = kHomedAgain | kContinued | kFinished | kBegunAgain;
      // While carriages home, a node that has none is missed by its heartbeat alone: nothing of it moves.
      b.rest_ms = fault.phase == FaultPhase::kHoming && fault.node == kTableNode ? kHeartbeatLoss_ms
                                                                                 : kNodeSilence_ms;
      break;
    case kBitErrors:
    case kReceiveOverrun:
    case kFramesDropped:
    case kFramesDelayed:
    case kFramesReordered:
    case kLateStatus:
    case kSlowGateway:
    case kNodeStalls:
    case kSecondGateway:
      b.outcomes = kFinished | kContinued | kHomedAgain | kBegunAgain;
      break;
    case kBabblerAbove:
      // A stop that the babbler held back for up to 12 ms is caught up by each node from when it hears of it.
      // Steeper ramps that begin 20 us of interrupt latency apart, and end at one tau, are up to a quarter of
      // that apart on the way.
      b.outcomes = kFinished | kContinued | kHomedAgain | kBegunAgain;
      b.skew_us = 2 + 20.0 / 4;
      break;
    case kFramesCorrupted:
      // Rates, stops and stamps carry check bits; what a node has made of its records its statuses tell, and
      // all stop before one that is wrong in spite of the bus's CRC (below 5e-11 of all wrong ones) begins.
      // In 8 bits one of 256 is missed; the next status, 120 ms later, looks again, and is in time for what
      // was sent 0.3 s ahead. One of 65,536 moves its axis as far as the checkpoint lets it.
      b.outcomes = kFinished | kContinued | kHomedAgain | kBegunAgain;
      break;
    case kBusOff:
      b.outcomes = kFinished | kContinued | kHomedAgain | kBegunAgain;
      // Nobody can hear of a failing transmitter: a silent node or missing SYNCs tell.
      b.rest_ms = kNodeSilence_ms;
      break;
    case kSensorOpen:
    case kSensorShorted:
    case kSensorLoose:
    case kHeaterLoose:
    case kHotEndFanStands:
    case kFilamentOut:
    case kFilamentJams:
      // Held on the path and gone on with; some are over before they are known. On the machine's own way to
      // where the job begins there is no job yet that could be held.
      b.outcomes = kFinished | kContinued | kBegunAgain;
      break;
    case kHeaterStuck:
      // Its heater has power again on a cold block only, which this run does not wait for; nor need it where
      // the switch sticks before the block has become warm (seed 20003258).
      b.outcomes = kReady | kFinished | kContinued;
      break;
    case kHeatNodeDies:
    case kHeatNodeOffBus:
      b.outcomes = kFinished | kContinued | kBegunAgain;
      b.rest_ms = kHeartbeatLoss_ms;
      break;
    case kHotGatewayDies:
      b.outcomes = kContinued | kFinished | kBegunAgain;
      b.rest_ms = kSyncLoss_ms;
      break;
    case kLostSteps:
      // What no node can see before it homes again: the tool is astray from there on.
      b.outcomes = kFinished;
      b.step_ratio = kAny;
      break;
    case kWrongParameters:
      // Those of another machine are written anew; a node that does not keep them is no part of this machine.
      b.outcomes = keeps_parameters(fault) ? kFinished : kRefused;
      break;
    case kSwitchDead:
    case kSwitchStuck:
    case kSwitchesExchanged:
      // The third node has no switches.
      b.outcomes = fault.node < 2 ? kRefused : kFinished;
      break;
    case kWrongIdentity:
      b.outcomes = kRefused;
      break;
    case kNodeIdCollision:
      // A boot-up message of the other node while the gateway waits for this one's is refused; the next
      // bring-up may then be good. One that is found out while the job is looked at, too: the job begins
      // after it.
      b.outcomes = kRefused | kFinished | kContinued | kBegunAgain;
      break;
    case kCount:
      break;
  }
  return b;
}

}  // namespace

FaultBounds bounds_of(const FaultPlan& plan) {
  FaultBounds all = bounds_of(plan.faults.at(0));
  for (const Fault& fault : plan.faults) {
    const FaultBounds b = bounds_of(fault);
    all.path_um = std::max(all.path_um, b.path_um);
    all.skew_us = std::max(all.skew_us, b.skew_us);
    all.step_ratio = std::max(all.step_ratio, b.step_ratio);
    all.known_counts = std::max(all.known_counts, b.known_counts);
    all.rest_ms = std::max(all.rest_ms, b.rest_ms);
    all.sequence_breaks = std::max(all.sequence_breaks, b.sequence_breaks);
    all.clean_bus = all.clean_bus && b.clean_bus;
  }
  return all;
}

}  // namespace kinebus
