#pragma once
// Frames that only this gateway sends, heard from another device. The bus itself does not tell who speaks;
// but the gateway knows what it has sent.

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "gateway/bus_nodes/node_link.hpp"
#include "gateway/sentence.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/time.hpp"

namespace kinebus {

struct ForeignFrame {
  enum class Kind : std::uint8_t {
    kNone,     ///< it may come from others
    kGateway,  ///< SYNC, its stamp, a change of the rate, the gateway's heartbeat: a second gateway speaks
    kRecord,   ///< a record of motion for one of the machine's nodes
    kOrder,    ///< a write of an object, NMT, a controlword: nodes refuse in motion what would make it unsafe
  };
  Kind kind = Kind::kNone;
  std::uint8_t node = 0;    ///< whom it is for
  Sentence words{};         ///< kRecord, kOrder
  std::uint64_t order = 0;  ///< kOrder: the same for the same order
  /// kOrder: also a machine at rest is not the same afterwards.
  enum class AtRest : std::uint8_t { kNothing, kIsTold, kFreesMotors };
  AtRest at_rest = AtRest::kNothing;
};

/// What a frame is that this gateway has not sent. `links`: the machine's nodes.
ForeignFrame look_at_foreign(const CanFrame& frame, const std::deque<NodeLink>& links);

/// Which orders of others are told: each once a second, and no more than a person reads.
class ForeignOrders {
 public:
  bool is_news(BusTime now, std::uint64_t order);

 private:
  static constexpr BusTime kPeriod = std::chrono::seconds{1};

  std::array<std::uint64_t, 6> told_{};
  std::size_t count_ = 0;
  BusTime since_{-std::chrono::hours{1}};
};

/// Frames that nobody here uses. So many of them take the bus from those that are needed.
class UselessFrames {
 public:
  /// One more. True once, until forget().
  bool are_many(BusTime now);
  void forget() { told_ = false; }

 private:
  static constexpr BusTime kPeriod = std::chrono::seconds{1};
  static constexpr int kMany = 200;

  int count_ = 0;
  bool told_ = false;
  BusTime since_{-std::chrono::hours{1}};
};

}  // namespace kinebus
