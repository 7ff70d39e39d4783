// Any bytes as what a host, or a fault on the cable, sends to the board's CAN interface: setup packets, their
// data, frames, bus resets, while the bus takes and gives. It never crashes, gives no more than was asked
// for, no echo that was not owed, and always comes back.
//
// Input: records of kind and up to 64 bytes.

#include <algorithm>
#include <cstdlib>

#include "node_firmware/usb/gs_usb_device.hpp"
#include "protocol/bytes.hpp"

namespace kinebus {
namespace {

constexpr GsUsbFacts kFacts{.clock_hz = 42'000'000, .bit_rate = 1'000'000};

void check(bool good) {
  if (!good) std::abort();
}

class Session {
 public:
  /// The bytes it took.
  std::size_t turn(std::span<const std::uint8_t> in) {
    const std::uint8_t kind = in[0];
    in = in.subspan(1);
    std::size_t used = 0;
    switch (kind % 8) {
      case 0:
      case 1:
        if (in.size() < 8) return in.size() + 1;
        setup(in.first<8>());
        used = 8;
        break;
      case 2:
        used = std::min<std::size_t>(in.size(), kind >> 2);
        device_.on_control_data(in.first(used));
        break;
      case 3:
        used = std::min<std::size_t>({in.size(), std::size_t{20} + (kind >> 3), usb::kPacketBytes});
        if (device_.takes_data()) device_.on_data(in.first(used));
        break;
      case 4:
        drain_control();
        break;
      case 5:
        for (int i = 0; i < (kind >> 3); ++i) bus_turn();
        break;
      case 6:
        device_.on_received(CanFrame::from_bytes(kind, in.first(std::min<std::size_t>(in.size(), kind >> 5))),
                            ++now_);
        break;
      default:
        if (kind == 0xFF)
          device_.on_reset();
        else if (kind == 0xF7)
          device_.on_suspend();
        else
          take_data(kind >> 3);
        break;
    }
    check(!device_.control().stalled() || !device_.control().next_packet());
    check(device_.control().open() || (!device_.started() && !device_.takes_data()));
    return used + 1;
  }
  /// Whatever was before: a host can begin anew.
  void begin_anew() {
    device_.on_reset();
    setup(std::array<std::uint8_t, 8>{0x00, 5, 9, 0, 0, 0, 0, 0});
    drain_control();
    setup(std::array<std::uint8_t, 8>{0x00, 9, 1, 0, 0, 0, 0, 0});
    drain_control();
    setup(std::array<std::uint8_t, 8>{0x41, 2, 0, 0, 0, 0, 8, 0});
    device_.on_control_data(std::array<std::uint8_t, 8>{1});
    check(device_.control().next_packet().has_value() && device_.started());
    check(!device_.next_data() && device_.next_frame() == nullptr);
    device_.on_data(std::array<std::uint8_t, 20>{7});
    check(device_.next_frame() != nullptr && device_.next_frame()->ticket.echo == 7);
  }

 private:
  void setup(std::span<const std::uint8_t, 8> bytes) {
    device_.on_setup(bytes, ++now_);
    allowed_ = get_u16_le(bytes.subspan(6));
  }
  void drain_control() {
    for (int packets = 0; const auto packet = device_.control().next_packet(); ++packets) {
      check(packets < 3 && packet->size() <= usb::kPacketBytes && packet->size() <= allowed_);
      for (const std::uint8_t byte : *packet) sum_ = static_cast<std::uint8_t>(sum_ + byte);
      allowed_ -= packet->size();
    }
  }
  void bus_turn() {
    const auto* next = device_.next_frame();
    if (next == nullptr) return;
    check(next->frame.length <= 8 && next->frame.id <= 0x1FFF'FFFF);
    if (next->ticket.echo != gs_usb::kNoEcho) ++owed_;
    device_.on_sent(next->ticket, next->frame, ++now_);
    device_.drop_frame();
  }
  void take_data(int most) {
    for (int i = 0; i < most; ++i) {
      const auto packet = device_.next_data();
      if (!packet) return;
      check(packet->size() == 20 || packet->size() == 24);
      if (get_u32_le(*packet) != gs_usb::kNoEcho) check(owed_-- > 0);
    }
  }

  GsUsbDevice device_{kFacts};
  std::size_t allowed_ = 0;
  std::uint32_t now_ = 0;
  int owed_ = 0;
  std::uint8_t sum_ = 0;
};

}  // namespace
}  // namespace kinebus

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kinebus::Session session;
  std::span<const std::uint8_t> in(data, size);
  for (int i = 0; i < 400 && !in.empty(); ++i) in = in.subspan(session.turn(in));
  session.begin_anew();
  return 0;
}
