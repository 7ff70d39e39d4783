#pragma once
// A computer at the board's USB connector: transactions with data toggles and patience, enumeration, the
// serial port's bytes. Time passes by the function that it is given.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string>

#include "protocol/bytes.hpp"
#include "protocol/time.hpp"
#include "vcan_tests/emulator/usb_socket.hpp"

namespace kinebus::emulator {

using namespace std::chrono_literals;

class UsbHost {
 public:
  using Bytes = OtgHs::Bytes;
  using Answer = OtgHs::Answer;
  struct Request {
    std::uint8_t type = 0, request = 0;
    std::uint16_t value = 0, index = 0, length = 0;
  };

  UsbHost(UsbSocket& board, std::function<void(BusTime)> pass) : board_(board), pass_(std::move(pass)) {}

  void plug() { board_.set_usb_cable(true); }
  void unplug() { board_.set_usb_cable(false); }
  bool sees_device() { return board_.usb_device_seen(); }
  /// False: no device came within a second.
  bool wait_for_device() {
    for (int i = 0; i < 100 && !sees_device(); ++i) pass_(10ms);
    return sees_device();
  }
  void reset() {
    board_.usb().bus_reset();
    pass_(10ms);
    address_ = 0;
    toggles_ = {};
  }
  /// What a computer does with a new serial port; false: it gives up.
  bool enumerate(int address = 7) { return configure(address) && command({0x21, 0x22, 3}); }
  /// With any new device.
  bool configure(int address = 7) {
    if (!wait_for_device()) return false;
    reset();
    const auto first = read({0x80, 6, 0x0100, 0, 64});
    if (!first || first->size() != 18 || (*first)[7] != 64) return false;
    reset();
    if (!command({0x00, 5, static_cast<std::uint16_t>(address)})) return false;
    address_ = address;
    pass_(2ms);
    const auto device = read({0x80, 6, 0x0100, 0, 18});
    const auto head = read({0x80, 6, 0x0200, 0, 9});
    if (!device || !head || head->size() != 9) return false;
    const auto all = read({0x80, 6, 0x0200, 0, get_u16_le(std::span(*head).subspan(2))});
    if (!all || all->size() != get_u16_le(std::span(*head).subspan(2))) return false;
    if (read({0x80, 6, 0x0600, 0, 10})) return false;  // no high speed: stalled
    return command({0x00, 9, 1});
  }
  std::string text(std::uint16_t index) {
    const auto got = read({0x80, 6, static_cast<std::uint16_t>(0x0300 + index), 0x0409, 255});
    std::string out;
    for (std::size_t i = 2; got && i + 1 < got->size(); i += 2) out += static_cast<char>((*got)[i]);
    return out;
  }

  /// The data stage; nothing: stalled, or no answer.
  std::optional<Bytes> read(const Request& request) {
    if (setup(request) != Answer::kAck) return std::nullopt;
    Bytes all;
    int toggle = 1;
    for (;;) {
      const auto got = in(0, toggle);
      if (!got) return std::nullopt;
      toggle ^= 1;
      all.insert(all.end(), got->begin(), got->end());
      if (got->size() < 64 || all.size() >= request.length) break;
    }
    EXPECT_LE(all.size(), request.length);
    return out(0, {}, 1) ? std::optional(all) : std::nullopt;
  }
  /// A request without data, or with data for the device. False: stalled, or no answer.
  bool command(const Request& request, const Bytes& data = {}) {
    if (setup(request) != Answer::kAck) return false;
    if (!data.empty() && !out(0, data, 1)) return false;
    const auto status = in(0, 1);
    return status && status->empty();
  }

  /// To the serial port. False: the device holds it off.
  bool write(const std::string& text) {
    if (!out(1, Bytes(text.begin(), text.end()), toggles_[0])) return false;
    toggles_[0] ^= 1;
    return true;
  }
  /// One packet of the serial port; empty: none within the patience.
  std::string read_packet() {
    const auto got = in(1, toggles_[1]);
    if (!got) return {};
    toggles_[1] ^= 1;
    return {got->begin(), got->end()};
  }
  /// What is asked and the whole answer.
  std::string ask(const std::string& letters) {
    EXPECT_TRUE(write(letters)) << letters;
    std::string all;
    for (std::string packet = read_packet(); !packet.empty(); packet = read_packet()) all += packet;
    return all;
  }
  std::optional<Bytes> notification() {
    auto got = in(2, toggles_[2]);
    if (got) toggles_[2] ^= 1;
    return got;
  }
  /// An endpoint's toggle after CLEAR_FEATURE(ENDPOINT_HALT): 0 OUT, 1 IN, 2 notify.
  void forget_toggle(std::size_t which) { toggles_[which] = 0; }

  int address() const { return address_; }

  Answer setup(const Request& r) {
    std::array<std::uint8_t, 8> bytes{r.type, r.request};
    put_u16_le(std::span(bytes).subspan(2), r.value);
    put_u16_le(std::span(bytes).subspan(4), r.index);
    put_u16_le(std::span(bytes).subspan(6), r.length);
    const Answer answer = board_.usb().setup(address_, bytes);
    pass_(kTry);
    return answer;
  }

 private:
  static constexpr BusTime kTry = 100us;
  static constexpr int kTries = 100;

  std::optional<Bytes> in(int endpoint, int toggle) {
    for (int i = 0; i < kTries; ++i) {
      const auto got = board_.usb().in(address_, endpoint);
      if (got.answer == Answer::kAck) {
        EXPECT_EQ(got.toggle, toggle) << "endpoint " << endpoint;
        pass_(kTry);
        return got.bytes;
      }
      if (got.answer != Answer::kNak) return std::nullopt;
      pass_(kTry);
    }
    return std::nullopt;
  }
  bool out(int endpoint, const Bytes& bytes, int toggle) {
    for (int i = 0; i < kTries; ++i) {
      const Answer answer = board_.usb().out(address_, endpoint, bytes, toggle);
      pass_(kTry);
      if (answer == Answer::kAck) return true;
      if (answer != Answer::kNak) return false;
    }
    return false;
  }

  UsbSocket& board_;
  std::function<void(BusTime)> pass_;
  int address_ = 0;
  std::array<int, 3> toggles_{};
};

}  // namespace kinebus::emulator
