#include "node_firmware/port/stm32f446_octopus/step_stage.hpp"

namespace kinebus::stm32 {
namespace {

constexpr std::uint32_t kTop = kApb2Hz * 2 / 1'000'000;  // counts of TIM1 in a slot
constexpr unsigned kTim1 = 6;                            // DMA channel: stream 1 by CH1, stream 2 by CH2

std::uint32_t address_of(const volatile void* place) {
  return reinterpret_cast<std::uintptr_t>(place);
}

}  // namespace

PlanCounts StepPort::start(const step::StepFrames<kPorts>& frames) {
  debug_control() = debug_control() | bit(24);
  dwt().CTRL = dwt().CTRL | bit(0);
  enable_clock(rcc().AHB1ENR, Rcc::kDma2);
  enable_clock(rcc().APB2ENR, Rcc::kTim1);
  Timer& t = tim1();
  t.PSC = 0;
  t.ARR = kTop - 1;
  t.CCMR1 = 0;  // compare events, and no output
  for (const std::size_t channel : {0, 1}) t.CCR[channel] = kTop / 2;
  t.EGR = Timer::kGenerateUpdate;
  t.SR = 0;
  t.DIER = Timer::request(1) | Timer::request(2);
  dma2().LIFCR = Dma::flags(1) | Dma::flags(2);
  for (std::size_t port = 0; port < kPorts; ++port) {
    Dma::Stream& s = dma2().stream[port + 1];
    s.NDTR = frames.words(port).size();
    s.PAR = address_of(&gpio(static_cast<unsigned>(kGpio[port])).BSRR);
    s.M0AR = address_of(frames.words(port).data());
    s.FCR = 0;
    s.CR = Dma::channel(kTim1) | Dma::kFromMemory | Dma::kCircular | Dma::kMemoryIncrement |
           Dma::kPeripheralWords | Dma::kMemoryWords | Dma::kPriorityHigh |
           (port == 0 ? Dma::kOnHalf | Dma::kOnComplete : 0);
    s.CR = s.CR | Dma::kEnable;
  }
  enable_interrupt(Irq::kDma2Stream1, 3);
  disable_interrupts();
  const PlanCounts now = local_counts();
  t.CR1 = Timer::kEnable;
  enable_interrupts();
  // The first word comes half a slot later. An edge comes up to a slot after its ideal time: half of that is
  // taken off by saying that a frame begins half a slot later than it does.
  return now + step::kSlotCounts;
}

}  // namespace kinebus::stm32
