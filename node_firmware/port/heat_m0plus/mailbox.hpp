#pragma once
// How the heat core's image of a Cortex-M0+ is asked for work, and what it then says: who runs it writes the
// inputs into its memory and takes its outputs from there. Times are counted from `go` to `done`.

#include <array>
#include <cstdint>

#include "protocol/canopen/heat_units.hpp"

namespace kinebus::heat_m0plus {

/// Two registers that no chip has: reading the first gives the work to do, writing the second ends it.
inline constexpr std::uint32_t kWorkRegister = 0x4000'0000, kDoneRegister = 0x4000'0004;

enum class Work : std::uint32_t {
  kNone,
  kSamples,  ///< of all sensors, the fans' tachos, filament: every SensorInput::kSamplePeriod
  kTime,     ///< HeatNode::on_time
  kFrame,    ///< a frame is heard
  kAnswer,   ///< the next frame to send, if there is one
};

/// Words and bytes only, in this order: the image's `mailbox` as another processor sees it.
struct Mailbox {
  std::uint32_t now_us = 0;
  std::array<std::uint32_t, kHeatSensors> ratios{};
  std::uint32_t frame_id = 0, frame_length = 0;
  std::array<std::uint8_t, 8> frame_data{};
  std::array<std::uint32_t, kHeaters> power{};
};

}  // namespace kinebus::heat_m0plus
