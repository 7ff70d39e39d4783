#pragma once
// A node with two CiA 402 axes, whatever board it is on: its PDOs, and all the units that it has.

#include "protocol/canopen/object_units.hpp"

namespace kinebus {

namespace object_table {

// The PDOs of an axis pair.
inline constexpr std::array<PdoDefault, kRpdoCount> kAxisPairRpdos{{
    {"Control",
     0x200,
     true,
     255,
     0,
     0,
     {mapped(object::kControlword, 16), mapped(object::kControlword, 16, 1),
      mapped(object::kModeOfOperation, 8), mapped(object::kModeOfOperation, 8, 1)}},
    {"Targets",
     0x300,
     true,
     1,
     0,
     0,
     {mapped(object::kTargetPosition, 32), mapped(object::kTargetPosition, 32, 1)}},
    {"Segment", 0x400, true, 255, 0, 0, {mapped(object::kSegmentRecord, 64)}},
    {"Checkpoint", 0x500, true, 255, 0, 0, {mapped(object::kCheckpoint, 64)}},
    {"Rate", kRateCobId, false, 255, 0, 0, {mapped(object::kRateCommand, 64)}},
    {"SyncStamp", kSyncStampCobId, false, 255, 0, 0, {mapped(object::kSyncStamp, 64)}},
}};
// TPDO1 and TPDO3 go by the device profile's event (a mapped value changed) or timer; TPDO2 when the stream
// says so.
inline constexpr std::array<PdoDefault, kTpdoCount> kAxisPairTpdos{{
    {"Status",
     0x180 | kNoRtr,
     true,
     255,
     100,
     1000,
     {mapped(object::kStatusword, 16), mapped(object::kStatusword, 16, 1), mapped(object::kModeDisplay, 8),
      mapped(object::kModeDisplay, 8, 1), mapped(object::kSwitchLevels, 8)}},
    {"Stream", 0x280 | kNoRtr, true, 254, 20, 0, {mapped(object::kStreamStatus, 64)}},
    {"Positions",
     0x380 | kNoRtr,
     true,
     254,
     100,
     0,
     {mapped(object::kPositionActual, 32), mapped(object::kPositionActual, 32, 1)}},
    {"FollowingErrors",
     0x480 | kNoRtr | kPdoOff,
     true,
     254,
     100,
     0,
     {mapped(object::kFollowingError, 32), mapped(object::kFollowingError, 32, 1)}},
}};
inline constexpr PdoSet kAxisPairPdos{kAxisPairRpdos, kAxisPairTpdos};

}  // namespace object_table

/// A board with such nodes says who it is: struct SomeBoard : TwoAxisNode<SomeBoard> { static constexpr
/// BoardFacts kFacts; };
template <typename Board>
struct TwoAxisNode {
  static constexpr std::uint32_t kDeviceType = 0xFFFF'0192;  ///< several CiA 402 axes: see 67FFh, 6FFFh
  static constexpr object_table::PdoSet kPdos = object_table::kAxisPairPdos;

  static constexpr void compose(object_table::Rows& t) {
    object_table::device(t, Board::kFacts, kPdos);
    object_table::program_download(t);
    object_table::stream(t);
    object_table::counters(t);
    object_table::switch_inputs(t);
    object_table::axis_pair(t);
    object_table::motors(t);
    object_table::linear_scales(t);
    object_table::touch_probes(t);
    object_table::last_reset(t);
    object_table::stepper_drivers(t);
    object_table::node_guarding(t);
  }
};

}  // namespace kinebus
