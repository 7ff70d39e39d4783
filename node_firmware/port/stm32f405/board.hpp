#pragma once
// The dual-stepper board: which pin of the STM32F405RG (LQFP64) goes where, and what the analogue parts make
// of volts and amperes. This header is the contract for whoever lays out or wires a board, and for the
// emulator. The README beside it describes the parts around it.

#include <array>
#include <cstdint>

#include "node_firmware/port/stm32/pin_table.hpp"
#include "node_firmware/port/stm32f4/clocks.hpp"

namespace kinebus::board {

inline constexpr std::uint32_t kCrystalHz = 8'000'000;
inline constexpr std::array kCrystals{kCrystalHz};
using stm32::kApb2Hz;
using stm32::kCoreHz;

using namespace stm32::pin_words;

// clang-format off
/// Where the board tells who it is, also to an image that is for another one: bus and console.
inline constexpr std::array kTalkingPins = {
  Pin{B,  8, kAlternate, kUp,    9, false, "CAN1_RX"},
  Pin{B,  9, kAlternate, kNone,  9, false, "CAN1_TX"},
  Pin{B,  6, kAlternate, kNone,  7, false, "USART1_TX console, 115200 8N1"},
  Pin{B,  7, kAlternate, kUp,    7, false, "USART1_RX console"},
};
inline constexpr std::array kPins = {
  // port, pin, mode,       pull,  AF, high,  signal
  // Motor A. One timer output per half-bridge: high is the upper MOSFET on, low the lower; the gate driver makes the
  // dead time. While the outputs float, which the card sees at CH1, all of the motor's MOSFETs are off.
  Pin{A,  8, kAlternate, kNone,  1, false, "TIM1_CH1  motor A phase A, half-bridge +"},
  Pin{A,  9, kAlternate, kNone,  1, false, "TIM1_CH2  motor A phase A, half-bridge -"},
  Pin{A, 10, kAlternate, kNone,  1, false, "TIM1_CH3  motor A phase B, half-bridge +"},
  Pin{A, 11, kAlternate, kNone,  1, false, "TIM1_CH4  motor A phase B, half-bridge -"},
  Pin{B, 12, kAlternate, kUp,    1, false, "TIM1_BKIN motor A over-current comparators, active low"},
  Pin{A,  4, kOutput,    kDown,  0, false, "enable of motor A's four gate drivers, active high"},
  // Motor B.
  Pin{C,  6, kAlternate, kNone,  3, false, "TIM8_CH1  motor B phase A, half-bridge +"},
  Pin{C,  7, kAlternate, kNone,  3, false, "TIM8_CH2  motor B phase A, half-bridge -"},
  Pin{C,  8, kAlternate, kNone,  3, false, "TIM8_CH3  motor B phase B, half-bridge +"},
  Pin{C,  9, kAlternate, kNone,  3, false, "TIM8_CH4  motor B phase B, half-bridge -"},
  Pin{A,  6, kAlternate, kUp,    3, false, "TIM8_BKIN motor B over-current comparators, active low"},
  Pin{A,  5, kOutput,    kDown,  0, false, "enable of motor B's four gate drivers, active high"},
  // Analogue. Shunts: in the line of each phase's + half-bridge, amplified about half the reference.
  Pin{A,  0, kAnalogue,  kNone,  0, false, "ADC123_IN0  current, motor A phase A"},
  Pin{A,  1, kAnalogue,  kNone,  0, false, "ADC123_IN1  current, motor A phase B"},
  Pin{A,  2, kAnalogue,  kNone,  0, false, "ADC123_IN2  current, motor B phase A"},
  Pin{A,  3, kAnalogue,  kNone,  0, false, "ADC123_IN3  current, motor B phase B"},
  Pin{C,  0, kAnalogue,  kNone,  0, false, "ADC123_IN10 supply voltage"},
  Pin{C,  1, kAnalogue,  kNone,  0, false, "ADC123_IN11 temperature of motor A's MOSFETs"},
  Pin{C,  2, kAnalogue,  kNone,  0, false, "ADC123_IN12 temperature of motor B's MOSFETs"},
  // Encoders: AS5047-type, one SPI each.
  Pin{B,  3, kAlternate, kNone,  5, false, "SPI1_SCK  encoder A"},
  Pin{B,  4, kAlternate, kUp,    5, false, "SPI1_MISO encoder A; pulled up: no encoder reads as parity error; or scale A"},
  Pin{B,  5, kAlternate, kNone,  5, false, "SPI1_MOSI encoder A; or scale A"},
  Pin{A, 15, kOutput,    kUp,    0, true,  "encoder A select, active low"},
  Pin{C, 10, kAlternate, kNone,  6, false, "SPI3_SCK  encoder B"},
  Pin{C, 11, kAlternate, kUp,    6, false, "SPI3_MISO encoder B"},
  Pin{C, 12, kAlternate, kNone,  6, false, "SPI3_MOSI encoder B"},
  Pin{D,  2, kOutput,    kUp,    0, true,  "encoder B select, active low"},
  // Switch inputs 1 to 7, each on its own EXTI line.
  Pin{B,  0, kInput,     kDown,  0, false, "switch input 1 (EXTI0)"},
  Pin{B,  1, kInput,     kDown,  0, false, "switch input 2 (EXTI1)"},
  Pin{C,  3, kInput,     kDown,  0, false, "switch input 3 (EXTI3)"},
  Pin{C,  4, kInput,     kDown,  0, false, "switch input 4 (EXTI4)"},
  Pin{C,  5, kInput,     kDown,  0, false, "switch input 5 (EXTI5)"},
  Pin{B, 10, kInput,     kDown,  0, false, "switch input 6 (EXTI10)"},
  Pin{B, 11, kInput,     kDown,  0, false, "switch input 7 (EXTI11)"},
  // Communication.
  Pin{B,  8, kAlternate, kUp,    9, false, "CAN1_RX"},
  Pin{B,  9, kAlternate, kNone,  9, false, "CAN1_TX"},
  Pin{B,  6, kAlternate, kNone,  7, false, "USART1_TX console, 115200 8N1; or scale B"},
  Pin{B,  7, kAlternate, kUp,    7, false, "USART1_RX console; or scale B"},
  Pin{B, 13, kInput,     kDown,  0, false, "VBUS of the USB connector, divided"},
  Pin{B, 14, kAlternate, kNone, 12, false, "OTG_HS_DM USB, full speed"},
  Pin{B, 15, kAlternate, kNone, 12, false, "OTG_HS_DP USB, full speed"},
  Pin{C, 14, kOutput,    kNone,  0, false, "system boot, ORed with BOOT0: USB to PA11, PA12 and no gate driver enabled"},
  Pin{C, 13, kOutput,    kNone,  0, true,  "status LED, active low"},
};
// clang-format on
static_assert(stm32::pins_differ(kPins));

inline constexpr std::array<SwitchPin, 7> kSwitchPins{
    {{B, 0}, {B, 1}, {C, 3}, {C, 4}, {C, 5}, {B, 10}, {B, 11}}};
static_assert(stm32::lines_differ(kSwitchPins));

inline constexpr std::array<OutputPin, 2> kDriverEnable{{{A, 4}, {A, 5}}};
inline constexpr std::array<OutputPin, 2> kEncoderSelect{{{A, 15}, {D, 2}}};
inline constexpr OutputPin kStatusLed{C, 13};
inline constexpr OutputPin kSystemBoot{C, 14};

inline constexpr InputPin kUsbVbus{B, 13};

/// A quadrature scale in the place of what the table has there, when 2160h:1 says so: channels 1 and 2 of a
/// timer. A: encoder A's MISO and MOSI (TIM3), so that motor A has no encoder then; B: the console's TX and
/// RX (TIM4), so that the console is on USB alone.
struct ScalePins {
  Port port;
  std::uint8_t first, second;
  std::uint8_t timer, usual;  ///< alternate functions
};
inline constexpr std::array<ScalePins, 2> kScalePins{{{B, 4, 5, 2, 5}, {B, 6, 7, 2, 7}}};

// Analogue: 12 bits at 3.3 V.
inline constexpr float kReferenceV = 3.3F;
inline constexpr float kAdcSteps = 4096.0F;
/// 10 mOhm and an amplifier of gain 20: 0.2 V/A about 1.65 V, so +-8.25 A. Positive: from half-bridge + to -.
inline constexpr float kCurrentVoltsPerAmpere = 0.2F;
inline constexpr std::uint16_t kCurrentZero = 2048;
inline constexpr float kAmperesPerStep = kReferenceV / kAdcSteps / kCurrentVoltsPerAmpere;
/// Window comparators on the same amplifiers pull the motor's break input low beyond this, within 200 ns.
inline constexpr float kBreakAmperes = 7.0F;
/// Supply divider 47 kOhm / 4.7 kOhm.
inline constexpr float kSupplyDivider = 11.0F;
inline constexpr float kSupplyVoltsPerStep = kReferenceV / kAdcSteps * kSupplyDivider;
/// NTC 10 kOhm, B 3435 K, to ground; 10 kOhm to 3.3 V: 2048 steps are 25 C, fewer are hotter.
inline constexpr float kNtcBeta = 3435.0F;
/// Both MOSFETs off so long at every edge (made by the gate driver).
inline constexpr float kDeadTimeS = 150e-9F;

/// Conversion slots of the injected group, taken at one instant each: ADC1 the phases A, ADC2 the phases B;
/// first motor A, then motor B.
inline constexpr std::array<std::uint8_t, 2> kPhaseAChannel{0, 2};
inline constexpr std::array<std::uint8_t, 2> kPhaseBChannel{1, 3};
/// Regular conversions of ADC3, one after another, one a control interrupt.
inline constexpr std::array<std::uint8_t, 3> kSlowChannels{10, 11, 12};  // supply, temperatures A, B

// Timing. TIM1 (motor A) and TIM8 (motor B) count up and down at 168 MHz: PWM 40 kHz; every second period
// (repetition counter 3) new compare values are taken and TIM1's update triggers the injected conversions,
// whose end is the control interrupt.
inline constexpr std::uint32_t kPwmHz = 40'000;
inline constexpr std::uint32_t kControlHz = 20'000;
inline constexpr std::uint32_t kPwmTop = kCoreHz / 2 / kPwmHz;  // ARR = 2100
inline constexpr std::uint32_t kPwmRepetition = 2 * (kPwmHz / kControlHz) - 1;
/// TIM8 lags so many counts, a conversion's time: motor B's quiet moment is when its slot samples.
inline constexpr std::uint32_t kMotorBLag = 216;

// Flash: boot loader in sectors 0 and 1, parameters in 2 and 3, program in 5 and 6.
inline constexpr std::uint32_t kBootAddress = 0x0800'0000, kBootBytes = 0x8000;
inline constexpr std::array<stm32::FlashSector, 2> kParameterSectors{{{0x0800'8000, 2}, {0x0800'C000, 3}}};
inline constexpr std::uint32_t kParameterPageBytes = 0x4000;
inline constexpr std::uint32_t kProgramAddress = 0x0802'0000, kProgramBytes = 0x4'0000;
inline constexpr std::array<stm32::FlashSector, 2> kProgramSectors{{{0x0802'0000, 5}, {0x0804'0000, 6}}};

}  // namespace kinebus::board
