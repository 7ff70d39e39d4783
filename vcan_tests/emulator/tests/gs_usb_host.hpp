#pragma once
// A computer with Linux's gs_usb driver, written from what that driver does: enumeration, its requests, ten
// echo contexts, a frame an URB, time stamps. Behind it the board's bus as its only way to the nodes: it
// takes the gateway's place of a NodeMachine.

#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "protocol/bytes.hpp"
#include "vcan_tests/emulator/emulated_machine.hpp"
#include "vcan_tests/emulator/tests/usb_host.hpp"

namespace kinebus::emulator {

class GsUsbHost final : public NodeMachine {
 public:
  struct Heard {
    BusTime at{0};            ///< when it came out of the cable
    std::uint32_t stamp = 0;  ///< the device's microseconds
    std::uint32_t can_id = 0;
    bool echo = false;
    std::array<std::uint8_t, 8> data{};
  };
  GsUsbHost(EmulatedMachine& machine, UsbSocket& socket)
      : machine_(machine), socket_(socket), control_(socket, [this](BusTime span) { pass(span); }) {
    machine_.set_gateway_on_wire(false);
  }

  void plug() { socket_.set_usb_cable(true); }
  void unplug() {
    socket_.set_usb_cable(false);
    up_ = false;
    contexts_ = {};
    sending_.clear();
  }
  /// The driver binds to the device; false: it gives up.
  bool probe() {
    if (!control_.configure()) return false;
    const auto device = control_.read({0x80, 6, 0x0100, 0, 18});
    if (!device || get_u16_le(std::span(*device).subspan(8)) != 0x1D50 ||
        get_u16_le(std::span(*device).subspan(10)) != 0x606F)
      return false;
    if (!control_.command({0x41, 0, 1, 0, 4}, {0xEF, 0xBE, 0, 0})) return false;
    const auto config = control_.read({0xC1, 5, 1, 0, 12});
    if (!config || config->size() != 12 || (*config)[3] != 0) return false;
    const auto timing = control_.read({0xC1, 4, 0, 0, 40});
    if (!timing || timing->size() != 40) return false;
    feature_ = get_u32_le(*timing);
    clock_ = get_u32_le(std::span(*timing).subspan(4));
    return true;
  }
  /// ip link set can0 up type can bitrate ...; false: refused.
  bool up(std::uint32_t bit_rate = 1'000'000) {
    const std::uint32_t quanta = 21, prescaler = clock_ / (bit_rate * quanta);
    UsbHost::Bytes words(20);
    for (const auto& [at, value] : {std::pair{0, 7u}, {1, 8u}, {2, 5u}, {3, 1u}, {4, prescaler}})
      put_u32_le(std::span(words).subspan(static_cast<std::size_t>(4 * at)), value);
    if (!control_.command({0x41, 1, 0, 0, 20}, words)) return false;
    if (!stamp()) return false;
    UsbHost::Bytes mode{1, 0, 0, 0, 0x10, 0, 0, 0};
    if ((feature_ & 0x10) == 0 || !control_.command({0x41, 2, 0, 0, 8}, mode)) return false;
    toggles_ = {};
    contexts_ = {};
    return up_ = true;
  }
  void down() {
    up_ = false;
    EXPECT_TRUE(control_.command({0x41, 2, 0, 0, 8}, UsbHost::Bytes(8)));
  }
  std::optional<std::uint32_t> stamp() {
    const auto got = control_.read({0xC1, 6, 0, 0, 4});
    return got && got->size() == 4 ? std::optional(get_u32_le(*got)) : std::nullopt;
  }
  /// State, receive errors, transmit errors.
  std::array<std::uint32_t, 3> state() {
    std::array<std::uint32_t, 3> words{};
    const auto got = control_.read({0xC1, 14, 0, 0, 12});
    for (std::size_t i = 0; got && got->size() == 12 && i < 3; ++i)
      words[i] = get_u32_le(std::span(*got).subspan(4 * i));
    return words;
  }
  UsbHost& control() { return control_; }

  // NodeMachine.
  bool can_send() const override {
    return up_ && std::ranges::any_of(contexts_, [](const auto& c) { return !c; });
  }
  void send(BusTime, const CanFrame& frame) override {
    for (std::size_t i = 0; i < contexts_.size(); ++i) {
      if (contexts_[i]) continue;
      contexts_[i] = frame;
      UsbHost::Bytes bytes(20);
      put_u32_le(bytes, static_cast<std::uint32_t>(i));
      put_u32_le(std::span(bytes).subspan(4), frame.id | (frame.extended ? 1u << 31 : 0));
      bytes[8] = frame.length;
      std::ranges::copy(frame.data, bytes.begin() + 12);
      sending_.push_back(bytes);
      return;
    }
    ADD_FAILURE() << "no free context";
  }
  std::optional<Received> receive() override {
    if (received_.empty()) return std::nullopt;
    const Received first = received_.front();
    received_.pop_front();
    return first;
  }
  BusTime next_event() const override { return machine_.next_event(); }
  bool advance(BusTime now) override {
    while (machine_.now() < now) {
      step(std::min(machine_.now() + kTurn, now));
      if (!received_.empty() && machine_.now() < now) return false;
    }
    return received_.empty();
  }
  double true_counts(int node, int axis, BusTime at) override { return machine_.true_counts(node, axis, at); }
  PathTime path_time(int node, BusTime at) override { return machine_.path_time(node, at); }
  int node_count() const override { return machine_.node_count(); }
  const BusModel& bus() const override { return machine_.bus(); }
  void set_input(int node, BusTime at, int input, bool level) override {
    machine_.set_input(node, at, input, level);
  }

  std::vector<Heard> heard;
  /// What was on the wire, and when its last bit but one was.
  std::vector<Received> wire;
  /// Frames are said to have come when the device says, not when they came out of the cable.
  bool by_device_clock = true;
  int strange_echoes = 0, overflows = 0;

 private:
  // A packet each way: 24 and 20 bytes with all that goes with them are 45 us at 12 Mbit/s.
  static constexpr BusTime kTurn = 50us;

  void pass(BusTime span) {
    for (const BusTime end = machine_.now() + span; machine_.now() < end;)
      step(std::min(machine_.now() + kTurn, end));
  }
  void step(BusTime to) {
    while (!machine_.advance(to)) drain_wire();
    drain_wire();
    if (!up_) return;
    OtgHs& usb = socket_.usb();
    if (!sending_.empty() &&
        usb.out(control_.address(), 2, sending_.front(), toggles_[0]) == OtgHs::Answer::kAck) {
      toggles_[0] ^= 1;
      sending_.pop_front();
    }
    const auto got = usb.in(control_.address(), 1);
    if (got.answer != OtgHs::Answer::kAck) return;
    EXPECT_EQ(got.toggle, toggles_[1]);
    toggles_[1] ^= 1;
    take(got.bytes);
  }
  // The driver's time counter, begun with the first frame.
  BusTime stamped(const Heard& h) {
    if (!device_began_) device_began_ = std::pair{h.at, h.stamp};
    const BusTime at = device_began_->first +
                       std::chrono::microseconds{static_cast<std::int32_t>(h.stamp - device_began_->second)};
    return by_device_clock ? at : h.at;
  }
  void drain_wire() {
    while (const auto got = machine_.receive()) wire.push_back(*got);
  }
  void take(const UsbHost::Bytes& bytes) {
    ASSERT_EQ(bytes.size(), 24u);
    const std::uint32_t echo = get_u32_le(bytes), id = get_u32_le(std::span(bytes).subspan(4));
    EXPECT_EQ(bytes[9], 0) << "channel";
    if ((bytes[10] & 1) != 0) ++overflows;
    Heard h{machine_.now(), get_u32_le(std::span(bytes).subspan(20)), id, echo != 0xFFFF'FFFF, {}};
    std::copy_n(bytes.begin() + 12, 8, h.data.begin());
    heard.push_back(h);
    if ((id & 1u << 29) != 0) return;
    CanFrame frame = CanFrame::from_bytes(id & 0x1FFF'FFFF, std::span(bytes).subspan(12, bytes[8]));
    frame.extended = (id & 1u << 31) != 0;
    if (h.echo) {
      if (echo >= contexts_.size() || !contexts_[echo] || *contexts_[echo] != frame) {
        ++strange_echoes;
        return;
      }
      contexts_[echo].reset();
    }
    received_.push_back({stamped(h), h.echo, frame});
  }

  EmulatedMachine& machine_;
  UsbSocket& socket_;
  UsbHost control_;
  bool up_ = false;
  std::uint32_t feature_ = 0, clock_ = 0;
  std::optional<std::pair<BusTime, std::uint32_t>> device_began_;
  std::array<int, 2> toggles_{};
  std::array<std::optional<CanFrame>, 10> contexts_;
  std::deque<UsbHost::Bytes> sending_;
  std::deque<Received> received_;
};

}  // namespace kinebus::emulator
