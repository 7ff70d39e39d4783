#pragma once
// Network management: states, commands, and the slave's side of them.

#include <cstdint>
#include <optional>

#include "protocol/can/frame.hpp"
#include "protocol/canopen/cob_id.hpp"

namespace kinebus {

/// Numbers are those of the heartbeat.
enum class NmtState : std::uint8_t {
  kInitialising = 0,
  kStopped = 4,
  kOperational = 5,
  kPreOperational = 127
};

enum class NmtCommand : std::uint8_t {
  kStart = 1,
  kStop = 2,
  kEnterPreOperational = 128,
  kResetNode = 129,
  kResetCommunication = 130,
};

inline constexpr std::uint8_t kAllNodes = 0;

constexpr CanFrame nmt_frame(NmtCommand command, std::uint8_t node) {
  return CanFrame::make(cob_id::kNmt, {static_cast<std::uint8_t>(command), node});
}

/// The command in an NMT frame that is for `node`; nullopt: not NMT, not for it, malformed or unknown.
std::optional<NmtCommand> decode_nmt(const CanFrame& frame, std::uint8_t node);

constexpr CanFrame heartbeat_frame(NmtState state, std::uint8_t node) {
  return CanFrame::make(cob_id::kHeartbeat + node, {static_cast<std::uint8_t>(state)});
}

struct Heartbeat {
  std::uint8_t node = 0;
  NmtState state = NmtState::kInitialising;  ///< kInitialising: this is the boot-up message
};
std::optional<Heartbeat> decode_heartbeat(const CanFrame& frame);

/// NMT state of a node. Resets are told to the caller, who then calls boot() when the node is up again.
class NmtSlave {
 public:
  /// To pre-operational; the boot-up message is due.
  CanFrame boot(std::uint8_t node);
  /// The command that was for this node and has been carried out. After a reset the state is kInitialising.
  std::optional<NmtCommand> on_frame(const CanFrame& frame);
  /// For 1029h: error behaviour (0: leaves operational for pre-operational, 1: nothing, 2: stopped).
  void on_error(std::uint8_t behaviour);

  NmtState state() const { return state_; }
  std::uint8_t node() const { return node_; }
  bool allows_pdo() const { return state_ == NmtState::kOperational; }
  bool allows_sdo() const { return allows_pdo() || state_ == NmtState::kPreOperational; }
  bool allows_emcy() const { return allows_sdo(); }
  bool allows_sync() const { return allows_sdo(); }

 private:
  NmtState state_ = NmtState::kInitialising;
  std::uint8_t node_ = 0;
};

}  // namespace kinebus
