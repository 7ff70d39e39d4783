#pragma once
// SDO abort codes (CiA 301, table of SDO abort codes), used wherever an object access is refused.

#include <cstdint>
#include <string_view>

namespace kinebus {

enum class AbortCode : std::uint32_t {
  kNone = 0,
  kToggleBit = 0x0503'0000,
  kTimeout = 0x0504'0000,
  kCommandSpecifier = 0x0504'0001,
  kBlockSize = 0x0504'0002,
  kSequenceNumber = 0x0504'0003,
  kCrc = 0x0504'0004,
  kOutOfMemory = 0x0504'0005,
  kUnsupportedAccess = 0x0601'0000,
  kWriteOnly = 0x0601'0001,
  kReadOnly = 0x0601'0002,
  kNoObject = 0x0602'0000,
  kNotMappable = 0x0604'0041,
  kPdoLength = 0x0604'0042,
  kIncompatible = 0x0604'0043,
  kHardware = 0x0606'0000,
  kLength = 0x0607'0010,
  kTooLong = 0x0607'0012,
  kTooShort = 0x0607'0013,
  kNoSubindex = 0x0609'0011,
  kInvalidValue = 0x0609'0030,
  kTooHigh = 0x0609'0031,
  kTooLow = 0x0609'0032,
  kMaxBelowMin = 0x0609'0036,
  kGeneral = 0x0800'0000,
  kCannotStore = 0x0800'0020,
  kLocalControl = 0x0800'0021,
  kDeviceState = 0x0800'0022,
  kNoData = 0x0800'0024,
};

/// English text for a person; "unknown abort code" for a code that is not listed above.
std::string_view text(AbortCode code);

}  // namespace kinebus
