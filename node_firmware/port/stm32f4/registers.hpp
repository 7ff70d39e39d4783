#pragma once
// Registers of the STM32F4 that the firmware uses, and no others: names, order and bits as in the reference
// manuals RM0090 (F405) and RM0390 (F446), core peripherals as in the ARMv7-M manual.

#include <cstddef>
#include <cstdint>
#include <span>

#include "node_firmware/port/stm32/instructions.hpp"
#include "node_firmware/port/stm32/peripheral.hpp"
#include "node_firmware/port/stm32/pin_table.hpp"

namespace kinebus::stm32 {

struct Rcc {
  Reg CR, PLLCFGR, CFGR, CIR;
  Reg AHB1RSTR, AHB2RSTR, AHB3RSTR, reserved0, APB1RSTR, APB2RSTR, reserved1[2];
  Reg AHB1ENR, AHB2ENR, AHB3ENR, reserved2, APB1ENR, APB2ENR, reserved3[2];
  Reg AHB1LPENR, AHB2LPENR, AHB3LPENR, reserved4, APB1LPENR, APB2LPENR, reserved5[2];
  Reg BDCR, CSR;
  static constexpr std::uint32_t kHsiOn = bit(0), kHsiReady = bit(1), kHseOn = bit(16), kHseReady = bit(17),
                                 kPllOn = bit(24), kPllReady = bit(25);
  static constexpr std::uint32_t kClockSecurity = bit(19);  // CR CSSON
  static constexpr std::uint32_t kPllFromHse = bit(22);
  static constexpr std::uint32_t kSwitchPll = 2, kSwitchStatusMask = 3u << 2, kSwitchStatusPll = 2u << 2;
  // CSR
  static constexpr std::uint32_t kBrownOutReset = bit(25), kPinReset = bit(26), kPowerOnReset = bit(27),
                                 kSoftwareReset = bit(28), kWatchdogReset = bit(29),
                                 kWindowWatchdogReset = bit(30), kClearResetFlags = bit(24);
  // AHB1ENR
  static constexpr std::uint32_t gpio_clock(Port port) { return bit(static_cast<int>(port)); }
  static constexpr std::uint32_t kDma2 = bit(22), kUsbHs = bit(29);
  static constexpr std::uint32_t kUsbUlpi = bit(30);  // AHB1LPENR: clock of an external PHY, in sleep
  static constexpr std::uint32_t kUsbFs = bit(7);     // AHB2ENR
  // APB1ENR
  static constexpr std::uint32_t kTim2 = bit(0), kTim3 = bit(1), kTim4 = bit(2), kSpi3 = bit(15),
                                 kCan1 = bit(25), kPower = bit(28);
  // APB2ENR
  static constexpr std::uint32_t kTim1 = bit(0), kTim8 = bit(1), kUsart1 = bit(4), kAdc1 = bit(8),
                                 kAdc2 = bit(9), kAdc3 = bit(10), kSpi1 = bit(12), kSysConfig = bit(14),
                                 kTim11 = bit(18);
  // CFGR: HSE_RTC is the crystal's clock divided by so much, 2 to 31.
  static constexpr std::uint32_t kCrystalDividerMask = 0x1Fu << 16;
  static constexpr std::uint32_t crystal_divider(std::uint32_t by) { return by << 16; }
};
inline Rcc& rcc() {
  return peripheral<Rcc>(0x4002'3800);
}

struct Pwr {
  Reg CR, CSR;
  static constexpr std::uint32_t kScale1 =
      bit(14);  // CR VOS: 168 MHz; the F446 has bit 15, too, set by reset
  static constexpr std::uint32_t kBackupWritable = bit(8);                    // CR DBP
  static constexpr std::uint32_t kDetectorOn = bit(4), kDetect2V9 = 7u << 5;  // CR PVDE, PLS
  static constexpr std::uint32_t kSupplyLow = bit(2);                         // CSR PVDO
};
inline Pwr& pwr() {
  return peripheral<Pwr>(0x4000'7000);
}

/// RTC_BKP0R to RTC_BKP19R: no reset changes them, and no program that does not mean to.
inline std::span<Reg, 20> backup_registers() {
  return std::span<Reg, 20>(&peripheral<Reg>(0x4000'2850), 20);
}

struct FlashInterface {
  Reg ACR, KEYR, OPTKEYR, SR, CR, OPTCR;
  static constexpr std::uint32_t kWaitStates5 = 5, kPrefetch = bit(8), kInstructionCache = bit(9),
                                 kDataCache = bit(10), kInstructionCacheReset = bit(11),
                                 kDataCacheReset = bit(12);
  static constexpr std::uint32_t kKey1 = 0x4567'0123, kKey2 = 0xCDEF'89AB;
  static constexpr std::uint32_t kOptionKey1 = 0x0819'2A3B, kOptionKey2 = 0x4C5D'6E7F;
  // OPTCR. BOR_LEV 0 is level 3, 2.7 V; nWRP: 0 is protected, by sector; RDP AAh: not read protected.
  static constexpr std::uint32_t kOptionLock = bit(0), kOptionStart = bit(1), kBrownOutLevel = 3u << 2,
                                 kReadProtection = 0xFFu << 8, kNotReadProtected = 0xAAu << 8;
  static constexpr std::uint32_t not_write_protected(unsigned sector) { return 1u << (16 + sector); }
  static constexpr std::uint32_t kEndOfOperation = bit(0), kBusy = bit(16), kErrors = 0xF2;
  static constexpr std::uint32_t kProgram = bit(0), kSectorErase = bit(1), kStart = bit(16), kLock = bit(31);
  static constexpr std::uint32_t kSizeWord = 2u << 8;  // PSIZE x32: 2.7 to 3.6 V
  static constexpr std::uint32_t sector(unsigned n) { return n << 3; }
};
inline FlashInterface& flash_interface() {
  return peripheral<FlashInterface>(0x4002'3C00);
}

struct Gpio {
  Reg MODER, OTYPER, OSPEEDR, PUPDR, IDR, ODR, BSRR, LCKR, AFR[2];
};
/// port: 0 = A, 1 = B, ...
inline Gpio& gpio(unsigned port) {
  return peripheral<Gpio>(0x4002'0000 + 0x400 * port);
}

struct SysConfig {
  Reg MEMRMP, PMC, EXTICR[4];
  static constexpr std::uint32_t kSystemFlashAtZero = 1;  // MEMRMP
};
inline SysConfig& sysconfig() {
  return peripheral<SysConfig>(0x4001'3800);
}

struct Exti {
  Reg IMR, EMR, RTSR, FTSR, SWIER, PR;
  static constexpr std::uint32_t kSupplyDetector = bit(16);
};
inline Exti& exti() {
  return peripheral<Exti>(0x4001'3C00);
}

struct Timer {
  Reg CR1, CR2, SMCR, DIER, SR, EGR, CCMR1, CCMR2, CCER, CNT, PSC, ARR, RCR, CCR[4], BDTR, DCR, DMAR, OR;
  static constexpr std::uint32_t kEnable = bit(0), kAutoReloadPreload = bit(7), kCentreAligned1 = 1u << 5;
  static constexpr std::uint32_t kMasterUpdate = 2u << 4;                            // CR2 MMS: TRGO = update
  static constexpr std::uint32_t kUpdateFlag = bit(0), kBreakFlag = bit(7);          // SR
  static constexpr std::uint32_t kBreakInterrupt = bit(7);                           // DIER
  static constexpr std::uint32_t request(int channel) { return bit(8 + channel); }   // DIER CCxDE
  static constexpr std::uint32_t kGenerateUpdate = bit(0), kGenerateBreak = bit(7);  // EGR
  // CCMR: PWM mode 1 with preload on both channels of the register.
  static constexpr std::uint32_t kPwm1Preload = (6u << 4 | bit(3)) | (6u << 12 | bit(11));
  // Encoder mode: both edges of both channels count, each level held for 8 periods of the clock.
  static constexpr std::uint32_t kBothEdges = 3;                                          // SMCR SMS
  static constexpr std::uint32_t kInputsFiltered = (1u | 3u << 4) | (1u | 3u << 4) << 8;  // CCMR1
  static constexpr std::uint32_t kAllOutputs = bit(0) | bit(4) | bit(8) | bit(12);        // CCER CC1E..CC4E
  // Channel 1 as an input: every eighth edge is captured.
  static constexpr std::uint32_t kCaptureEighth = 1u | 3u << 2;            // CCMR1
  static constexpr std::uint32_t kCapture1 = bit(0), kCaptured1 = bit(1);  // CCER, SR
  static constexpr std::uint32_t kInputCrystal = 2;                        // OR of TIM11: HSE_RTC
  // BDTR. OSSI and OSSR stay 0: with MOE = 0 the pins float, which the gate drivers take as "both off".
  static constexpr std::uint32_t kBreakEnable = bit(12), kBreakActiveHigh = bit(13), kMainOutput = bit(15);
};
inline Timer& tim1() {
  return peripheral<Timer>(0x4001'0000);
}
inline Timer& tim8() {
  return peripheral<Timer>(0x4001'0400);
}
inline Timer& tim11() {
  return peripheral<Timer>(0x4001'4800);
}
inline Timer& tim2() {
  return peripheral<Timer>(0x4000'0000);
}
inline Timer& tim3() {
  return peripheral<Timer>(0x4000'0400);
}
inline Timer& tim4() {
  return peripheral<Timer>(0x4000'0800);
}

struct Adc {
  Reg SR, CR1, CR2, SMPR1, SMPR2, JOFR[4], HTR, LTR, SQR1, SQR2, SQR3, JSQR, JDR[4], DR;
  static constexpr std::uint32_t kEndOfConversion = bit(1), kInjectedEnd = bit(2);  // SR
  static constexpr std::uint32_t kInjectedInterrupt = bit(7), kScan = bit(8);       // CR1
  static constexpr std::uint32_t kOn = bit(0), kContinuous = bit(1), kDma = bit(8), kDmaGoesOn = bit(9),
                                 kSoftwareStart = bit(30);                                          // CR2
  static constexpr std::uint32_t kInjectedByTim1Update = 1u << 16, kInjectedRisingEdge = 1u << 20;  // CR2
};
inline Adc& adc(int n) {
  return peripheral<Adc>(0x4001'2000 + 0x100 * static_cast<std::uint32_t>(n - 1));
}
struct AdcCommon {
  Reg CSR, CCR, CDR;
  static constexpr std::uint32_t kInjectedSimultaneous =
      5;                                                  // MULTI: ADC1 master, ADC2 slave; ADC3 for itself
  static constexpr std::uint32_t kPrescaler4 = 1u << 16;  // 84 MHz / 4 = 21 MHz
  static constexpr std::uint32_t kPrescaler8 = 3u << 16;  // 10.5 MHz
};
inline AdcCommon& adc_common() {
  return peripheral<AdcCommon>(0x4001'2300);
}

struct Spi {
  Reg CR1, CR2, SR, DR;
  // AS5047: 16 bits, clock low at rest, data taken at the second edge (CPOL 0, CPHA 1).
  static constexpr std::uint32_t kSecondEdge = bit(0), kRestsHigh = bit(1), kMaster = bit(2),
                                 kEnable = bit(6), kInternalSelect = bit(8), kSoftwareSelect = bit(9),
                                 kFrame16 = bit(11);
  static constexpr std::uint32_t divide(unsigned log2) { return (log2 - 1u) << 3; }
  static constexpr std::uint32_t kReceived = bit(0), kSendEmpty = bit(1), kOverrun = bit(6), kBusy = bit(7);
};
inline Spi& spi1() {
  return peripheral<Spi>(0x4001'3000);
}
inline Spi& spi3() {
  return peripheral<Spi>(0x4000'3C00);
}

struct Usart {
  Reg SR, DR, BRR, CR1, CR2, CR3, GTPR;
  static constexpr std::uint32_t kReceived = bit(5), kSendEmpty = bit(7);                       // SR
  static constexpr std::uint32_t kReceiver = bit(2), kTransmitter = bit(3), kEnable = bit(13);  // CR1
};
inline Usart& usart1() {
  return peripheral<Usart>(0x4001'1000);
}

struct Can {
  Reg MCR, MSR, TSR, RFR[2], IER, ESR, BTR, reserved0[88];
  struct TxMailbox {
    Reg TIR, TDTR, TDLR, TDHR;
  } tx[3];
  struct RxFifo {
    Reg RIR, RDTR, RDLR, RDHR;
  } rx[2];
  Reg reserved1[12];
  Reg FMR, FM1R, reserved2, FS1R, reserved3, FFA1R, reserved4, FA1R, reserved5[8];
  struct Filter {
    Reg R1, R2;
  } filter[28];
  static constexpr std::uint32_t kInitRequest = bit(0), kSleepRequest = bit(1), kAutoWakeUp = bit(5),
                                 kAutoBusOff = bit(6);                                          // MCR
  static constexpr std::uint32_t kInitDone = bit(0), kErrorInterruptFlag = bit(2);              // MSR
  static constexpr std::uint32_t kRequestDone[3] = {bit(0), bit(8), bit(16)};                   // TSR RQCP
  static constexpr std::uint32_t kSentGood[3] = {bit(1), bit(9), bit(17)};                      // TSR TXOK
  static constexpr std::uint32_t kAbort[3] = {bit(7), bit(15), bit(23)};                        // TSR ABRQ
  static constexpr std::uint32_t kEmpty[3] = {bit(26), bit(27), bit(28)};                       // TSR TME
  static constexpr std::uint32_t kFifoCount = 3, kFifoOverrun = bit(4), kFifoRelease = bit(5);  // RFR
  static constexpr std::uint32_t kOnMailboxEmpty = bit(0), kOnFifo0 = bit(1), kOnOverrun0 = bit(3),
                                 kOnPassive = bit(9), kOnBusOff = bit(10), kOnError = bit(15);  // IER
  static constexpr std::uint32_t kWarning = bit(0), kPassive = bit(1), kBusOff = bit(2);        // ESR
  static constexpr std::uint32_t kTransmit = bit(0), kRemote = bit(1), kExtended = bit(2);      // TIR, RIR
  static constexpr std::uint32_t kFilterInit = bit(0);                                          // FMR
};
static_assert(offsetof(Can, tx) == 0x180 && offsetof(Can, rx) == 0x1B0 && offsetof(Can, FMR) == 0x200 &&
              offsetof(Can, FA1R) == 0x21C && offsetof(Can, filter) == 0x240);
inline Can& can1() {
  return peripheral<Can>(0x4000'6400);
}

/// OTG_HS or OTG_FS as a full-speed device with its own transceiver.
struct Otg {
  Reg GOTGCTL, GOTGINT, GAHBCFG, GUSBCFG, GRSTCTL, GINTSTS, GINTMSK, GRXSTSR, GRXSTSP, GRXFSIZ, DIEPTXF0,
      reserved0[3], GCCFG, CID, reserved1[49], DIEPTXF[7], reserved2[440];
  Reg DCFG, DCTL, DSTS, reserved3, DIEPMSK, DOEPMSK, DAINT, DAINTMSK, reserved4[56];
  struct Endpoint {
    Reg CTL, reserved0, INT, reserved1, TSIZ, DMA, FSTS, reserved2;
  } in[8], reserved5[8], out[8], reserved6[16];
  Reg PCGCCTL, reserved7[127];
  struct Fifo {
    Reg word[1024];
  } fifo[6];
  static constexpr std::uint32_t kInternalPhy = bit(6), kForceDevice = bit(30);        // GUSBCFG
  static constexpr std::uint32_t turnaround(unsigned clocks) { return clocks << 10; }  // GUSBCFG
  static constexpr std::uint32_t kCoreReset = bit(0), kFlushReceive = bit(4), kFlushSend = bit(5),
                                 kBusIdle = bit(31);                         // GRSTCTL
  static constexpr std::uint32_t fifo_number(unsigned n) { return n << 6; }  // GRSTCTL, 16: all
  static constexpr std::uint32_t kReceived = bit(4), kSuspend = bit(11), kReset = bit(12),
                                 kSendEvent = bit(18);                              // GINTSTS, GINTMSK
  static constexpr std::uint32_t kInterruptOn = bit(0);                             // GAHBCFG
  static constexpr std::uint32_t kTransceiver = bit(16), kNoVbusSensing = bit(21);  // GCCFG
  // GOTGCTL of the F446, whose GCCFG has another bit 21: VBUS is taken to be there.
  static constexpr std::uint32_t kVbusOverride = bit(6) | bit(7);
  static constexpr std::uint32_t kFullSpeed = 3, kAddressMask = 0x7Fu << 4;  // DCFG
  static constexpr std::uint32_t address(unsigned a) { return a << 4; }      // DCFG
  static constexpr std::uint32_t kDetach = bit(1);                           // DCTL
  static constexpr std::uint32_t kActive = bit(15), kStall = bit(21), kClearNak = bit(26), kSetNak = bit(27),
                                 kDataZero = bit(28), kDisable = bit(30), kEnable = bit(31);    // CTL
  static constexpr std::uint32_t kBulk = 2u << 18, kInterrupt = 3u << 18;                       // CTL
  static constexpr std::uint32_t fifo_of(unsigned n) { return n << 22; }                        // CTL
  static constexpr std::uint32_t kComplete = bit(0), kDisabled = bit(1), kNakInForce = bit(6);  // INT
  static constexpr std::uint32_t kOnePacket = bit(19), kThreeSetups = 3u << 29;                 // TSIZ
};
static_assert(offsetof(Otg, GCCFG) == 0x38 && offsetof(Otg, DIEPTXF) == 0x104 &&
              offsetof(Otg, DCFG) == 0x800 && offsetof(Otg, in) == 0x900 && offsetof(Otg, out) == 0xB00 &&
              offsetof(Otg, PCGCCTL) == 0xE00 && offsetof(Otg, fifo) == 0x1000);
inline Otg& otg_hs() {
  return peripheral<Otg>(0x4004'0000);
}
inline Otg& otg_fs() {
  return peripheral<Otg>(0x5000'0000);
}

/// DMA2, the controller that reaches the GPIO ports: its eight streams.
struct Dma {
  Reg LISR, HISR, LIFCR, HIFCR;
  struct Stream {
    Reg CR, NDTR, PAR, M0AR, M1AR, FCR;
  } stream[8];
  // CR
  static constexpr std::uint32_t kEnable = bit(0), kOnHalf = bit(3), kOnComplete = bit(4),
                                 kFromMemory = 1u << 6, kCircular = bit(8), kMemoryIncrement = bit(10),
                                 kPeripheralWords = 2u << 11, kMemoryWords = 2u << 13,
                                 kPeripheralHalfWords = 1u << 11, kMemoryHalfWords = 1u << 13,
                                 kPriorityHigh = 3u << 16;
  static constexpr std::uint32_t channel(unsigned n) { return n << 25; }
  /// All flags of a stream, in the register of its four.
  void clear(std::size_t number) {
    constexpr std::uint32_t kAt[4] = {0, 6, 16, 22};
    Reg& flags = number < 4 ? LIFCR : HIFCR;
    flags = 0x3Du << kAt[number % 4];
  }
};
inline Dma& dma2() {
  return peripheral<Dma>(0x4002'6400);
}

/// DBGMCU_IDCODE, of which the lower 12 bits name the kind of chip.
inline std::uint32_t device_id() {
  return peripheral<Reg>(0xE004'2000) & 0xFFF;
}
inline constexpr std::uint32_t kDeviceF405 = 0x413, kDeviceF446 = 0x421;

struct IndependentWatchdog {
  Reg KR, PR, RLR, SR;
  static constexpr std::uint32_t kFeed = 0xAAAA, kUnlock = 0x5555, kStart = 0xCCCC;
};
inline IndependentWatchdog& watchdog() {
  return peripheral<IndependentWatchdog>(0x4000'3000);
}

/// 96 bits that no other chip has.
inline std::span<const volatile std::uint32_t, 3> unique_id() {
  return std::span<const volatile std::uint32_t, 3>(&peripheral<Reg>(0x1FFF'7A10), 3);
}

// Core.
struct Nvic {
  Reg ISER[8], reserved0[24], ICER[8], reserved1[24], ISPR[8], reserved2[24], ICPR[8], reserved3[24], IABR[8],
      reserved4[56];
  volatile std::uint8_t IPR[240];
};
inline Nvic& nvic() {
  return peripheral<Nvic>(0xE000'E100);
}
struct SystemControl {
  Reg CPUID, ICSR, VTOR, AIRCR, SCR, CCR, SHPR[3], SHCSR, CFSR, HFSR, DFSR, MMFAR, BFAR, AFSR, reserved0[18],
      CPACR;
  static constexpr std::uint32_t kFloatingPoint = 0xFu << 20;  // CPACR: CP10 and CP11
};
static_assert(offsetof(SystemControl, CPACR) == 0x88);
inline SystemControl& system_control() {
  return peripheral<SystemControl>(0xE000'ED00);
}
struct SysTick {
  Reg CTRL, LOAD, VAL;
  static constexpr std::uint32_t kEnable = bit(0), kInterrupt = bit(1), kCoreClock = bit(2);
};
inline SysTick& sys_tick() {
  return peripheral<SysTick>(0xE000'E010);
}
/// Cycle counter, for measuring: DEMCR.TRCENA, then DWT.CTRL.CYCCNTENA.
struct Dwt {
  Reg CTRL, CYCCNT;
};
inline Dwt& dwt() {
  return peripheral<Dwt>(0xE000'1000);
}
inline Reg& debug_control() {
  return peripheral<Reg>(0xE000'EDFC);
}

/// Places in the vector table after the 16 of the core.
enum class Irq : int {
  kSupplyDetector = 1,
  kExti0 = 6,
  kExti1 = 7,
  kExti2 = 8,
  kExti3 = 9,
  kExti4 = 10,
  kAdc = 18,
  kCan1Tx = 19,
  kCan1Rx0 = 20,
  kCan1Sce = 22,
  kExti9To5 = 23,
  kTim1Break = 24,
  kUsart1 = 37,
  kExti15To10 = 40,
  kTim8Break = 43,
  kDma2Stream1 = 57,
  kOtgFs = 67,
};
/// priority: 0 (most urgent) to 15.
inline void enable_interrupt(Irq irq, unsigned priority) {
  const auto n = static_cast<unsigned>(irq);
  nvic().IPR[n] = static_cast<std::uint8_t>(priority << 4);
  nvic().ISER[n / 32] = std::uint32_t{1} << (n % 32);
}

/// As if the peripheral had asked for it.
inline void pend_interrupt(Irq irq) {
  const auto n = static_cast<unsigned>(irq);
  nvic().ISPR[n / 32] = std::uint32_t{1} << (n % 32);
}

}  // namespace kinebus::stm32
