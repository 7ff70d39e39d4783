#pragma once
// Heartbeat: sending one's own (1017h), and watching those of others (1016h).

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>

#include "protocol/canopen/nmt.hpp"
#include "protocol/time.hpp"

namespace kinebus {

inline constexpr LocalTime kNever = LocalTime::max();

class HeartbeatProducer {
 public:
  /// 0: off. The first heartbeat is due at once.
  void set_period(std::chrono::milliseconds period, LocalTime now);
  std::chrono::milliseconds period() const { return period_; }
  LocalTime next_deadline() const { return period_.count() == 0 ? kNever : due_; }
  /// The heartbeat, if one is due.
  std::optional<CanFrame> next_frame(LocalTime now, NmtState state, std::uint8_t node);

 private:
  std::chrono::milliseconds period_{0};
  LocalTime due_{0};
};

/// Whether two entries of 1016h watch the same node, which CiA 301 forbids.
constexpr bool watch_the_same(std::int64_t a, std::int64_t b) {
  const auto used = [](std::int64_t entry) { return (entry & 0xFFFF) != 0 && (entry >> 16 & 0xFF) != 0; };
  return used(a) && used(b) && (a >> 16 & 0xFF) == (b >> 16 & 0xFF);
}

class HeartbeatConsumer {
 public:
  static constexpr std::size_t kCapacity = 8;
  enum class Health : std::uint8_t { kUnwatched, kUnknown, kAlive, kLost };
  struct Event {
    enum class Kind : std::uint8_t { kBootUp, kStarted, kStateChanged, kLost };
    Kind kind{};
    std::uint8_t node = 0;
    NmtState state{};
  };

  /// As written to 1016h: bits 16-22 node, bits 0-15 time in ms; node or time 0: place unused. False: the
  /// node is watched in another place already.
  bool configure(std::size_t place, std::uint32_t entry);
  /// Watching begins with the first heartbeat, as CiA says.
  std::optional<Event> on_frame(LocalTime now, const CanFrame& frame);
  /// One lost node at a time; call until nullopt.
  std::optional<Event> on_time(LocalTime now);
  LocalTime next_deadline() const;
  Health health(std::uint8_t node) const;
  NmtState state(std::uint8_t node) const;

 private:
  struct Watch {
    std::uint8_t node = 0;
    std::chrono::milliseconds time{0};
    Health health = Health::kUnwatched;
    NmtState state = NmtState::kInitialising;
    LocalTime due{0};
  };
  std::array<Watch, kCapacity> watches_{};
};

}  // namespace kinebus
