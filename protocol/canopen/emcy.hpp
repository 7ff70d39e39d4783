#pragma once
// Emergency messages: error register (1001h), history (1003h), inhibit time (1015h).

#include <array>
#include <cstdint>
#include <optional>

#include "protocol/can/frame.hpp"
#include "protocol/canopen/alarm_codes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/time.hpp"

namespace kinebus {

namespace emcy {
/// Bits of the error register.
inline constexpr std::uint8_t kGeneric = 0x01, kCurrent = 0x02, kVoltage = 0x04, kTemperature = 0x08,
                              kCommunication = 0x10, kProfile = 0x20, kVendor = 0x80;
/// The bit that an error code belongs to, kGeneric included.
constexpr std::uint8_t register_bits(std::uint16_t code) {
  switch (code >> 12) {
    case 0x2:
      return kGeneric | kCurrent;
    case 0x3:
      return kGeneric | kVoltage;
    case 0x4:
      return kGeneric | kTemperature;
    case 0x8:
      return (code >> 8) >= 0x84 ? kGeneric | kProfile : kGeneric | kCommunication;
    case 0xF:
      return kGeneric | kVendor;
    default:
      return code == 0 ? std::uint8_t{0} : kGeneric;
  }
}
}  // namespace emcy

struct Emergency {
  std::uint8_t node = 0;
  std::uint16_t code = 0;  ///< 0: error reset / no error
  std::uint8_t error_register = 0;
  std::array<std::uint8_t, 5> vendor{};
  friend constexpr bool operator==(const Emergency&, const Emergency&) = default;
};
CanFrame encode(const Emergency& emergency);
/// nullopt: not an EMCY of the pre-defined connection set (SYNC, 080h, is none).
std::optional<Emergency> decode_emcy(const CanFrame& frame);

/// Queues what is to be told, keeps the register and the history. An emergency that does not fit the queue is
/// counted; it is in the history all the same.
class EmcyProducer {
 public:
  static constexpr std::size_t kHistory = 8;
  static constexpr std::size_t kQueue = 8;

  void set_inhibit_time(LocalTime time) { inhibit_ = time; }
  /// An error has come. `urgent`: not held back by the inhibit time, and sent before others (stop requests).
  void raise(std::uint16_t code, std::array<std::uint8_t, 5> vendor = {}, bool urgent = false);
  /// That error has gone. With the last one an EMCY 0000h tells so.
  void clear(std::uint16_t code);
  /// All errors have gone (fault reset).
  void clear_all();

  std::optional<CanFrame> next_frame(LocalTime now, std::uint8_t node);
  /// What waits is not told (1014h is off).
  void discard() { count_ = 0; }
  LocalTime next_deadline() const;

  std::uint8_t error_register() const;
  bool active(std::uint16_t code) const;
  std::uint8_t history_length() const { return history_length_; }
  /// 1003h:1 is the newest (place 0): code, and the first two vendor bytes above it.
  std::uint32_t history(std::size_t place) const { return history_[place]; }
  void clear_history() { history_length_ = 0; }
  std::uint32_t sent() const { return sent_; }
  std::uint32_t lost() const { return lost_; }

 private:
  struct Item {
    std::uint16_t code = 0;
    std::uint8_t error_register = 0;
    std::array<std::uint8_t, 5> vendor{};
    bool urgent = false;
  };
  void queue(const Item& item);

  std::array<std::uint16_t, 16> active_{};  // 0: free
  std::array<std::uint32_t, kHistory> history_{};
  std::uint8_t history_length_ = 0;
  std::array<Item, kQueue> items_{};
  std::size_t count_ = 0;
  LocalTime inhibit_{0}, allowed_{LocalTime::min()};
  std::uint32_t sent_ = 0, lost_ = 0;
};

}  // namespace kinebus
