#include "node_firmware/port/stm32f405/usb_port.hpp"

#include <algorithm>

#include "node_firmware/port/stm32f4/clock_tree.hpp"
#include "node_firmware/port/stm32f4/local_time.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"
#include "node_firmware/port/stm32f405/board.hpp"

namespace kinebus::stm32 {
namespace {

// A plug's contacts come to rest, and the core has become a device (25 ms).
constexpr std::uint32_t kSettle = kLocalHz / 20;

}  // namespace

std::optional<CdcDevice::Packet> ConsoleDevice::next_packet(std::size_t slot) {
  if (slot == kNotifyIn) return next_notification();
  const auto text = console_.waiting();
  if (text.empty()) return std::nullopt;
  const std::size_t count = std::min(text.size(), text_.size());
  std::copy_n(text.begin(), count, text_.begin());
  console_.sent(count);
  return std::span(text_).first(count);
}

void OtgHsCore::enable() {
  // The core would wait for an external PHY's clock whenever the processor sleeps.
  rcc().AHB1LPENR = rcc().AHB1LPENR & ~Rcc::kUsbUlpi;
  enable_clock(rcc().AHB1ENR, Rcc::kUsbHs);
}

void UsbPort::start() {
  good_ = otg_.start();
}

void UsbPort::serve(const Console::Subject& subject) {
  if (!good_) return;
  const std::uint32_t counts = local_counts();
  if (!read(board::kUsbVbus)) {
    cable_since_ = counts;
    if (otg_.attached()) otg_.detach();
  } else if (!otg_.attached() && counts - cable_since_ > kSettle) {
    otg_.attach();
  }
  if (!otg_.attached()) return;
  Console& console = device_.console();
  if (console.waiting().empty())
    if (const auto letter = device_.next_char()) console.hear(*letter, subject);
  otg_.serve();
  if (device_.take_hang_up()) {
    console.forget();
    otg_.stop_sending(ConsoleDevice::kEndpoints[CdcDevice::kDataIn].number());
  }
}

}  // namespace kinebus::stm32
