#pragma once
// A job that a heater's fault holds, or filament that does not come: how far that is, why, and when it is
// mended. And one that is set aside, which is lifted the same way and then interrupted.

#include <cstdint>
#include <optional>
#include <utility>

#include "gateway/devices/devices.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class HeatHold {
 public:
  enum class Stage : std::uint8_t {
    kNone,
    kStops,  ///< on the path, then positions are read
    kLifts,
    kHolds,
    kMends,  ///< resume is asked for, and the device is to show that it is in order
  };
  enum class Mended : std::uint8_t { kNotYet, kYes, kNo };

  Stage stage() const { return stage_; }
  bool is(Stage stage) const { return stage_ == stage; }
  void begin() { stage_ = Stage::kStops; }
  enum class Aside : std::uint8_t { kNo, kByCommand, kForFilament };
  /// Nothing is wrong: the machine is the operator's when the tool is off the part.
  void begin_aside(Aside why) {
    begin();
    aside_ = why;
  }
  Aside aside() const { return aside_; }
  void lifts() { stage_ = Stage::kLifts; }
  void holds() { stage_ = Stage::kHolds; }
  /// Something else has stopped the machine; the reason stays.
  void abort() {
    stage_ = Stage::kNone;
    aside_ = Aside::kNo;
    put_off_.reset();
  }
  /// The tool is on its way to a contact, which is a rest of its own: held from there.
  void put_off(const DeviceFault& fault) { put_off_ = fault; }
  const std::optional<DeviceFault>& is_put_off() const { return put_off_; }

  /// Of the job; empty: none.
  const Sentence& why() const { return why_; }
  /// It was about to be fed cold.
  bool cold() const { return cold_; }
  void note(const DeviceFault& fault) {
    cold_ = fault.cold;
    why_ = say("%1: %2", fault.device, fault.words);
    aside_ = Aside::kNo;
  }
  /// The job goes on, or is no more.
  void forget() {
    abort();
    why_ = {};
    cold_ = false;
  }

  void await_mended(BusTime now) {
    stage_ = Stage::kMends;
    asked_ = faulty_ = now;
  }
  /// In order for so long that a fault which comes back at once is seen before anything moves.
  Mended mended(BusTime now, bool fault) {
    if (fault) faulty_ = now;
    if (now - faulty_ >= kInOrder) return Mended::kYes;
    return now - asked_ < kPatience ? Mended::kNotYet : Mended::kNo;
  }

 private:
  static constexpr BusTime kInOrder = std::chrono::milliseconds{500};
  /// States of heat nodes come at least so often.
  static constexpr BusTime kPatience = std::chrono::milliseconds{3500};

  Stage stage_ = Stage::kNone;
  Aside aside_ = Aside::kNo;
  Sentence why_;
  bool cold_ = false;
  std::optional<DeviceFault> put_off_;
  BusTime asked_{0}, faulty_{0};
};

}  // namespace kinebus
