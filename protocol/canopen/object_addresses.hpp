#pragma once
// What code calls by name in the node's object table: addresses, counters, and the numbers that 2130h and
// 1018h take.

#include <cstdint>

#include "protocol/canopen/object.hpp"

namespace kinebus {

inline constexpr std::uint32_t kVendorId = 0x4B49'4E45;  // "KINE": Kinebus has no number of CiA
inline constexpr std::uint32_t kProductCode = 0x0000'0402;
inline constexpr std::uint32_t kRevisionNumber = 0x0001'0000;
inline constexpr std::int64_t kSaveSignature = 0x6576'6173;  // "save", 1010h
inline constexpr std::int64_t kLoadSignature = 0x6461'6F6C;  // "load", 1011h
inline constexpr std::int64_t kEmcyOff = 0x8000'0000;        // 1014h, bit 31
inline constexpr int kRpdoCount = 6;
inline constexpr int kTpdoCount = 4;
inline constexpr int kSwitchInputs = 7;
inline constexpr int kErrorHistoryLength = 8;

/// What a switch input does (2130h). Home inputs latch the position; limit and stop inputs stop everything on
/// the path.
enum class SwitchFunction : std::uint8_t {
  kNone = 0,
  kHomeA = 1,
  kHomeB = 2,
  kPositiveLimitA = 3,
  kPositiveLimitB = 4,
  kNegativeLimitA = 5,
  kNegativeLimitB = 6,
  kEmergencyStop = 7,
  kProbe = 8,  ///< latches the positions of both axes (2140h:8, 60B8h ff.), stops nothing
};

/// Addresses that code names; axis objects at their base (first axis).
namespace object {
inline constexpr ObjectAddress kDeviceType{0x1000, 0}, kErrorRegister{0x1001, 0}, kErrorHistory{0x1003, 0},
    kSyncCobId{0x1005, 0}, kSyncPeriod{0x1006, 0}, kGuardTime{0x100C, 0}, kLifeTimeFactor{0x100D, 0},
    kHighResolutionTime{0x1013, 0}, kEmcyCobId{0x1014, 0}, kEmcyInhibitTime{0x1015, 0},
    kConsumerHeartbeat{0x1016, 1}, kProducerHeartbeat{0x1017, 0}, kVendorIdentity{0x1018, 1},
    kProductIdentity{0x1018, 2}, kRevisionIdentity{0x1018, 3}, kSerialIdentity{0x1018, 4},
    kSyncCounterOverflow{0x1019, 0}, kStoreParameters{0x1010, 1}, kRestoreParameters{0x1011, 1},
    kErrorBehaviour{0x1029, 1};
inline constexpr ObjectAddress kSegmentRecord{0x2100, 0}, kCheckpoint{0x2101, 0}, kStreamStatus{0x2102, 0},
    kRateCommand{0x2110, 0}, kSyncStamp{0x2111, 0}, kPathTime{0x2112, 0}, kStopRamp{0x2113, 0},
    kSyncLossTimeout{0x2114, 0}, kStarvationMargin{0x2115, 0}, kFingerprint{0x2116, 0},
    kSessionKey{0x2117, 1}, kSessionInForce{0x2117, 5}, kStreamFunctions{0x2118, 0}, kTailCheck{0x2119, 0},
    kCounters{0x2120, 0}, kSwitchFunction{0x2130, 1}, kSwitchPolarity{0x2131, 1}, kSwitchDebounce{0x2132, 1},
    kSwitchLevels{0x2133, 0};
inline constexpr ObjectAddress kAccelerationShift{0x2140, 1}, kRunCurrent{0x2140, 2}, kHoldCurrent{0x2140, 3},
    kDirectionInvert{0x2140, 4}, kCountsPerUnit{0x2140, 5}, kPositionKnown{0x2140, 6},
    kStreamPosition{0x2140, 7}, kHomeLatch{0x2140, 8}, kHomingTravel{0x2140, 9}, kHomingBackOff{0x2140, 10};
inline constexpr ObjectAddress kBoostCurrent{0x2150, 1}, kPhaseResistance{0x2150, 2},
    kPhaseInductance{0x2150, 3}, kFluxLinkage{0x2150, 4}, kCurrentBandwidth{0x2150, 5},
    kEncoderMode{0x2150, 6}, kEncoderOffset{0x2150, 7}, kAutoTune{0x2150, 8}, kMotorCurrent{0x2150, 9},
    kStageTemperature{0x2150, 10};
inline constexpr ObjectAddress kScaleFitted{0x2160, 1}, kScaleCountsPerUnit{0x2160, 2},
    kScaleInverted{0x2160, 3}, kScalePosition{0x2160, 4}, kScaleHomeLatch{0x2160, 5},
    kScaleMotorRatio{0x2160, 6}, kScaleCorrectionMost{0x2160, 7}, kScaleCorrectionRate{0x2160, 8},
    kScaleCorrection{0x2160, 9};
inline constexpr ObjectAddress kDriverKind{0x2170, 1}, kSpreadCycleAbove{0x2170, 2},
    kStallThreshold{0x2170, 3}, kStallAbove{0x2170, 4}, kDriverState{0x2170, 5}, kDriverStatus{0x2170, 6},
    kStallGuard{0x2170, 7}, kSenseResistor{0x2170, 8}, kDriverFound{0x2170, 9};
inline constexpr ObjectAddress kErrorCode{0x603F, 0}, kControlword{0x6040, 0}, kStatusword{0x6041, 0},
    kAbortConnectionOption{0x6007, 0}, kQuickStopOption{0x605A, 0}, kShutdownOption{0x605B, 0},
    kDisableOption{0x605C, 0}, kHaltOption{0x605D, 0}, kFaultReactionOption{0x605E, 0},
    kModeOfOperation{0x6060, 0}, kModeDisplay{0x6061, 0}, kPositionDemand{0x6062, 0},
    kPositionActual{0x6064, 0}, kFollowingErrorWindow{0x6065, 0}, kFollowingErrorTimeout{0x6066, 0},
    kVelocityDemand{0x606B, 0}, kVelocityActual{0x606C, 0}, kTargetPosition{0x607A, 0},
    kHomeOffset{0x607C, 0}, kMinPositionLimit{0x607D, 1}, kMaxPositionLimit{0x607D, 2},
    kMaxProfileVelocity{0x607F, 0}, kProfileVelocity{0x6081, 0}, kProfileAcceleration{0x6083, 0},
    kProfileDeceleration{0x6084, 0}, kQuickStopDeceleration{0x6085, 0}, kHomingMethod{0x6098, 0},
    kHomingFastSpeed{0x6099, 1}, kHomingSlowSpeed{0x6099, 2}, kHomingAcceleration{0x609A, 0},
    kPositionOffset{0x60B0, 0}, kVelocityOffset{0x60B1, 0}, kTouchProbeFunction{0x60B8, 0},
    kTouchProbeStatus{0x60B9, 0}, kTouchProbePositive{0x60BA, 0}, kTouchProbeNegative{0x60BB, 0},
    kTouchProbePositiveTime{0x60D1, 0}, kTouchProbeNegativeTime{0x60D2, 0}, kInterpolationSubMode{0x60C0, 0},
    kInterpolationData{0x60C1, 1}, kInterpolationPeriod{0x60C2, 1}, kInterpolationIndex{0x60C2, 2},
    kBufferMaximum{0x60C4, 1}, kBufferActual{0x60C4, 2}, kBufferPosition{0x60C4, 4}, kBufferClear{0x60C4, 6},
    kMaxAcceleration{0x60C5, 0}, kMaxDeceleration{0x60C6, 0}, kFollowingError{0x60F4, 0},
    kDigitalInputs{0x60FD, 0}, kDigitalOutputs{0x60FE, 1}, kTargetVelocity{0x60FF, 0},
    kSupportedModes{0x6502, 0};
}  // namespace object

/// 60B8h: switches touch probe 1 on, for every edge or the first of each kind since then.
namespace touch_probe {
inline constexpr std::uint16_t kOn = 0x01, kEveryEdge = 0x02, kPositiveEdge = 0x10, kNegativeEdge = 0x20;
// 60B9h.
inline constexpr std::uint16_t kPositiveStored = 0x02, kNegativeStored = 0x04;
}  // namespace touch_probe

/// Counters of 2120h: everything that can go wrong, by subindex.
enum class NodeCounter : std::uint8_t {
  kRxMalformed = 1,
  kRxOverrun,
  kTxFull,
  kBusOff,
  kSyncLost,
  kStampLost,
  kClockOutOfBound,
  kSequenceErrors,
  kQueueOverflows,
  kUnderruns,
  kCheckpointErrors,
  kLateRateCommands,
  kDuplicateFrames,
  kPdoLengthErrors,
  kSdoAborts,
  kSwitchGlitches,
  kEmergencies,
  kStorageErrors,
  kWatchdogResets,
  kCoordinatedStops,
  kLateStops,
  kHomingErrors,
  kDriveFaults,
  kRecordsReordered,
  kFramesRefused,
  kLast = kFramesRefused,
};

}  // namespace kinebus
