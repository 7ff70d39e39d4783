#include "node_firmware/port/stm32f446_octopus/step_stage.hpp"

#include <array>

namespace kinebus::stm32 {
namespace {

constexpr std::uint32_t kTop = kApb2Hz * 2 / 1'000'000;  // counts of TIM1 in a slot
// RM0390, DMA2 request mapping: channel 6 is TIM1. By port: the stream, and the event that asks it.
constexpr unsigned kTim1 = 6;
constexpr unsigned kUpdate = 0;  // as Timer::request() counts
struct Request {
  std::size_t stream;
  unsigned event;
};
constexpr std::array<Request, StepPort::kPorts> kRequests{{{1, 1}, {2, 2}, {6, 3}, {4, 4}, {5, kUpdate}}};

std::uint32_t address_of(const volatile void* place) {
  return reinterpret_cast<std::uintptr_t>(place);
}

}  // namespace

PlanCounts StepPort::start(const Frames& frames) {
  enable_clock(rcc().AHB1ENR, Rcc::kDma2);
  enable_clock(rcc().APB2ENR, Rcc::kTim1);
  Timer& t = tim1();
  t.PSC = 0;
  t.ARR = kTop - 1;
  t.CCMR1 = 0;  // compare events, and no output
  // A tick before the update: all ports change together.
  for (Reg& compare : t.CCR) compare = kTop - 1;
  t.EGR = Timer::kGenerateUpdate;
  t.SR = 0;
  for (std::size_t port = 0; port < kPorts; ++port) {
    const Request& request = kRequests[port];
    dma2().clear(request.stream);
    Dma::Stream& s = dma2().stream[request.stream];
    s.NDTR = frames.words(port).size();
    s.PAR = address_of(&gpio(static_cast<unsigned>(kGpio[port])).BSRR);
    s.M0AR = address_of(frames.words(port).data());
    s.FCR = 0;
    s.CR = Dma::channel(kTim1) | Dma::kFromMemory | Dma::kCircular | Dma::kMemoryIncrement |
           Dma::kPeripheralWords | Dma::kMemoryWords | Dma::kPriorityHigh |
           (port == 0 ? Dma::kOnHalf | Dma::kOnComplete : 0);
    s.CR = s.CR | Dma::kEnable;
    t.DIER = t.DIER | Timer::request(static_cast<int>(request.event));
  }
  enable_interrupt(Irq::kDma2Stream1, 3);
  disable_interrupts();
  const PlanCounts now = local_counts();
  t.CR1 = Timer::kEnable;
  enable_interrupts();
  // The first word comes a slot later. An edge comes up to a slot after its ideal time: half of that is taken
  // off by saying that a frame begins half a slot later than it does.
  return now + step::kSlotCounts + step::kSlotCounts / 2;
}

}  // namespace kinebus::stm32
