#include "protocol/canopen/abort_code.hpp"

namespace kinebus {

std::string_view text(AbortCode code) {
  switch (code) {
    case AbortCode::kNone:
      return "no error";
    case AbortCode::kToggleBit:
      return "toggle bit not alternated";
    case AbortCode::kTimeout:
      return "SDO protocol timed out";
    case AbortCode::kCommandSpecifier:
      return "command specifier not valid or unknown";
    case AbortCode::kBlockSize:
      return "invalid block size";
    case AbortCode::kSequenceNumber:
      return "invalid sequence number";
    case AbortCode::kCrc:
      return "CRC error";
    case AbortCode::kOutOfMemory:
      return "out of memory";
    case AbortCode::kUnsupportedAccess:
      return "unsupported access to an object";
    case AbortCode::kWriteOnly:
      return "attempt to read a write-only object";
    case AbortCode::kReadOnly:
      return "attempt to write a read-only object";
    case AbortCode::kNoObject:
      return "object does not exist in the object dictionary";
    case AbortCode::kNotMappable:
      return "object cannot be mapped to the PDO";
    case AbortCode::kPdoLength:
      return "number and length of the mapped objects exceed the PDO length";
    case AbortCode::kIncompatible:
      return "general parameter incompatibility";
    case AbortCode::kHardware:
      return "access failed due to a hardware error";
    case AbortCode::kLength:
      return "data type does not match, length of service parameter does not match";
    case AbortCode::kTooLong:
      return "data type does not match, service parameter too long";
    case AbortCode::kTooShort:
      return "data type does not match, service parameter too short";
    case AbortCode::kNoSubindex:
      return "subindex does not exist";
    case AbortCode::kInvalidValue:
      return "invalid value for parameter";
    case AbortCode::kTooHigh:
      return "value of parameter written too high";
    case AbortCode::kTooLow:
      return "value of parameter written too low";
    case AbortCode::kMaxBelowMin:
      return "maximum value is less than minimum value";
    case AbortCode::kGeneral:
      return "general error";
    case AbortCode::kCannotStore:
      return "data cannot be transferred or stored to the application";
    case AbortCode::kLocalControl:
      return "data cannot be transferred because of local control";
    case AbortCode::kDeviceState:
      return "data cannot be transferred because of the present device state";
    case AbortCode::kNoData:
      return "no data available";
  }
  return "unknown abort code";
}

}  // namespace kinebus
