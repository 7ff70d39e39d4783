#pragma once
// BTT Octopus v1.0 and v1.1 with an STM32F446ZE: which pin goes where. The maker's schematic is the source;
// the emulator reads the same header.

#include <array>
#include <cstddef>
#include <cstdint>

#include "node_firmware/port/stm32/pin_table.hpp"
#include "node_firmware/port/stm32f4/clocks.hpp"

namespace kinebus::octopus {

/// Crystals of the boards: 12 MHz beside the F446, 8 MHz on some. The program finds out which.
inline constexpr std::array<std::uint32_t, 2> kCrystals{12'000'000, 8'000'000};

using namespace stm32::pin_words;

// clang-format off
/// The bus, by which the board tells who it is, also to an image that is for another chip.
inline constexpr std::array kBusPins = {
  // port, pin, mode,       pull,  AF, high,  signal
  Pin{D,  0, kAlternate, kUp,    9, false, "CAN1_RX"},
  Pin{D,  1, kAlternate, kNone,  9, false, "CAN1_TX"},
};
inline constexpr std::array kPins = {
  // port, pin, mode,       pull,  AF, high,  signal
  Pin{D,  0, kAlternate, kUp,    9, false, "CAN1_RX"},
  Pin{D,  1, kAlternate, kNone,  9, false, "CAN1_TX"},
  // Drivers: step, direction, enable (active low), UART or select. Two for each node, its axes A and B, in order.
  Pin{F, 13, kOutput,    kNone,  0, false, "MOTOR0 step"},
  Pin{F, 12, kOutput,    kNone,  0, false, "MOTOR0 direction"},
  Pin{F, 14, kOutput,    kUp,    0, true,  "MOTOR0 enable, active low"},
  Pin{C,  4, kOutput,    kUp,    0, true,  "MOTOR0 UART, open drain, or SPI select"},
  Pin{G,  0, kOutput,    kNone,  0, false, "MOTOR1 step"},
  Pin{G,  1, kOutput,    kNone,  0, false, "MOTOR1 direction"},
  Pin{F, 15, kOutput,    kUp,    0, true,  "MOTOR1 enable, active low"},
  Pin{D, 11, kOutput,    kUp,    0, true,  "MOTOR1 UART, open drain, or SPI select"},
  Pin{F, 11, kOutput,    kNone,  0, false, "MOTOR2 step"},
  Pin{G,  3, kOutput,    kNone,  0, false, "MOTOR2 direction"},
  Pin{G,  5, kOutput,    kUp,    0, true,  "MOTOR2 enable, active low"},
  Pin{C,  6, kOutput,    kUp,    0, true,  "MOTOR2 UART, open drain, or SPI select"},
  Pin{G,  4, kOutput,    kNone,  0, false, "MOTOR3 step"},
  Pin{C,  1, kOutput,    kNone,  0, false, "MOTOR3 direction"},
  Pin{A,  0, kOutput,    kUp,    0, true,  "MOTOR3 enable, active low"},
  Pin{C,  7, kOutput,    kUp,    0, true,  "MOTOR3 UART, open drain, or SPI select"},
  Pin{F,  9, kOutput,    kNone,  0, false, "MOTOR4 step"},
  Pin{F, 10, kOutput,    kNone,  0, false, "MOTOR4 direction"},
  Pin{G,  2, kOutput,    kUp,    0, true,  "MOTOR4 enable, active low"},
  Pin{F,  2, kOutput,    kUp,    0, true,  "MOTOR4 UART, open drain, or SPI select"},
  Pin{C, 13, kOutput,    kNone,  0, false, "MOTOR5 step"},
  Pin{F,  0, kOutput,    kNone,  0, false, "MOTOR5 direction"},
  Pin{F,  1, kOutput,    kUp,    0, true,  "MOTOR5 enable, active low"},
  Pin{E,  4, kOutput,    kUp,    0, true,  "MOTOR5 UART, open drain, or SPI select"},
  Pin{E,  2, kOutput,    kNone,  0, false, "MOTOR6 step"},
  Pin{E,  3, kOutput,    kNone,  0, false, "MOTOR6 direction"},
  Pin{D,  4, kOutput,    kUp,    0, true,  "MOTOR6 enable, active low"},
  Pin{E,  1, kOutput,    kUp,    0, true,  "MOTOR6 UART, open drain, or SPI select"},
  Pin{E,  6, kOutput,    kNone,  0, false, "MOTOR7 step"},
  Pin{A, 14, kOutput,    kNone,  0, false, "MOTOR7 direction (SWCLK: no debugger from here on)"},
  Pin{E,  0, kOutput,    kUp,    0, true,  "MOTOR7 enable, active low"},
  Pin{D,  3, kOutput,    kUp,    0, true,  "MOTOR7 UART, open drain, or SPI select"},
  // SPI of all drivers that have one; a driver's UART wire is its select then.
  Pin{A,  5, kAlternate, kNone,  5, false, "SPI1_SCK to the drivers"},
  Pin{A,  6, kAlternate, kUp,    5, false, "SPI1_MISO"},
  Pin{A,  7, kAlternate, kNone,  5, false, "SPI1_MOSI"},
  // Switch inputs: a contact to ground, pulled up. Which node has which: kInputPlaces.
  Pin{G,  6, kInput,     kUp,    0, false, "STOP0 (EXTI6)"},
  Pin{G,  9, kInput,     kUp,    0, false, "STOP1 (EXTI9)"},
  Pin{G, 10, kInput,     kUp,    0, false, "STOP2 (EXTI10)"},
  Pin{G, 11, kInput,     kUp,    0, false, "STOP3 (EXTI11)"},
  Pin{G, 12, kInput,     kUp,    0, false, "STOP4 (EXTI12)"},
  Pin{G, 13, kInput,     kUp,    0, false, "STOP5 (EXTI13)"},
  Pin{G, 14, kInput,     kUp,    0, false, "STOP6 (EXTI14)"},
  Pin{G, 15, kInput,     kUp,    0, false, "STOP7 (EXTI15)"},
  Pin{B,  7, kInput,     kUp,    0, false, "PROBE (EXTI7)"},
  // Thermistors to ground, 4.7 kOhm to 3.3 V.
  Pin{F,  3, kAnalogue,  kNone,  0, false, "TB, bed (ADC3_IN9)"},
  Pin{F,  4, kAnalogue,  kNone,  0, false, "T0 (ADC3_IN14)"},
  Pin{F,  5, kAnalogue,  kNone,  0, false, "T1 (ADC3_IN15)"},
  Pin{F,  6, kAnalogue,  kNone,  0, false, "T2 (ADC3_IN4)"},
  Pin{F,  7, kAnalogue,  kNone,  0, false, "T3 (ADC3_IN5)"},
  // Heaters and fans.
  Pin{A,  1, kOutput,    kDown,  0, false, "bed heater"},
  Pin{A,  2, kOutput,    kDown,  0, false, "HE0"},
  Pin{A,  3, kOutput,    kDown,  0, false, "HE1"},
  Pin{B, 10, kOutput,    kDown,  0, false, "HE2"},
  Pin{B, 11, kOutput,    kDown,  0, false, "HE3"},
  Pin{A,  8, kOutput,    kDown,  0, false, "FAN0"},
  Pin{E,  5, kOutput,    kDown,  0, false, "FAN1"},
  Pin{D, 12, kOutput,    kDown,  0, false, "FAN2"},
  Pin{D, 13, kOutput,    kDown,  0, false, "FAN3"},
  Pin{D, 14, kOutput,    kDown,  0, false, "FAN4"},
  Pin{D, 15, kOutput,    kDown,  0, false, "FAN5"},
  // The servo of a BLTouch; its line comes to PROBE.
  Pin{B,  6, kAlternate, kDown,  2, false, "servo (TIM4_CH1)"},
  Pin{E, 11, kOutput,    kDown,  0, false, "PS-ON: the heaters' supply, high: on"},
  // USB-C socket; its VBUS leads to no pin.
  Pin{A, 11, kAlternate, kNone, 10, false, "OTG_FS_DM"},
  Pin{A, 12, kAlternate, kNone, 10, false, "OTG_FS_DP"},
};
// clang-format on
static_assert(stm32::pins_differ(kPins));

/// STOP0 to STOP7, and the probe.
inline constexpr std::array<SwitchPin, 9> kSwitchPins{
    {{G, 6}, {G, 9}, {G, 10}, {G, 11}, {G, 12}, {G, 13}, {G, 14}, {G, 15}, {B, 7}}};
static_assert(stm32::lines_differ(kSwitchPins));

/// Axis pairs, each a node: two drivers each, in order. The heat node comes behind them.
inline constexpr std::size_t kNodes = 4, kHeatNode = kNodes;
inline constexpr std::size_t kStops = 8, kProbe = 8;
/// Which of a node's inputs (counted from 0; -1: none) each switch pin is. Inputs 1 and 2 are the stops
/// beside the node's two drivers, where StallGuard's DIAG comes, too; 3 to 6 the next stops, round the board;
/// 7 is the probe, for each node.
inline constexpr auto kInputPlaces = [] {
  std::array<std::array<std::int8_t, kSwitchPins.size()>, kNodes> places{};
  for (std::size_t node = 0; node < kNodes; ++node) {
    for (std::size_t stop = 0; stop < kStops; ++stop) {
      const std::size_t input = (stop + kStops - 2 * node) % kStops;
      places[node][stop] = input < 6 ? static_cast<std::int8_t>(input) : std::int8_t{-1};
    }
    places[node][kProbe] = 6;
  }
  return places;
}();

struct DriverPins {
  OutputPin step, direction, enable, uart;
};
inline constexpr std::array<DriverPins, 2 * kNodes> kDrivers{{{{F, 13}, {F, 12}, {F, 14}, {C, 4}},
                                                              {{G, 0}, {G, 1}, {F, 15}, {D, 11}},
                                                              {{F, 11}, {G, 3}, {G, 5}, {C, 6}},
                                                              {{G, 4}, {C, 1}, {A, 0}, {C, 7}},
                                                              {{F, 9}, {F, 10}, {G, 2}, {F, 2}},
                                                              {{C, 13}, {F, 0}, {F, 1}, {E, 4}},
                                                              {{E, 2}, {E, 3}, {D, 4}, {E, 1}},
                                                              {{E, 6}, {A, 14}, {E, 0}, {D, 3}}}};
/// Everything that gives power to something, and its level without.
struct PowerPin {
  OutputPin pin;
  bool off;
};
inline constexpr std::array kPowerPins{
    PowerPin{{F, 14}, true}, PowerPin{{F, 15}, true}, PowerPin{{G, 5}, true},  PowerPin{{A, 0}, true},
    PowerPin{{G, 2}, true},  PowerPin{{F, 1}, true},  PowerPin{{D, 4}, true},  PowerPin{{E, 0}, true},
    PowerPin{{A, 1}, false}, PowerPin{{A, 2}, false}, PowerPin{{A, 3}, false}, PowerPin{{B, 10}, false},
    PowerPin{{B, 11}, false}};

// The heat node's channels in order, the node's numbers from 1 on. HE3 has none: it stays off.
struct ThermistorPin {
  InputPin pin;
  std::uint8_t channel;  ///< of ADC3
};
/// T0, TB, T1, T2, T3.
inline constexpr std::array<ThermistorPin, 5> kThermistors{
    {{{F, 4}, 14}, {{F, 3}, 9}, {{F, 5}, 15}, {{F, 6}, 4}, {{F, 7}, 5}}};
/// HE0, bed, HE1, HE2.
inline constexpr std::array<OutputPin, 4> kHeaterPins{{{A, 2}, {A, 1}, {A, 3}, {B, 10}}};
/// FAN0 to FAN5.
inline constexpr std::array<OutputPin, 6> kFanPins{{{A, 8}, {E, 5}, {D, 12}, {D, 13}, {D, 14}, {D, 15}}};
inline constexpr OutputPin kContactorPin{E, 11};
/// Switch pins that are the filament sensors, too: STOP4 and STOP5.
inline constexpr std::array<std::uint8_t, 2> kFilamentInputs{4, 5};

/// 16 microsteps a full step of 256 counts, as drivers are told, and as both MS jumpers of a TMC2209 that
/// stands alone choose: log2 of counts a step.
inline constexpr int kStepBits = 4;

// Flash: the maker's boot loader in sectors 0 and 1, or a copy of the vectors of ours; ours in 2 and 3; the
// program in 5 and 6; parameters in 7 and 4. What comes by the SD card ends with the program and erases 4:
// the page in which the newest parameters are later.
inline constexpr std::uint32_t kBootAddress = 0x0800'8000, kBootBytes = 0x8000;
inline constexpr std::array<stm32::FlashSector, 2> kParameterSectors{{{0x0806'0000, 7}, {0x0801'0000, 4}}};
/// Room for the parameters of all nodes, twice.
inline constexpr std::uint32_t kParameterPageBytes = 0x1'0000;
inline constexpr std::uint32_t kProgramAddress = 0x0802'0000, kProgramBytes = 0x4'0000;
inline constexpr std::array<stm32::FlashSector, 2> kProgramSectors{{{0x0802'0000, 5}, {0x0804'0000, 6}}};

}  // namespace kinebus::octopus
