#include "node_firmware/port/stm32g0b1_ebb/step_stage.hpp"

#include <array>

namespace kinebus::g0b1 {
namespace {

constexpr std::uint32_t kPrescaler = 8, kTop = kCoreHz / kPrescaler / 1'000'000;  // counts of TIM1 in a slot

struct Lane {
  Timer& output;        // its channel 1
  std::size_t channel;  // of DMA1: [0] is channel 1
  std::uint32_t request, interrupts;
};

std::uint32_t address_of(const volatile void* place) {
  return reinterpret_cast<std::uintptr_t>(place);
}

// Low. A forced mode needs no count; it runs all the same.
void start_output(Timer& t) {
  t.CCMR1 = step::ForcedWords::low(step::ForcedWords::kChannel1);
  t.CCER = bit(0);
  t.BDTR = Timer::kMainOutput;
  t.CR1 = Timer::kEnable;
}

}  // namespace

PlanCounts StepPort::start(const Frames& frames) {
  enable_clock(rcc().AHBENR, Rcc::kDma1);
  enable_clock(rcc().APBENR2, Rcc::kTim1 | Rcc::kTim16 | Rcc::kTim17);
  Timer& t = tim1();
  t.PSC = kPrescaler - 1;
  t.ARR = kTop - 1;
  t.CCMR1 = 0;          // compare events, and no output
  t.CCR[0] = kTop / 2;  // both at once
  t.CCR[1] = kTop / 2;
  t.EGR = Timer::kGenerateUpdate;
  t.SR = 0;
  t.DIER = Timer::request(1) | Timer::request(2);
  const std::array<Lane, kPorts> lanes{{{tim16(), 0, DmaMux::kTim1Channel1, Dma::kOnHalf | Dma::kOnComplete},
                                        {tim17(), 2, DmaMux::kTim1Channel2, 0}}};
  for (std::size_t port = 0; port < kPorts; ++port) {
    const Lane& lane = lanes[port];
    start_output(lane.output);
    dma_mux().CCR[lane.channel] = lane.request;
    Dma::Channel& c = dma1().channel[lane.channel];
    dma1().IFCR = Dma::all_of(lane.channel);
    c.CNDTR = frames.words(port).size();
    c.CPAR = address_of(&lane.output.CCMR1);
    c.CMAR = address_of(frames.words(port).data());
    c.CCR = Dma::kFromMemory | Dma::kCircular | Dma::kMemoryIncrement | Dma::kPeripheralWords |
            Dma::kMemoryWords | Dma::kPriorityHighest | lane.interrupts;
    c.CCR = c.CCR | Dma::kEnable;
  }
  configure_pins<ebb::kAxisPins>();
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
