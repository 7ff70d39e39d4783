#pragma once
// What the bits of Kinebus's packed frames are called: the records that are one u64 object each
// (protocol/motion/segment.hpp, broadcast.hpp), EMCY, NMT and heartbeat. DBC file and Wireshark dissector are
// printed from it; their tests pack frames by the codecs and read them back.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/canopen/object.hpp"

namespace kinebus {

using ValueNames = std::vector<std::pair<int, std::string>>;

/// A field is there only where another one, the selector, has one of these raw values.
struct FieldCondition {
  const char* selector = nullptr;  ///< nullptr: it is always there
  int low = 0, high = 0;
};

struct FrameField {
  std::string name;  ///< as DBC wants it: "FreeRecords"
  int start = 0;     ///< least significant bit first
  int bits = 0;
  bool is_signed = false;
  double factor = 1;  ///< raw value to `unit`
  std::string unit{};
  ValueNames values{};
  std::string comment{};
  FieldCondition when{};
  int shifted_axis = -1;  ///< the factor is for acceleration shift 2; doubles with each more of this axis
};

/// Empty: the object is no packed record.
std::vector<FrameField> record_fields(ObjectAddress address);
std::vector<FrameField> emcy_fields();
std::vector<FrameField> nmt_fields();
std::vector<FrameField> heartbeat_fields();
std::vector<FrameField> lss_fields();
/// Of 3FFh, protocol/motion/voucher.hpp.
std::vector<FrameField> voucher_fields();
/// Of 6060h and 6061h.
const ValueNames& mode_names();

/// An object's unit as the table has it, "0.1C", is a factor and what remains: {0.1, "C"}.
struct ScaledUnit {
  double factor = 1;
  std::string unit;
};
ScaledUnit scaled_unit(std::string_view unit);

/// As few digits as name this very number.
std::string decimal(double value);
/// "Modes of operation display" -> "ModesOfOperationDisplay".
std::string identifier(std::string_view name);

}  // namespace kinebus
