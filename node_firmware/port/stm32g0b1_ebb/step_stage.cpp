#include "node_firmware/port/stm32g0b1_ebb/step_stage.hpp"

namespace kinebus::g0b1 {
namespace {

constexpr std::uint32_t kPrescaler = 8, kTop = kCoreHz / kPrescaler / 1'000'000;  // counts of TIM1 in a slot

std::uint32_t address_of(const volatile void* place) {
  return reinterpret_cast<std::uintptr_t>(place);
}

}  // namespace

PlanCounts StepPort::start(const step::StepFrames<kPorts>& frames) {
  enable_clock(rcc().AHBENR, Rcc::kDma1);
  enable_clock(rcc().APBENR2, Rcc::kTim1);
  Timer& t = tim1();
  t.PSC = kPrescaler - 1;
  t.ARR = kTop - 1;
  t.CCMR1 = 0;  // compare events, and no output
  t.CCR[0] = kTop / 2;
  t.EGR = Timer::kGenerateUpdate;
  t.SR = 0;
  t.DIER = Timer::request(1);
  dma_mux().CCR[0] = DmaMux::kTim1Channel1;
  Dma::Channel& c = dma1().channel[0];
  dma1().IFCR = Dma::kAllOfChannel1;
  c.CNDTR = frames.words(0).size();
  c.CPAR = address_of(&gpio(static_cast<unsigned>(ebb::kStep.port)).BSRR);
  c.CMAR = address_of(frames.words(0).data());
  c.CCR = Dma::kFromMemory | Dma::kCircular | Dma::kMemoryIncrement | Dma::kPeripheralWords |
          Dma::kMemoryWords | Dma::kPriorityHighest | Dma::kOnHalf | Dma::kOnComplete;
  c.CCR = c.CCR | Dma::kEnable;
  enable_interrupt(Irq::kDma1Channel1, 2);
  disable_interrupts();
  const PlanCounts now = local_counts();
  t.CR1 = Timer::kEnable;
  enable_interrupts();
  // The first word comes half a slot later. An edge comes up to a slot after its ideal time: half of that is
  // taken off by saying that a frame begins half a slot later than it does.
  return now + step::kSlotCounts;
}

}  // namespace kinebus::g0b1
