#pragma once
// Registers of the STM32G0B1 that the firmware uses, and no others: names, order and bits as in the reference
// manual RM0444, core peripherals as in the ARMv6-M manual.

#include <cstddef>
#include <cstdint>
#include <span>

#include "node_firmware/port/stm32/instructions.hpp"
#include "node_firmware/port/stm32/peripheral.hpp"
#include "node_firmware/port/stm32/pin_table.hpp"

namespace kinebus::g0b1 {

using stm32::barrier;
using stm32::bit;
using stm32::disable_interrupts;
using stm32::enable_clock;
using stm32::enable_interrupts;
using stm32::peripheral;
using stm32::Reg;
using stm32::reset_processor;
using stm32::wait_for_interrupt;
using stm32::wait_until;

struct Rcc {
  Reg CR, ICSCR, CFGR, PLLCFGR, reserved0, CRRCR, CIER, CIFR, CICR;
  Reg IOPRSTR, AHBRSTR, APBRSTR1, APBRSTR2, IOPENR, AHBENR, APBENR1, APBENR2;
  Reg IOPSMENR, AHBSMENR, APBSMENR1, APBSMENR2, CCIPR, CCIPR2, BDCR, CSR;
  static constexpr std::uint32_t kHsiOn = bit(8), kHsiReady = bit(10), kHseOn = bit(16), kHseReady = bit(17),
                                 kClockSecurity = bit(19), kPllOn = bit(24), kPllReady = bit(25);  // CR
  static constexpr std::uint32_t kSwitchMask = 7, kSwitchPll = 2, kSwitchStatusMask = 7u << 3,
                                 kSwitchStatusPll = 2u << 3;              // CFGR
  static constexpr std::uint32_t kPllFromHse = 3, kPllRToCore = bit(28);  // PLLCFGR
  static constexpr std::uint32_t kCanClockMask = 3u << 8;                 // CCIPR2: 0 is PCLK
  static constexpr std::uint32_t kClearResetFlags = bit(23), kPinReset = bit(26), kPowerOnReset = bit(27),
                                 kSoftwareReset = bit(28), kWatchdogReset = bit(29),
                                 kWindowWatchdogReset = bit(30);  // CSR
  static constexpr std::uint32_t gpio_clock(stm32::Port port) { return bit(static_cast<int>(port)); }
  static constexpr std::uint32_t kDma1 = bit(0);  // AHBENR
  static constexpr std::uint32_t kTim2 = bit(0), kCan = bit(12), kSpi2 = bit(14), kUsart2 = bit(17),
                                 kDebug = bit(27);  // APBENR1
  static constexpr std::uint32_t kTim1 = bit(11), kSpi1 = bit(12), kTim16 = bit(17), kTim17 = bit(18),
                                 kAdc = bit(20);  // APBENR2
};
static_assert(offsetof(Rcc, IOPENR) == 0x34 && offsetof(Rcc, APBENR1) == 0x3C &&
              offsetof(Rcc, CCIPR2) == 0x58 && offsetof(Rcc, CSR) == 0x60);
inline Rcc& rcc() {
  return peripheral<Rcc>(0x4002'1000);
}

struct FlashInterface {
  Reg ACR, reserved0, KEYR, OPTKEYR, SR, CR, ECCR, ECC2R, OPTR;
  static constexpr std::uint32_t kWaitStates2 = 2, kWaitStatesMask = 7, kPrefetch = bit(8),
                                 kInstructionCache = bit(9), kInstructionCacheReset = bit(11);  // ACR
  static constexpr std::uint32_t kKey1 = 0x4567'0123, kKey2 = 0xCDEF'89AB;                      // KEYR
  static constexpr std::uint32_t kEndOfOperation = bit(0), kErrors = 0xC3FA, kBusy = bit(16) | bit(17),
                                 kConfigurationBusy = bit(18);  // SR
  static constexpr std::uint32_t kProgram = bit(0), kPageErase = bit(1), kStart = bit(16),
                                 kLock = bit(31);                               // CR
  static constexpr std::uint32_t page(unsigned number) { return number << 3; }  // CR
};
static_assert(offsetof(FlashInterface, CR) == 0x14);
inline FlashInterface& flash_interface() {
  return peripheral<FlashInterface>(0x4002'2000);
}

struct Gpio {
  Reg MODER, OTYPER, OSPEEDR, PUPDR, IDR, ODR, BSRR, LCKR, AFR[2], BRR;
};
inline Gpio& gpio(unsigned port) {
  return peripheral<Gpio>(0x5000'0000 + 0x400 * port);
}

struct Exti {
  Reg RTSR1, FTSR1, SWIER1, RPR1, FPR1, reserved0[19], EXTICR[4], reserved1[4], IMR1, EMR1;
};
static_assert(offsetof(Exti, EXTICR) == 0x60 && offsetof(Exti, IMR1) == 0x80);
inline Exti& exti() {
  return peripheral<Exti>(0x4002'1800);
}

struct Timer {
  Reg CR1, CR2, SMCR, DIER, SR, EGR, CCMR1, CCMR2, CCER, CNT, PSC, ARR, RCR, CCR[4], BDTR;
  static constexpr std::uint32_t kEnable = bit(0), kAutoReloadPreload = bit(7);     // CR1
  static constexpr std::uint32_t kGenerateUpdate = bit(0);                          // EGR
  static constexpr std::uint32_t request(int channel) { return bit(8 + channel); }  // DIER, channel 1..4
  static constexpr std::uint32_t kPwm1Preload = 6u << 4 | bit(3);                   // CCMR1, channel 1
  static constexpr std::uint32_t kMainOutput = bit(15);                             // BDTR
};
inline Timer& tim1() {
  return peripheral<Timer>(0x4001'2C00);
}
inline Timer& tim2() {
  return peripheral<Timer>(0x4000'0000);
}
inline Timer& tim16() {
  return peripheral<Timer>(0x4001'4400);
}
inline Timer& tim17() {
  return peripheral<Timer>(0x4001'4800);
}

struct Spi {
  Reg CR1, CR2, SR, DR;
  static constexpr std::uint32_t kMode3 = 3, kMaster = bit(2), kDividedBy16 = 3u << 3, kEnable = bit(6),
                                 kSelected = bit(8) | bit(9);                // CR1: by software
  static constexpr std::uint32_t kBytes = 7u << 8, kByteReceived = bit(12);  // CR2: told for each byte
  static constexpr std::uint32_t kReceived = bit(0);                         // SR
};
inline Spi& spi1() {
  return peripheral<Spi>(0x4001'3000);
}
inline Spi& spi2() {
  return peripheral<Spi>(0x4000'3800);
}

struct Usart {
  Reg CR1, CR2, CR3, BRR, GTPR, RTOR, RQR, ISR, ICR, RDR, TDR;
  static constexpr std::uint32_t kEnable = bit(0), kReceiver = bit(2), kTransmitter = bit(3),
                                 kFifos = bit(29);                            // CR1
  static constexpr std::uint32_t kPinsSwapped = bit(15);                      // CR2
  static constexpr std::uint32_t kOneWire = bit(3), kReceivedToDma = bit(6);  // CR3
  static constexpr std::uint32_t kForgetReceived = bit(3);                    // RQR
  static constexpr std::uint32_t kErrors = 0xF;                               // ICR
  static constexpr std::size_t kFifoBytes = 8;
};
static_assert(offsetof(Usart, RQR) == 0x18 && offsetof(Usart, TDR) == 0x28);
inline Usart& usart2() {
  return peripheral<Usart>(0x4000'4400);
}

struct Adc {
  Reg ISR, IER, CR, CFGR1, CFGR2, SMPR, reserved0[4], CHSELR, reserved1[5], DR;
  static constexpr std::uint32_t kReady = bit(0), kEndOfConversion = bit(2), kChannelsTaken = bit(13);  // ISR
  static constexpr std::uint32_t kEnable = bit(0), kStart = bit(2), kRegulator = bit(28),
                                 kCalibrate = bit(31);                         // CR
  static constexpr std::uint32_t kOverwrite = bit(12), kContinuous = bit(13);  // CFGR1
  // CFGR2: sums of 256 conversions without their lowest 4 bits; PCLK / 4.
  static constexpr std::uint32_t kOversample = bit(0), k256Times = 7u << 2, kShift4 = 4u << 5,
                                 kClockDividedBy4 = 2u << 30;
  static constexpr std::uint32_t kSample160 = 7;  // SMPR: 160.5 clocks
};
static_assert(offsetof(Adc, CHSELR) == 0x28 && offsetof(Adc, DR) == 0x40);
inline Adc& adc() {
  return peripheral<Adc>(0x4001'2400);
}

/// DMA1: channels 1 to 7 are [0] to [6].
struct Dma {
  Reg ISR, IFCR;
  struct Channel {
    Reg CCR, CNDTR, CPAR, CMAR, reserved;
  } channel[7];
  static constexpr std::uint32_t kEnable = bit(0), kOnComplete = bit(1), kOnHalf = bit(2),
                                 kFromMemory = bit(4), kCircular = bit(5), kMemoryIncrement = bit(7),
                                 kPeripheralWords = 2u << 8, kMemoryWords = 2u << 10,
                                 kPriorityHighest = 3u << 12;                                   // CCR
  static constexpr std::uint32_t all_of(std::size_t channel) { return 0xFu << (4 * channel); }  // IFCR
};
inline Dma& dma1() {
  return peripheral<Dma>(0x4002'0000);
}
/// Which request each DMA channel serves: [0] is DMA1's channel 1.
struct DmaMux {
  Reg CCR[12];
  static constexpr std::uint32_t kTim1Channel1 = 20, kTim1Channel2 = 21, kUsart2Receive = 52;
};
inline DmaMux& dma_mux() {
  return peripheral<DmaMux>(0x4002'0800);
}

struct Fdcan {
  Reg CREL, ENDN, reserved0, DBTP, TEST, RWD, CCCR, NBTP, TSCC, TSCV, TOCC, TOCV, reserved1[4];
  Reg ECR, PSR, TDCR, reserved2, IR, IE, ILS, ILE, reserved3[8];
  Reg RXGFC, XIDAM, HPMS, reserved4, RXF0S, RXF0A, RXF1S, RXF1A, reserved5[8];
  Reg TXBC, TXFQS, TXBRP, TXBAR, TXBCR, TXBTO, TXBCF, TXBTIE, TXBCIE, TXEFS, TXEFA;
  static constexpr std::uint32_t kInit = bit(0), kChange = bit(1);     // CCCR
  static constexpr std::uint32_t kPassive = bit(5), kBusOff = bit(7);  // PSR
  static constexpr std::uint32_t kNew0 = bit(0), kLost0 = bit(2), kPassiveChanged = bit(17),
                                 kBusOffChanged = bit(19);          // IR, IE
  static constexpr std::uint32_t kErrorsToLine1 = bit(5) | bit(6);  // ILS
  static constexpr std::uint32_t kBothLines = 3;                    // ILE
  static constexpr std::uint32_t kRejectExtendedRemote = 1, kRejectExtended = 2u << 2,
                                 kRejectStandard = 2u << 4;
  static constexpr std::uint32_t standard_filters(unsigned n) { return n << 16; }  // RXGFC
  static constexpr std::uint32_t kQueue = bit(24);                                 // TXBC: not a FIFO
};
static_assert(offsetof(Fdcan, ECR) == 0x40 && offsetof(Fdcan, RXGFC) == 0x80 &&
              offsetof(Fdcan, RXF0S) == 0x90 && offsetof(Fdcan, TXBC) == 0xC0 &&
              offsetof(Fdcan, TXEFA) == 0xE8);
inline Fdcan& fdcan2() {
  return peripheral<Fdcan>(0x4000'6800);
}
/// An instance's part of the message RAM, in words.
struct CanMemory {
  struct Element {
    Reg id, control, data[16];
  };
  static constexpr std::uint32_t kExtended = bit(30), kRemote = bit(29);  // id
  static constexpr std::uint32_t standard(std::uint32_t id) { return id << 18; }
  static constexpr std::uint32_t length(std::uint32_t bytes) { return bytes << 16; }  // control
  /// Identifier and mask, to FIFO 0.
  static constexpr std::uint32_t filter(std::uint32_t id, std::uint32_t mask) {
    return 2u << 30 | 1u << 27 | id << 16 | mask;
  }
  Reg standard_filter[28], extended_filter[16];
  Element fifo0[3], fifo1[3];
  Reg sent[6];
  Element transmit[3];
};
static_assert(offsetof(CanMemory, fifo0) == 0xB0 && offsetof(CanMemory, transmit) == 0x278 &&
              sizeof(CanMemory) == 0x350);
inline CanMemory& can_memory2() {
  return peripheral<CanMemory>(0x4000'B400 + sizeof(CanMemory));
}

/// DBG_IDCODE, of which the lower 12 bits name the kind of chip. Needs the debug block's clock.
inline std::uint32_t device_id() {
  return peripheral<Reg>(0x4001'5800) & 0xFFF;
}
inline constexpr std::uint32_t kDeviceG0B1 = 0x467;

struct IndependentWatchdog {
  Reg KR, PR, RLR, SR;
  static constexpr std::uint32_t kFeed = 0xAAAA, kUnlock = 0x5555, kStart = 0xCCCC;
};
inline IndependentWatchdog& watchdog() {
  return peripheral<IndependentWatchdog>(0x4000'3000);
}

/// 96 bits that no other chip has.
inline std::span<const volatile std::uint32_t, 3> unique_id() {
  return std::span<const volatile std::uint32_t, 3>(&peripheral<Reg>(0x1FFF'7590), 3);
}

// Core.
struct Nvic {
  Reg ISER, reserved0[31], ICER, reserved1[31], ISPR, reserved2[31], ICPR, reserved3[95], IPR[8];
};
static_assert(offsetof(Nvic, ICER) == 0x80 && offsetof(Nvic, ICPR) == 0x180 && offsetof(Nvic, IPR) == 0x300);
inline Nvic& nvic() {
  return peripheral<Nvic>(0xE000'E100);
}
struct SysTick {
  Reg CTRL, LOAD, VAL;
  static constexpr std::uint32_t kEnable = bit(0), kInterrupt = bit(1), kCoreClock = bit(2);
};
inline SysTick& sys_tick() {
  return peripheral<SysTick>(0xE000'E010);
}
struct SystemControl {
  Reg CPUID, ICSR, VTOR, AIRCR, SCR, CCR;
};
inline SystemControl& system_control() {
  return peripheral<SystemControl>(0xE000'ED00);
}

/// Places in the vector table after the 16 of the core.
enum class Irq : int {
  kExti0To1 = 5,
  kExti2To3 = 6,
  kExti4To15 = 7,
  kDma1Channel1 = 9,
  kCan0 = 21,
  kCan1 = 22
};
/// priority: 0 (most urgent) to 3. The core takes priorities by whole words only.
inline void enable_interrupt(Irq irq, unsigned priority) {
  const auto n = static_cast<unsigned>(irq);
  const unsigned at = n % 4 * 8;
  nvic().IPR[n / 4] = (nvic().IPR[n / 4] & ~(0xFFu << at)) | priority << 6 << at;
  nvic().ISER = bit(static_cast<int>(n));
}

}  // namespace kinebus::g0b1
