#include "node_firmware/port/stm32f446_octopus/heat_stage.hpp"

#include "node_firmware/port/stm32f4/local_time.hpp"

namespace kinebus::stm32 {
namespace {

// RM0390, DMA2 request mapping: ADC3 is channel 2 of streams 0 and 1, of which steps have the second.
constexpr std::size_t kStream = 0;
constexpr unsigned kChannel = 2;

}  // namespace

void HeatPort::start() {
  enable_clock(rcc().APB1ENR, Rcc::kTim4);
  Timer& servo = tim4();
  servo.PSC = 2 * kApb1Hz / 1'000'000 - 1;  // us
  servo.ARR = heat::PinProbe::kPeriod / std::chrono::microseconds{1} - 1;
  servo.CCMR1 = Timer::kPwm1Preload;
  servo.CCR[0] = 0;
  servo.CCER = bit(0);
  servo.EGR = Timer::kGenerateUpdate;
  servo.CR1 = Timer::kEnable | Timer::kAutoReloadPreload;

  enable_clock(rcc().AHB1ENR, Rcc::kDma2);
  enable_clock(rcc().APB2ENR, Rcc::kAdc1 | Rcc::kAdc3);  // the common registers go by ADC1's
  for (volatile std::uint16_t& word : words_) word = kTaken;
  Adc& a = adc(3);
  adc_common().CCR = AdcCommon::kPrescaler8;
  a.CR1 = Adc::kScan;
  a.CR2 = Adc::kOn | Adc::kContinuous | Adc::kDma | Adc::kDmaGoesOn;
  constexpr std::uint32_t kLongest = 7;  // 480 clocks: dividers of up to 100 kOhm and a capacitor
  std::uint32_t sequence = 0;
  for (std::size_t i = 0; i < octopus::kThermistors.size(); ++i) {
    const unsigned channel = octopus::kThermistors[i].channel;
    Reg& times = channel < 10 ? a.SMPR2 : a.SMPR1;
    times = times | kLongest << (3 * (channel % 10));
    sequence |= channel << (5 * i);
  }
  static_assert(octopus::kThermistors.size() <= 6, "SQR3 alone");
  a.SQR3 = sequence;
  a.SQR1 = (octopus::kThermistors.size() - 1) << 20;

  dma2().clear(kStream);
  Dma::Stream& s = dma2().stream[kStream];
  s.FCR = 0;
  s.PAR = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(&a.DR));
  s.M0AR = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(words_.data()));
  s.NDTR = words_.size();
  s.CR = Dma::channel(kChannel) | Dma::kCircular | Dma::kMemoryIncrement | Dma::kPeripheralHalfWords |
         Dma::kMemoryHalfWords;
  s.CR = s.CR | Dma::kEnable;
  // 3 us from on to the first conversion (t_STAB).
  const std::uint32_t from = local_counts();
  static_cast<void>(wait_until([from] { return local_counts() - from > 16; }));
  a.CR2 = a.CR2 | Adc::kSoftwareStart;
}

std::optional<std::uint32_t> HeatPort::take_ratio(int sensor) {
  std::uint32_t sum = 0;
  bool fresh = true;
  for (std::size_t i = static_cast<std::size_t>(sensor); i < words_.size();
       i += octopus::kThermistors.size()) {
    const std::uint32_t word = words_[i];
    fresh = fresh && word != kTaken;
    sum += word;
    words_[i] = kTaken;
  }
  if (!fresh) return std::nullopt;
  constexpr std::uint32_t kMost = kRounds * 4095;
  static_assert(heat::kFullRatio == kRounds << 16 && kMost < 0x10000);
  return (sum << 16) / (kMost / kRounds);
}

}  // namespace kinebus::stm32
