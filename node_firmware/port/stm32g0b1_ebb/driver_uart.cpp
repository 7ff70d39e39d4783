#include "node_firmware/port/stm32g0b1_ebb/driver_uart.hpp"

#include <algorithm>

#include "node_firmware/port/stm32g0b1_ebb/board.hpp"
#include "node_firmware/port/stm32g0b1_ebb/clock_tree.hpp"
#include "node_firmware/port/stm32g0b1_ebb/pins.hpp"

namespace kinebus::g0b1 {
namespace {

constexpr std::uint32_t kBaud = 40'000;
static_assert(kCoreHz % kBaud == 0);
static_assert(std::tuple_size_v<decltype(step::Exchange::bytes)> <= Usart::kFifoBytes);

Dma::Channel& channel() {
  return dma1().channel[1];
}
std::uint32_t address_of(const volatile void* place) {
  return reinterpret_cast<std::uintptr_t>(place);
}

}  // namespace

void DriverUart::start() {
  Gpio& port = gpio(static_cast<unsigned>(ebb::kDriverWire.port));
  port.OTYPER = port.OTYPER | bit(ebb::kDriverWire.number);
  enable_clock(rcc().AHBENR, Rcc::kDma1);
  enable_clock(rcc().APBENR1, Rcc::kUsart2);
  Usart& u = usart2();
  u.BRR = kCoreHz / kBaud;
  u.CR2 = Usart::kPinsSwapped;  // the one wire is TX, and the pin is RX's
  u.CR3 = Usart::kOneWire | Usart::kReceivedToDma;
  u.CR1 = Usart::kFifos | Usart::kTransmitter | Usart::kReceiver | Usart::kEnable;
  dma_mux().CCR[1] = DmaMux::kUsart2Receive;
  channel().CPAR = address_of(&u.RDR);
}

void DriverUart::begin(std::size_t, const step::Exchange& exchange) {
  Usart& u = usart2();
  u.RQR = Usart::kForgetReceived;
  u.ICR = Usart::kErrors;
  Dma::Channel& c = channel();
  c.CCR = 0;
  c.CNDTR = exchange.hears;
  c.CMAR = address_of(heard_.data());
  c.CCR = Dma::kMemoryIncrement | Dma::kEnable;
  for (const std::uint8_t byte : exchange.said()) u.TDR = byte;
}

bool DriverUart::done() const {
  return channel().CNDTR == 0;
}

std::size_t DriverUart::take(std::span<std::uint8_t> heard) const {
  const std::size_t came = heard.size() - std::min<std::size_t>(heard.size(), channel().CNDTR);
  channel().CCR = 0;
  barrier();
  std::copy_n(heard_.begin(), came, heard.begin());
  return came;
}

}  // namespace kinebus::g0b1
