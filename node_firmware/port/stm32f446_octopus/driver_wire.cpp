#include "node_firmware/port/stm32f446_octopus/driver_wire.hpp"

#include "node_firmware/port/stm32f4/clocks.hpp"
#include "node_firmware/port/stm32f4/local_time.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"

namespace kinebus::stm32 {
namespace {

// RM0390, DMA2 request mapping, channel 7: TIM8_CH2 is stream 3, TIM8_CH4 stream 7.
constexpr unsigned kTim8 = 7;
constexpr std::size_t kSay = 3, kHear = 7;
constexpr int kSayEvent = 2, kHearEvent = 4;

std::uint32_t address_of(const volatile void* place) {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(place));
}
void open_drain(OutputPin pin) {
  Gpio& port = gpio(static_cast<unsigned>(pin.port));
  port.OTYPER = port.OTYPER | bit(pin.number);
}
bool runs(std::size_t stream) {
  return (dma2().stream[stream].CR & Dma::kEnable) != 0;
}
// A stream ends when what it carries has arrived: some cycles.
void end(std::size_t stream) {
  Dma::Stream& s = dma2().stream[stream];
  s.CR = s.CR & ~Dma::kEnable;
  const std::uint32_t from = local_counts();
  while (runs(stream) && local_counts() - from < 40) {
  }
}

}  // namespace

void DriverWire::start() {
  for (const octopus::DriverPins& driver : octopus::kDrivers) open_drain(driver.uart);
  enable_clock(rcc().AHB1ENR, Rcc::kDma2);
  enable_clock(rcc().APB2ENR, Rcc::kTim8);
  constexpr std::uint32_t kTop = 2 * kApb2Hz / (kBaud * step::kSamples);
  static_assert(kTop * kBaud * step::kSamples == 2 * kApb2Hz && kTop <= 0x1'0000);
  Timer& t = tim8();
  t.PSC = 0;
  t.ARR = kTop - 1;
  t.CCMR1 = 0;  // compare events, and no output
  t.CCMR2 = 0;
  // What is written at the beginning of a quarter is read at its end.
  t.CCR[kSayEvent - 1] = 1;
  t.CCR[kHearEvent - 1] = kTop - 2;
  t.EGR = Timer::kGenerateUpdate;
}

void DriverWire::begin(std::size_t driver, std::span<const std::uint8_t> said, std::size_t answer_bytes) {
  wire_ = octopus::kDrivers[driver].uart;
  Gpio& port = gpio(static_cast<unsigned>(wire_.port));
  open_drain(wire_);  // it may have been a select
  const std::size_t words = step::put_bytes(said, bit(wire_.number), words_);
  count_ =
      words + kAfterLast + (answer_bytes == 0 ? 0 : answer_bytes * kQuartersOfByte + kPatience - kAfterLast);
  Timer& t = tim8();
  t.CR1 = 0;
  t.DIER = 0;
  t.CNT = 0;
  t.SR = 0;
  const auto prepare = [](std::size_t stream, Reg& place, const void* memory, std::size_t count,
                          std::uint32_t kind) {
    dma2().clear(stream);
    Dma::Stream& s = dma2().stream[stream];
    s.FCR = 0;
    s.PAR = address_of(&place);
    s.M0AR = address_of(memory);
    s.NDTR = count;
    s.CR = Dma::channel(kTim8) | Dma::kMemoryIncrement | kind;
    s.CR = s.CR | Dma::kEnable;
  };
  barrier();  // the words are there
  prepare(kSay, port.BSRR, words_.data(), words,
          Dma::kFromMemory | Dma::kPeripheralWords | Dma::kMemoryWords);
  prepare(kHear, port.IDR, samples_.data(), count_, Dma::kPeripheralHalfWords | Dma::kMemoryHalfWords);
  t.DIER = Timer::request(kSayEvent) | Timer::request(kHearEvent);
  t.CR1 = Timer::kEnable;
}

bool DriverWire::done() const {
  return !runs(kHear);
}

std::size_t DriverWire::take(std::span<std::uint8_t> heard) {
  tim8().CR1 = 0;
  tim8().DIER = 0;
  const std::size_t missing = dma2().stream[kHear].NDTR;
  end(kSay);
  end(kHear);
  write(wire_, true);  // let go of, whatever was left unsaid
  barrier();
  return step::take_bytes(std::span(samples_).first(count_ - std::min(missing, count_)), bit(wire_.number),
                          heard);
}

}  // namespace kinebus::stm32
