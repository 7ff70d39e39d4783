#pragma once
// A cable from an emulated board's USB connector to a computer that speaks USB/IP, so that Linux's real
// drivers enumerate the image: cdc_acm makes a /dev/ttyACM of it, gs_usb a can0.

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "protocol/time.hpp"
#include "vcan_tests/emulator/usb_line.hpp"
#include "vcan_tests/emulator/usb_socket.hpp"

namespace kinebus::emulator {

class UsbCable {
 public:
  /// A packet each way takes so long at 12 Mbit/s.
  static constexpr BusTime kTurn = std::chrono::microseconds{50};

  UsbCable(UsbSocket& board, UsbLine& line) : board_(board), line_(line) {}
  ~UsbCable() { pull(); }
  UsbCable(const UsbCable&) = delete;
  UsbCable& operator=(const UsbCable&) = delete;

  /// Call after each kTurn of the board's time: a transaction for whoever waits. What comes from the computer
  /// now has been sent at `sent` of the board's time, which is not before `now` where the board is late.
  void serve(BusTime now, BusTime sent);

 private:
  struct Urb {
    BusTime due{0};
    std::uint32_t sequence = 0;
    int endpoint = 0;
    bool in = false;
    std::uint32_t length = 0;
    std::array<std::uint8_t, 8> setup{};
    std::vector<std::uint8_t> data;  // to send, or received so far
    enum class Stage : std::uint8_t { kSetup, kData, kStatus } stage = Stage::kData;
    std::size_t sent = 0;
    int toggle = 1;  // of the control endpoint
  };
  void pull();
  void give_address();
  void take_requests(BusTime sent);
  void take(const std::vector<std::uint8_t>& request, BusTime sent);
  /// True: done, with this status.
  bool advance(Urb& urb, int& status);
  bool advance_in(Urb& urb, int& status);
  bool advance_out(Urb& urb, int& status);
  void finish(const Urb& urb, int status);
  void note_toggles(const Urb& urb);

  UsbSocket& board_;
  UsbLine& line_;
  bool plugged_ = false, addressed_ = false;
  int address_step_ = 0;
  std::vector<std::uint8_t> input_;
  std::deque<Urb> urbs_;
  int out_toggle_ = 0;
};

}  // namespace kinebus::emulator
