#pragma once
// BTT EBB36 and EBB42 CAN, v1.1 and v1.2, with an STM32G0B1CBT6: which pin goes where. The maker's schematics
// are the source; the emulator reads the same header.

#include <array>
#include <cstddef>
#include <cstdint>

#include "node_firmware/port/stm32/pin_table.hpp"

namespace kinebus::ebb {

using namespace stm32::pin_words;

/// The hot end's MOSFET: PA2 on v1.1, PB13 on v1.2. The other one of the two is held low, whatever hangs on
/// it.
#ifdef KINEBUS_EBB_V1_1
inline constexpr OutputPin kHeater{A, 2}, kOtherHeater{B, 13};
#else
inline constexpr OutputPin kHeater{B, 13}, kOtherHeater{A, 2};
#endif

// clang-format off
/// The bus, by which the board tells who it is, also to an image that is for another chip.
inline constexpr std::array kBusPins = {
  // port, pin, mode,       pull,  AF, high,  signal
  Pin{B,  0, kAlternate, kUp,    3, false, "FDCAN2_RX"},
  Pin{B,  1, kAlternate, kNone,  3, false, "FDCAN2_TX"},
};
inline constexpr std::array kPins = {
  // port, pin, mode,       pull,  AF, high,  signal
  Pin{B,  0, kAlternate, kUp,    3, false, "FDCAN2_RX"},
  Pin{B,  1, kAlternate, kNone,  3, false, "FDCAN2_TX"},
  // The extruder's driver, a TMC2209 on the board: axis A.
  Pin{D,  0, kOutput,    kNone,  0, false, "step"},
  Pin{D,  1, kOutput,    kNone,  0, false, "direction"},
  Pin{D,  2, kOutput,    kUp,    0, true,  "enable, active low"},
  Pin{A, 15, kAlternate, kUp,    1, false, "driver's UART, open drain (USART2_RX)"},
  // Hot end and fans.
  Pin{B, 13, kOutput,    kDown,  0, false, "heater of v1.2"},
  Pin{A,  2, kOutput,    kDown,  0, false, "heater of v1.1"},
  Pin{A,  0, kOutput,    kDown,  0, false, "FAN1"},
  Pin{A,  1, kOutput,    kDown,  0, false, "FAN2"},
  Pin{A,  3, kAnalogue,  kNone,  0, false, "TH0 (ADC channel 3), 4.7 kOhm to 3.3 V"},
  // Switch inputs 1 to 3: a contact to ground, pulled up.
  Pin{B,  8, kInput,     kUp,    0, false, "PROBE, switch input 1 (EXTI8)"},
  Pin{B,  4, kInput,     kUp,    0, false, "ENDSTOP PB4, switch input 2 (EXTI4): filament"},
  Pin{B,  3, kInput,     kUp,    0, false, "ENDSTOP PB3, switch input 3 (EXTI3)"},
  // What this image does not drive: off, or deselected.
  Pin{B,  9, kOutput,    kDown,  0, false, "PROBE servo"},
  Pin{A,  4, kOutput,    kUp,    0, true,  "MAX31865 select, active low"},
  Pin{B, 12, kOutput,    kUp,    0, true,  "ADXL345 select, active low"},
  Pin{D,  3, kOutput,    kDown,  0, false, "RGB"},
};
// What the program of the axis has otherwise, once its timers hold both low.
inline constexpr std::array kAxisPins = {
  Pin{D,  0, kAlternate, kNone,  2, false, "step (TIM16_CH1)"},
  Pin{D,  1, kAlternate, kNone,  2, false, "direction (TIM17_CH1)"},
};
// What the program of the heat node has otherwise.
inline constexpr std::array kHeatPins = {
  Pin{B,  9, kAlternate, kDown,  2, false, "PROBE servo (TIM17_CH1)"},
  Pin{B, 10, kAlternate, kNone,  5, false, "ADXL345 SCK (SPI2)"},
  Pin{B,  2, kAlternate, kUp,    1, false, "ADXL345 MISO (SPI2)"},
  Pin{B, 11, kAlternate, kNone,  0, false, "ADXL345 MOSI (SPI2)"},
  Pin{A,  5, kAlternate, kNone,  0, false, "MAX31865 SCK (SPI1)"},
  Pin{A,  6, kAlternate, kUp,    0, false, "MAX31865 MISO (SPI1)"},
  Pin{A,  7, kAlternate, kNone,  0, false, "MAX31865 MOSI (SPI1)"},
  Pin{A, 15, kInput,     kUp,    0, false, "driver's UART, not used: at rest"},
};
// clang-format on
static_assert(stm32::pins_differ(kPins));

inline constexpr std::array<SwitchPin, 3> kSwitchPins{{{B, 8}, {B, 4}, {B, 3}}};
static_assert(stm32::lines_differ(kSwitchPins));

inline constexpr OutputPin kStep{D, 0}, kDirection{D, 1}, kEnable{D, 2}, kDriverWire{A, 15};
inline constexpr std::array<OutputPin, 2> kFans{{{A, 0}, {A, 1}}};

/// The ADXL345's select line, low.
inline constexpr OutputPin kAccelerometer{B, 12};
/// The MAX31865's, low.
inline constexpr OutputPin kResistanceConverter{A, 4};
/// ADC input of the thermistor.
inline constexpr unsigned kThermistor = 3;
/// Which of kSwitchPins: the line of a probe with a pin, and the heat node's filament sensors.
inline constexpr std::uint8_t kProbe = 0;
inline constexpr std::array<std::uint8_t, 2> kFilamentInputs{1, 2};

/// Everything that gives power to something, and its level without.
struct PowerPin {
  OutputPin pin;
  bool off;
};
inline constexpr std::array kPowerPins{PowerPin{kEnable, true}, PowerPin{kHeater, false},
                                       PowerPin{kOtherHeater, false}, PowerPin{kFans[0], false},
                                       PowerPin{kFans[1], false}};

/// 16 microsteps a full step of 256 counts, as the driver is told: log2 of counts a step.
inline constexpr int kStepBits = 4;

// Flash of 128 KiB, one bank of 64 pages: the boot loader at its start, the program, then its parameters.
inline constexpr std::uint32_t kFlashAddress = 0x0800'0000, kPageBytes = 2048, kFlashPages = 64;
struct Pages {
  unsigned first = 0, count = 0;
  constexpr std::uint32_t address() const { return kFlashAddress + first * kPageBytes; }
  constexpr std::uint32_t bytes() const { return count * kPageBytes; }
  constexpr unsigned end() const { return first + count; }
};
inline constexpr Pages kBootPages{0, 8}, kProgramPages{8, 50};
inline constexpr std::array<Pages, 2> kParameterPages{{{58, 3}, {61, 3}}};
static_assert(kProgramPages.first == kBootPages.end() && kParameterPages[0].first == kProgramPages.end() &&
              kParameterPages[1].first == kParameterPages[0].end() &&
              kParameterPages[1].end() == kFlashPages);

}  // namespace kinebus::ebb
