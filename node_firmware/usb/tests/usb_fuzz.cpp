// Any bytes as what a host, or a fault on the cable, sends to the node's USB device: setup packets, data, bus
// resets, in any order. It never crashes, never gives more than was asked for, and always comes back.
//
// Input: records of kind and up to 64 bytes.

#include <algorithm>
#include <cstdlib>

#include "node_firmware/usb/cdc_device.hpp"
#include "protocol/bytes.hpp"

namespace kinebus {
namespace {

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
    switch (kind % 6) {
      case 0:
      case 1:
        if (in.size() < 8) return in.size() + 1;
        setup(in.first<8>());
        used = 8;
        break;
      case 2:
      case 3: {
        used = std::min<std::size_t>(in.size(), kind >> 3);  // at most 31
        if (kind % 6 == 2)
          device_.on_control_data(in.first(used));
        else if (device_.takes_data())
          device_.on_data(in.first(used));
        break;
      }
      case 4:
        drain_control();
        break;
      case 5:
        if (kind == 0xFB) {
          device_.on_reset();
          check(device_.control().address() == 0 && !device_.control().open() &&
                device_.control().take_changes() == 7);
          allowed_ = 0;
        } else {
          drain_data();
        }
        break;
    }
    look();
    return used + 1;
  }
  /// Whatever was before: a host can begin anew.
  void begin_anew() {
    device_.on_reset();
    setup(std::array<std::uint8_t, 8>{0x80, 6, 0, 1, 0, 0, 18, 0});
    const auto packet = device_.control().next_packet();
    check(packet && packet->size() == 18 && !device_.control().next_packet());
    setup(std::array<std::uint8_t, 8>{0x00, 5, 9, 0, 0, 0, 0, 0});
    check(device_.control().next_packet().has_value() && device_.control().address() == 9);
    setup(std::array<std::uint8_t, 8>{0x00, 9, 1, 0, 0, 0, 0, 0});
    check(device_.control().next_packet().has_value() && device_.control().open() && device_.takes_data());
  }

 private:
  void setup(std::span<const std::uint8_t, 8> bytes) {
    device_.on_setup(bytes);
    allowed_ = get_u16_le(bytes.subspan(6));
  }
  void drain_control() {
    for (int packets = 0; const auto packet = device_.control().next_packet(); ++packets) {
      check(packets < 3 && packet->size() <= cdc::kPacketBytes && packet->size() <= allowed_);
      // Read it all: nothing points outside.
      for (const std::uint8_t byte : *packet) sum_ = static_cast<std::uint8_t>(sum_ + byte);
      allowed_ -= packet->size();
    }
  }
  void drain_data() {
    int count = 0;
    while (device_.next_char()) check(++count <= 64);
    device_.take_hang_up();
    if (const auto packet = device_.next_notification())
      check(packet->size() == 10 && device_.control().open());
  }
  void look() {
    check(device_.control().address() <= 127);
    check(device_.control().take_changes() <= 7);
    check(!device_.control().stalled() || !device_.control().next_packet());
    if (!device_.control().open())
      for (int slot = 0; slot < CdcDevice::kSlots; ++slot)
        check(!device_.control().halted(static_cast<CdcDevice::Slot>(slot)) && !device_.takes_data());
  }

  CdcDevice device_;
  std::size_t allowed_ = 0;
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
