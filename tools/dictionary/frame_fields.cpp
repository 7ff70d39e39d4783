#include "tools/dictionary/frame_fields.hpp"

#include <charconv>
#include <iterator>

#include "protocol/canopen/cia402.hpp"
#include "protocol/canopen/lss.hpp"
#include "protocol/canopen/nmt.hpp"
#include "protocol/canopen/object_addresses.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/motion/segment.hpp"

namespace kinebus {
namespace {

const ValueNames& axis_names() {
  static const ValueNames names{{0, "A"}, {1, "B"}};
  return names;
}

/// counts/s2 of one raw unit of a segment's acceleration at the default shift.
constexpr double acceleration_unit() {
  constexpr double unit_s = 16e-6;
  return (std::uint64_t{1} << (kDefaultAccelerationShift + 1)) / 4294967296.0 / (unit_s * unit_s);
}

std::vector<FrameField> segment_fields() {
  const FieldCondition motion{"Duration", 1, kMaxSegmentUnits}, control{"Duration", 0, 0};
  const std::string shift = "for acceleration shift 2 (2140h:1); doubles with each more";
  return {
      {"Sequence", 0, 7},
      {.name = "Duration",
       .start = 7,
       .bits = 13,
       .factor = 16,
       .unit = "us",
       .comment = "0: control record"},
      {"Acceleration_A", 20, 22, true, acceleration_unit(), "counts/s2", {}, shift, motion, 0},
      {"Acceleration_B", 42, 22, true, acceleration_unit(), "counts/s2", {}, shift, motion, 1},
      {.name = "Control",
       .start = 20,
       .bits = 2,
       .values = {{static_cast<int>(SegmentControl::kStart), "start"},
                  {static_cast<int>(SegmentControl::kEnd), "end"}},
       .when = control},
      {.name = "Start",
       .start = 22,
       .bits = 39,
       .factor = 16,
       .unit = "us",
       .comment = "path time at which the records that follow begin",
       .when = {"Control", static_cast<int>(SegmentControl::kStart),
                static_cast<int>(SegmentControl::kStart)}},
      {.name = "RecordCheck",
       .start = 61,
       .bits = 3,
       .comment = "control_check() in protocol/motion/segment.hpp",
       .when = control},
  };
}

std::vector<FrameField> stream_status_fields() {
  const FieldCondition plain{"Checked", 0, 0}, checked{"Checked", 1, 1};
  std::vector<FrameField> fields{
      {"NextSequence", 0, 7},
      {.name = "Checked", .start = 7, .bits = 1, .comment = "with a check of the tail: 2119h"},
      {"FreeRecords", 8, 8}};
  const std::pair<const char*, std::uint8_t> flags[] = {
      {"Running", StreamStatus::kRunning},           {"AtRest", StreamStatus::kAtRest},
      {"Stopped", StreamStatus::kStopped},           {"SequenceError", StreamStatus::kSequenceError},
      {"Underrun", StreamStatus::kUnderrun},         {"CheckpointError", StreamStatus::kCheckpointError},
      {"Synchronised", StreamStatus::kSynchronised}, {"Reordered", StreamStatus::kReordered}};
  for (const auto& [name, flag] : flags) {
    int bit = 0;
    while (flag >> bit != 1) ++bit;
    fields.push_back({name, 16 + bit, 1});
  }
  fields.push_back(
      {.name = "SyncError", .start = 24, .bits = 8, .unit = "us", .comment = "bound; 255: that or more"});
  fields.push_back({.name = "PathTime", .start = 32, .bits = 32, .factor = 16, .unit = "us", .when = plain});
  fields.push_back({.name = "PathTimeLow",
                    .start = 32,
                    .bits = 24,
                    .factor = 16,
                    .unit = "us",
                    .comment = "its low 24 bits",
                    .when = checked});
  fields.push_back({.name = "TailCheck",
                    .start = 56,
                    .bits = 8,
                    .comment = "protocol/motion/tail_check.hpp",
                    .when = checked});
  return fields;
}

}  // namespace

std::vector<FrameField> record_fields(ObjectAddress address) {
  const std::string check = "check_bits() in protocol/motion/broadcast.hpp";
  switch (address.key()) {
    case object::kSegmentRecord.key():
      return segment_fields();
    case object::kCheckpoint.key():
      return {{"Sequence", 0, 7},
              {.name = "Axis", .start = 7, .bits = 1, .values = axis_names()},
              {"Position", 8, 56, true, 1.0 / (1 << 24), "counts"}};
    case object::kStreamStatus.key():
      return stream_status_fields();
    case object::kRateCommand.key():
      return {{"Counter", 0, 4},
              {.name = "Kind",
               .start = 4,
               .bits = 4,
               .values = {{static_cast<int>(RateCommand::Kind::kRate), "rate"},
                          {static_cast<int>(RateCommand::Kind::kStop), "stop"},
                          {static_cast<int>(RateCommand::Kind::kClear), "clear"},
                          {static_cast<int>(RateCommand::Kind::kSmooth), "smooth"}}},
              {.name = "Rate", .start = 8, .bits = 16, .factor = 1.0 / kFullRateQ15},
              {.name = "FullRamp",
               .start = 24,
               .bits = 8,
               .factor = 2,
               .unit = "ms",
               .comment = "for a change of the rate by 1.0; smooth: each half of it, for any"},
              {.name = "Start", .start = 32, .bits = 24, .unit = "us", .comment = "bus time, low 24 bits"},
              {.name = "Check", .start = 56, .bits = 8, .comment = check}};
    case object::kSyncStamp.key():
      return {{.name = "Counter", .start = 0, .bits = 8, .comment = "of the SYNC that is stamped"},
              {"Epoch", 8, 8},
              {.name = "Nanoseconds", .start = 16, .bits = 10, .unit = "ns"},
              {.name = "Check", .start = 26, .bits = 6, .comment = check},
              {.name = "Microseconds",
               .start = 32,
               .bits = 32,
               .unit = "us",
               .comment = "bus time, low 32 bits"}};
    default:
      return {};
  }
}

std::vector<FrameField> emcy_fields() {
  return {{"ErrorCode", 0, 16},
          {"ErrorRegister", 16, 8},
          {.name = "StopReason", .start = 24, .bits = 7, .comment = "0: no stop asked for"},
          {.name = "StopAxis", .start = 31, .bits = 1, .values = axis_names()},
          {.name = "StopStart", .start = 32, .bits = 24, .unit = "us", .comment = "bus time, low 24 bits"},
          {.name = "StopCheck", .start = 56, .bits = 8, .comment = "of the stop asked for"}};
}

std::vector<FrameField> nmt_fields() {
  const auto number = [](NmtCommand command) { return static_cast<int>(command); };
  return {{.name = "Command",
           .start = 0,
           .bits = 8,
           .values = {{number(NmtCommand::kStart), "start"},
                      {number(NmtCommand::kStop), "stop"},
                      {number(NmtCommand::kEnterPreOperational), "enter pre-operational"},
                      {number(NmtCommand::kResetNode), "reset node"},
                      {number(NmtCommand::kResetCommunication), "reset communication"}}},
          {.name = "Node", .start = 8, .bits = 8, .comment = "0: all"}};
}

std::vector<FrameField> heartbeat_fields() {
  const auto number = [](NmtState state) { return static_cast<int>(state); };
  return {{.name = "NmtState",
           .start = 0,
           .bits = 8,
           .values = {{number(NmtState::kInitialising), "boot-up"},
                      {number(NmtState::kStopped), "stopped"},
                      {number(NmtState::kOperational), "operational"},
                      {number(NmtState::kPreOperational), "pre-operational"}}}};
}

std::vector<FrameField> voucher_fields() {
  return {{.name = "Number", .start = 0, .bits = 16, .comment = "its low 16 bits; it only rises"},
          {.name = "CheckValue",
           .start = 16,
           .bits = 48,
           .comment = "SipHash-2-4 over number and the frame that follows"}};
}

std::vector<FrameField> lss_fields() {
  return {
      {.name = "Command",
       .start = 0,
       .bits = 8,
       .values = {{lss::kSwitchGlobal, "switch state global"},
                  {lss::kConfigureNodeId, "configure node id"},
                  {lss::kConfigureBitTiming, "configure bit timing"},
                  {lss::kActivateBitTiming, "activate bit timing"},
                  {lss::kStore, "store configuration"},
                  {lss::kSelectVendor, "select vendor"},
                  {lss::kSelectProduct, "select product code"},
                  {lss::kSelectRevision, "select revision"},
                  {lss::kSelectSerial, "select serial number"},
                  {lss::kSelected, "selected"},
                  {lss::kIdentifyVendor, "identify vendor"},
                  {lss::kIdentifyProduct, "identify product code"},
                  {lss::kIdentifyRevisionLow, "identify revision, lowest"},
                  {lss::kIdentifyRevisionHigh, "identify revision, highest"},
                  {lss::kIdentifySerialLow, "identify serial number, lowest"},
                  {lss::kIdentifySerialHigh, "identify serial number, highest"},
                  {lss::kIdentifyUnconfigured, "identify unconfigured"},
                  {lss::kIdentified, "identified"},
                  {lss::kIdentifiedUnconfigured, "unconfigured is there"},
                  {lss::kFastscan, "fastscan"},
                  {lss::kInquireVendor, "inquire vendor"},
                  {lss::kInquireVendor + 1, "inquire product code"},
                  {lss::kInquireVendor + 2, "inquire revision"},
                  {lss::kInquireVendor + 3, "inquire serial number"},
                  {lss::kInquireNodeId, "inquire node id"}}},
      {"Value", 8, 32},
      {.name = "BitCheck", .start = 40, .bits = 8, .comment = "fastscan: bits 31 to this one are compared"},
      {.name = "Part", .start = 48, .bits = 8, .comment = "fastscan: 0 vendor .. 3 serial number"},
      {.name = "NextPart", .start = 56, .bits = 8, .comment = "fastscan: to be compared next"}};
}

const ValueNames& mode_names() {
  using cia402::Mode;
  static const ValueNames names{
      {static_cast<int>(Mode::kNone), "none"},
      {static_cast<int>(Mode::kProfilePosition), "profile position"},
      {static_cast<int>(Mode::kProfileVelocity), "profile velocity"},
      {static_cast<int>(Mode::kHoming), "homing"},
      {static_cast<int>(Mode::kInterpolatedPosition), "interpolated position"},
      {static_cast<int>(Mode::kCyclicSynchronousPosition), "cyclic synchronous position"}};
  return names;
}

ScaledUnit scaled_unit(std::string_view unit) {
  static constexpr struct {
    std::string_view written;
    double factor;
    const char* unit;
  } kScaled[] = {{"2^-32 counts", 0x1p-32, "counts"},
                 {"2^-20", 0x1p-20, ""},
                 {"1/16us", 0.0625, "us"},
                 {"1e-6/s", 1e-6, "1/s"},
                 {"1/1000", 1e-3, ""},
                 {"100us", 100, "us"},
                 {"10mW", 10, "mW"},
                 {"0.1C", 0.1, "C"},
                 {"0.1K", 0.1, "K"},
                 {"0.1%", 0.1, "%"},
                 {"0.1s", 0.1, "s"}};
  for (const auto& scaled : kScaled)
    if (scaled.written == unit) return {scaled.factor, scaled.unit};
  return {1, std::string(unit)};
}

std::string decimal(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, std::end(digits), value).ptr};
}

std::string identifier(std::string_view name) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  // As C has it, none begins with a digit; the point of a number is no end of a word.
  std::string result = !name.empty() && is_digit(name.front()) ? "_" : "";
  bool capital = true;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (c == '.' && i > 0 && is_digit(name[i - 1])) {
      result += '_';
      continue;
    }
    if (!letter && !is_digit(c)) {
      capital = true;
      continue;
    }
    result += capital && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    capital = false;
  }
  return result;
}

}  // namespace kinebus
