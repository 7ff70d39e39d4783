#pragma once
// BTT Octopus v1.0 and v1.1 with an STM32F446ZE: which pin goes where. The maker's schematic is the source;
// the emulator reads the same header.

#include <array>
#include <cstddef>
#include <cstdint>

#include "node_firmware/port/stm32f4/clocks.hpp"
#include "node_firmware/port/stm32f4/pin_table.hpp"

namespace kinebus::octopus {

/// Crystals of the boards: 12 MHz beside the F446; 8 MHz beside other chips of the same maker.
#ifdef KINEBUS_OCTOPUS_CRYSTAL_HZ
inline constexpr std::uint32_t kCrystalHz = KINEBUS_OCTOPUS_CRYSTAL_HZ;
#else
inline constexpr std::uint32_t kCrystalHz = 12'000'000;
#endif
static_assert(kCrystalHz == 12'000'000 || kCrystalHz == 8'000'000);

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
  // Drivers: step, direction, enable (active low). MOTOR0 is axis A, MOTOR1 axis B.
  Pin{F, 13, kOutput,    kNone,  0, false, "MOTOR0 step"},
  Pin{F, 12, kOutput,    kNone,  0, false, "MOTOR0 direction"},
  Pin{F, 14, kOutput,    kUp,    0, true,  "MOTOR0 enable, active low"},
  Pin{G,  0, kOutput,    kNone,  0, false, "MOTOR1 step"},
  Pin{G,  1, kOutput,    kNone,  0, false, "MOTOR1 direction"},
  Pin{F, 15, kOutput,    kUp,    0, true,  "MOTOR1 enable, active low"},
  // Sockets that this image does not drive: off.
  Pin{G,  5, kOutput,    kUp,    0, true,  "MOTOR2 enable, active low"},
  Pin{A,  0, kOutput,    kUp,    0, true,  "MOTOR3 enable, active low"},
  Pin{G,  2, kOutput,    kUp,    0, true,  "MOTOR4 enable, active low"},
  Pin{F,  1, kOutput,    kUp,    0, true,  "MOTOR5 enable, active low"},
  Pin{D,  4, kOutput,    kUp,    0, true,  "MOTOR6 enable, active low"},
  Pin{E,  0, kOutput,    kUp,    0, true,  "MOTOR7 enable, active low"},
  // Switch inputs 1 to 7: a contact to ground, pulled up.
  Pin{G,  6, kInput,     kUp,    0, false, "STOP0, switch input 1 (EXTI6)"},
  Pin{G,  9, kInput,     kUp,    0, false, "STOP1, switch input 2 (EXTI9)"},
  Pin{G, 10, kInput,     kUp,    0, false, "STOP2, switch input 3 (EXTI10)"},
  Pin{G, 11, kInput,     kUp,    0, false, "STOP3, switch input 4 (EXTI11)"},
  Pin{G, 12, kInput,     kUp,    0, false, "STOP4, switch input 5 (EXTI12)"},
  Pin{G, 13, kInput,     kUp,    0, false, "STOP5, switch input 6 (EXTI13)"},
  Pin{G, 14, kInput,     kUp,    0, false, "STOP6, switch input 7 (EXTI14)"},
  // Heaters and fans: off, whatever hangs on them.
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
};
// clang-format on
static_assert(stm32::pins_differ(kPins));

inline constexpr std::array<SwitchPin, 7> kSwitchPins{
    {{G, 6}, {G, 9}, {G, 10}, {G, 11}, {G, 12}, {G, 13}, {G, 14}}};
static_assert(stm32::lines_differ(kSwitchPins));

struct DriverPins {
  OutputPin step, direction, enable;
};
inline constexpr std::array<DriverPins, 2> kDrivers{{{{F, 13}, {F, 12}, {F, 14}}, {{G, 0}, {G, 1}, {F, 15}}}};
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

/// 16 microsteps a full step of 256 counts, as both MS jumpers of a TMC2209 choose: log2 of counts a step.
inline constexpr int kStepBits = 4;

// Flash: the maker's boot loader in sectors 0 and 1, the program from sector 2 on, parameters in 6 and 7.
inline constexpr std::uint32_t kProgramAddress = 0x0800'8000, kProgramBytes = 0x3'8000;
inline constexpr std::array<stm32::FlashSector, 2> kParameterSectors{{{0x0804'0000, 6}, {0x0806'0000, 7}}};
inline constexpr std::uint32_t kParameterPageBytes = 0x4000;

}  // namespace kinebus::octopus
