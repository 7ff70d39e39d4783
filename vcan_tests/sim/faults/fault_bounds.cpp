#include "vcan_tests/sim/faults/fault_bounds.hpp"

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

/// Without the gateway's SYNC: 175 ms from the last one, and the ramp of 100 ms. A silent node: 250 ms for
/// the gateway to see it.
constexpr double kSyncLoss_ms = 175 + 105, kNodeSilence_ms = 2 * 250 + 20 + 110;

FaultBounds bounds_of(const Fault& fault) {
  FaultBounds b;
  switch (fault.kind) {
    case kCrystals:
      // 200 ppm apart the window's slope is worth less in the first seconds.
      b.outcomes = kFinished;
      b.skew_us = 3;
      break;
    case kNone:
    case kForeignTraffic:
    case kFramesDoubled:
    case kSwitchBounces:
    case kBabblerBelow:
      b.outcomes = kFinished;
      break;
    case kInterruptLatency:
      // Six times the latency by the SYNCs in the window (clock_estimate.hpp).
      b.outcomes = kFinished;
      b.skew_us = 4;
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
    case kReceiveOverrun:
      b.outcomes = kFinished | kContinued | kBegunAgain;
      break;
    case kDriveFault:
      // Its motor is let go at once; where it stands nobody knows then.
      b.outcomes = kFinished | kContinued | kHomedAgain | kBegunAgain;
      b.step_ratio = kAny;
      b.path_um = kAny;
      break;
    case kGatewayDies:
      b.outcomes = kContinued | kHomedAgain | kFinished | kBegunAgain;
      b.rest_ms = kSyncLoss_ms;
      break;
    case kNodeDies:
    case kNodeRestarts:
      b.outcomes = kHomedAgain | kContinued | kFinished | kBegunAgain;
      b.rest_ms = kNodeSilence_ms;
      break;
    case kBitErrors:
    case kFramesDropped:
    case kFramesDelayed:
    case kFramesReordered:
    case kLateStatus:
    case kSlowGateway:
    case kNodeStalls:
    case kBabblerAbove:
    case kSecondGateway:
      b.outcomes = kFinished | kContinued | kHomedAgain | kBegunAgain;
      break;
    case kFramesCorrupted:
      // A rate command whose data are wrong in spite of the CRC has no second check: found at the next rest.
      b.outcomes = kFinished | kContinued | kHomedAgain | kBegunAgain;
      b.path_um = b.skew_us = kAny;
      break;
    case kBusOff:
      b.outcomes = kFinished | kContinued | kHomedAgain | kBegunAgain;
      b.rest_ms = 900;  // destroyed frames hold up the stop requests of the others too
      b.skew_us = 16;   // SYNCs that the failing transmitter mangled are missing in the estimate
      break;
    case kLostSteps:
      // What no node can see before it homes again; the path is wrong from there on.
      b.outcomes = kFinished;
      b.path_um = kAny;
      b.step_ratio = kAny;
      break;
    case kSwitchDead:
    case kSwitchStuck:
    case kSwitchesExchanged:
    case kWrongIdentity:
    case kNodeIdCollision:
      b.outcomes = kRefused | kFinished;
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
