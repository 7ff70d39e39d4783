#pragma once
// SocketCAN access for every Linux program of Kinebus (daemon, virtual nodes, tools). Hosted code: not part
// of the freestanding protocol library, and never linked into the firmware.

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "protocol/can/frame.hpp"
#include "protocol/host/hardware_clock.hpp"
#include "protocol/time.hpp"

namespace kinebus {

/// CLOCK_MONOTONIC as this process's local time.
LocalTime monotonic_now();

/// One raw CAN socket, non-blocking. Frames come with the kernel's receive time mapped to monotonic_now()'s
/// clock, or with the adapter's own time stamp where it has them; own frames come back when they were really
/// sent.
class SocketCan {
 public:
  enum class Kind : std::uint8_t {
    kFrame,     ///< from another participant
    kOwn,       ///< one of ours, now on the bus
    kBusError,  ///< controller reports: `error` says what
    kDown,      ///< the interface went down
  };
  struct Received {
    Kind kind{};
    LocalTime when{0};
    CanFrame frame{};
    std::uint32_t error = 0;  ///< kBusError: CAN_ERR_... class bits
  };
  enum class Sent : std::uint8_t { kYes, kFull, kDown };
  struct Counters {
    std::uint32_t rx_overflow = 0;  ///< frames that the kernel dropped because we were slow
    std::uint32_t tx_full = 0;
  };

  SocketCan() = default;
  SocketCan(SocketCan&& other) noexcept;
  SocketCan& operator=(SocketCan&& other) noexcept;
  ~SocketCan();

  /// Empty string: open. Otherwise what is wrong and what to do. `own_frames`: report own frames when sent.
  std::string open(const std::string& interface, bool own_frames);

  /// The interface of that name that has come in the place of one that was taken away, as a USB adapter's
  /// when its cable is back; all frames are passed on. False: there is none, or it is the same as before.
  bool rejoin();

  /// Standard frames, data or remote, whose identifier is `value` where `mask` has ones.
  struct Accept {
    std::uint16_t value = 0, mask = 0x7FF;
    bool remote = false;
    friend constexpr bool operator==(const Accept&, const Accept&) = default;
  };
  /// From now on the kernel passes on these alone, as a controller's filters do.
  void accept(std::span<const Accept> filters);

  int fd() const { return fd_; }
  Sent send(const CanFrame& frame);
  /// For tools, which have nothing else to do: waits for room. Empty: sent; otherwise what is wrong and what
  /// to do.
  std::string send_patiently(const CanFrame& frame, LocalTime patience = std::chrono::seconds{1});
  std::optional<Received> receive();
  const Counters& counters() const { return counters_; }

 private:
  bool take_place(unsigned index);

  int fd_ = -1;
  std::string interface_;
  unsigned index_ = 0;
  HardwareClock hardware_;
  Counters counters_;
};

}  // namespace kinebus
