#include "vcan_tests/emulator/stm32g0b1_chip.hpp"

#include <cstring>

namespace kinebus::emulator {
namespace {

constexpr std::uint32_t kSystemMemory = 0x1FFF7400, kUniqueId = 0x1FFF7590;
// 64 MHz on the time base of all boards.
constexpr Cycle kCycles = 21, kClocks = 8;
static_assert(kCoreHz * kClocks == Cycle{64'000'000} * kCycles);

constexpr Rcc::Clock iop(int bit) {
  return {0x34, bit};
}
constexpr Rcc::Clock ahb(int bit) {
  return {0x38, bit};
}
constexpr Rcc::Clock apb1(int bit) {
  return {0x3C, bit};
}
constexpr Rcc::Clock apb2(int bit) {
  return {0x40, bit};
}

}  // namespace

Stm32g0b1Chip::Stm32g0b1Chip(const ElfImage& image, const BoardOptions& options, std::uint32_t crystal_hz,
                             std::uint32_t device_id)
    : Chip(image, options,
           {.core_coupled_memory = false,
            .small = true,
            .cycles = kCycles,
            .clocks = kClocks,
            .system_memory = kSystemMemory}),
      rcc_(crystal_hz),
      flash_(cpu_.flash().first(kFlashBytes)),
      exti_(cpu_.nvic()),
      tim2_(cpu_.nvic(), {.update_irq = 15, .cycles_per_tick = kCycles, .advanced = false, .ticks = kClocks}),
      tim1_(cpu_.nvic(), {.update_irq = 13, .break_irq = 13, .cycles_per_tick = kCycles, .ticks = kClocks}),
      tim16_(cpu_.nvic(), {.cycles_per_tick = kCycles, .ticks = kClocks}),
      tim17_(cpu_.nvic(), {.cycles_per_tick = kCycles, .ticks = kClocks}),
      usart2_(kCycles, kClocks),
      dma_(cpu_.nvic()),
      can_(cpu_.nvic(), 21, 22),
      can_memory_(can_),
      debug_(device_id) {
  map(0x40000000, 0x400, tim2_, apb1(0));
  map(0x40003000, 0x400, watchdog_);
  map(0x40004400, 0x400, usart2_, apb1(17));
  map(0x40006800, 0x400, can_, apb1(12));
  map(0x4000B400, 0x800, can_memory_, apb1(12));
  map(0x40012400, 0x400, adc_, apb2(20));
  map(0x40012C00, 0x400, tim1_, apb2(11));
  map(0x40014400, 0x400, tim16_, apb2(17));
  map(0x40014800, 0x400, tim17_, apb2(18));
  map(0x40015800, 0x400, debug_, apb1(27));
  map(0x40020000, 0xC00, dma_, ahb(0));
  map(0x40021000, 0x400, rcc_);
  map(0x40021800, 0x400, exti_);
  map(0x40022000, 0x400, flash_);
  for (std::uint32_t port = 0; port < ports_.size(); ++port)
    map(0x50000000 + 0x400 * port, 0x400, ports_[port], iop(static_cast<int>(port)));
  dma_.fetch = [this](std::uint32_t address) { return cpu_.peek(address); };
  dma_.put = [this](std::uint32_t address, std::uint32_t word, Cycle at) { write(address, word, 4, at); };
  dma_.take = [this](std::uint32_t address, Cycle at) {
    return static_cast<std::uint8_t>(read(address, 1, at));
  };
  dma_.keep = [this](std::uint32_t address, std::uint8_t byte) {
    const unsigned shift = (address & 3) * 8;
    const std::uint32_t word = cpu_.peek(address & ~3u);
    cpu_.poke(address & ~3u, (word & ~(0xFFu << shift)) | std::uint32_t{byte} << shift);
  };
  // RM0444, DMAMUX: request lines 20 to 23 are TIM1's channels, 52 is what USART2 has received.
  usart2_.on_request = [this](Cycle at) { dma_.on_request(52, at); };
  tim1_.on_request = [this](int channel, Cycle at) {
    dma_.on_request(19 + static_cast<std::uint32_t>(channel), at);
  };
}

Stm32g0b1Chip::~Stm32g0b1Chip() = default;

void Stm32g0b1Chip::start() {
  std::memcpy(cpu_.system_memory().data() + (kUniqueId - kSystemMemory), options_.unique_id.data(),
              sizeof options_.unique_id);
  // Of a program without its boot loader in front of it.
  Chip::start(std::ranges::min(image_.pieces, {}, &ElfImage::Piece::address).address, 1);
}

int Stm32g0b1Chip::outputs() const {
  int count = 0;
  for (const GpioPort& port : ports_)
    for (int pin = 0; pin < 16; ++pin) count += port.mode(pin) == GpioPort::Mode::kOutput ? 1 : 0;
  return count;
}

void Stm32g0b1Chip::reset_chip(Rcc::ResetCause cause, Cycle now) {
  rcc_.reset(cause);
  flash_.reset();
  for (GpioPort& port : ports_) port.reset(0xFFFFFFFF);  // analogue; the debug port is not told apart
  exti_.reset();
  tim2_.reset(now);
  tim1_.reset(now);
  tim16_.reset(now);
  tim17_.reset(now);
  usart2_.reset();
  adc_.reset();
  dma_.reset();
  can_.reset();
  if (cause == Rcc::ResetCause::kPowerOn) can_.lose_memory();
}

void Stm32g0b1Chip::advance_chip(Cycle now) {
  tim2_.advance(now);
  tim1_.advance(now);
  tim16_.advance(now);
  tim17_.advance(now);
  usart2_.advance(now);
  adc_.advance(now);
  can_.advance(now);
}

void Stm32g0b1Chip::after_write(Peripheral& written) {
  if (&written != &flash_ || !flash_.take_erased()) return;
  cpu_.forget_code();
  cpu_.stall_until(flash_.busy_until());
}

bool Stm32g0b1Chip::write_flash(std::uint32_t address, std::uint32_t value, int size, Cycle now) {
  const bool changed = flash_.program(address, value, size, now);
  if (changed) cpu_.stall_until(flash_.busy_until());
  return changed;
}

}  // namespace kinebus::emulator
