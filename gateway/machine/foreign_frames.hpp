#pragma once
// Frames that only this gateway sends, heard from another device. The bus itself does not tell who speaks;
// but the gateway knows what it has sent.

#include <cstdint>
#include <deque>

#include "gateway/bus_nodes/node_link.hpp"
#include "gateway/sentence.hpp"
#include "protocol/can/frame.hpp"

namespace kinebus {

struct ForeignFrame {
  enum class Kind : std::uint8_t {
    kNone,     ///< it may come from others
    kGateway,  ///< SYNC, its stamp, a change of the rate, the gateway's heartbeat: a second gateway speaks
    kRecord,   ///< a record of motion for one of the machine's nodes
    kWrite,    ///< writes an object of a node: nodes refuse in motion what would make it unsafe
  };
  Kind kind = Kind::kNone;
  std::uint8_t node = 0;  ///< whom it is for
  Sentence words{};       ///< kRecord, kWrite
};

/// What a frame is that this gateway has not sent. `links`: the machine's nodes.
ForeignFrame look_at_foreign(const CanFrame& frame, const std::deque<NodeLink>& links);

}  // namespace kinebus
