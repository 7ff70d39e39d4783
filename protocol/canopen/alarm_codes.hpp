#pragma once
// Every code that an alarm can carry: EMCY codes of CiA 301 and 402, the node's own (FFxxh is for the
// device), and the gateway's own, which are on no bus. What each means in words: alarm_table.hpp.

#include <cstdint>

namespace kinebus {

namespace emcy {
inline constexpr std::uint16_t kNoError = 0x0000;
inline constexpr std::uint16_t kOverCurrent = 0x2310, kShortCircuit = 0x2320, kShortToGround = 0x2330,
                               kShortToSupply = 0x2340, kPhaseOpen = 0x3130, kOverVoltage = 0x3210,
                               kUnderVoltage = 0x3220, kHeaterTooHot = 0x4201, kDeviceTemperature = 0x4210,
                               kDriveTemperature = 0x4310, kSensorOpen = 0x5001, kSensorShort = 0x5002,
                               kSensorJump = 0x5003, kSensorSilent = 0x5004, kHeatMissing = 0x5005,
                               kHeatUnasked = 0x5006, kFanStalled = 0x5007, kControlHardware = 0x5200,
                               kOtherBoard = 0x5210, kNoMotor = 0x5220, kCrystal = 0x5230,
                               kDriverReset = 0x5400, kStorage = 0x5530, kSoftware = 0x6100,
                               kEncoder = 0x7300, kIncrementalEncoder = 0x7305, kDriverSilent = 0x7510,
                               kCanOverrun = 0x8110, kErrorPassive = 0x8120, kHeartbeat = 0x8130,
                               kBusOffRecovered = 0x8140, kIdCollision = 0x8150, kPdoRefused = 0x8200,
                               kPdoTooShort = 0x8210, kPdoTooLong = 0x8220, kSyncLength = 0x8240,
                               kRpdoTimeout = 0x8250, kFollowingError = 0x8611, kPositionLimit = 0x8612,
                               kSyncController = 0x8700;
}  // namespace emcy

/// The node's own. What a code stops is in the vendor bytes: StopRequest (protocol/motion/broadcast.hpp).
namespace node_emcy {
inline constexpr std::uint16_t kStarved = 0xFF01, kSequence = 0xFF02, kCheckpoint = 0xFF03, kStream = 0xFF04,
                               kCommand = 0xFF05, kEmergencyStop = 0xFF06, kLimitSwitch = 0xFF07,
                               kNotVouched = 0xFF08, kHoming = 0xFF10;
}  // namespace node_emcy

/// The gateway's own.
enum class AlarmCode : std::uint16_t {
  kNodeMissing = 0xFF80,    ///< no sign of life during bring-up
  kWrongIdentity = 0xFF81,  ///< another product or too old a revision
  kConfiguration = 0xFF82,  ///< a parameter was refused by the node
  kEnableFailed = 0xFF83,   ///< a drive does not reach Operation Enabled
  kSecondGateway = 0xFF84,
  kHeartbeatLost = 0xFF85,
  kNodeRestarted = 0xFF86,  ///< boot-up in the midst of operation: its position is gone
  kSyncError = 0xFF87,      ///< a clock estimate left its bound
  kHomingFailed = 0xFF88,
  kHomingSpread = 0xFF89,
  kHomingTimeout = 0xFF8A,
  kStreamLost = 0xFF8B,  ///< sequence gap, checkpoint or underrun
  kPathTimeDiffers = 0xFF8C,
  kBusFailure = 0xFF8D,
  kThermal = 0xFF8E,
  kJobError = 0xFF8F,       ///< a job went wrong in the midst of running
  kEmergencyStop = 0xFF90,  ///< M112 or the operator's stop
  kStopTimeout = 0xFF91,    ///< the nodes did not come to rest as they should
  kIdTaken = 0xFF92,        ///< two nodes answer to one id
  kNodeChanged = 0xFF93,    ///< another device has stopped, moved, switched or written to a node
  kFilament = 0xFF94,       ///< a job has nothing to print with, or it does not come
};

}  // namespace kinebus
