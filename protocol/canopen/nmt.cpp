#include "protocol/canopen/nmt.hpp"

namespace kinebus {

std::optional<NmtCommand> decode_nmt(const CanFrame& frame, std::uint8_t node) {
  if (frame.extended || frame.remote || frame.id != cob_id::kNmt || frame.length != 2) return std::nullopt;
  if (frame.data[1] != kAllNodes && frame.data[1] != node) return std::nullopt;
  switch (const auto command = static_cast<NmtCommand>(frame.data[0])) {
    case NmtCommand::kStart:
    case NmtCommand::kStop:
    case NmtCommand::kEnterPreOperational:
    case NmtCommand::kResetNode:
    case NmtCommand::kResetCommunication:
      return command;
  }
  return std::nullopt;
}

std::optional<Heartbeat> decode_heartbeat(const CanFrame& frame) {
  const std::uint8_t node = cob_id::node_of(frame.id, cob_id::kHeartbeat);
  if (node == 0 || frame.extended || frame.remote || frame.length != 1) return std::nullopt;
  switch (const auto state = static_cast<NmtState>(frame.data[0] & 0x7F)) {
    case NmtState::kInitialising:
    case NmtState::kStopped:
    case NmtState::kOperational:
    case NmtState::kPreOperational:
      return Heartbeat{node, state};
  }
  return std::nullopt;
}

CanFrame NmtSlave::boot(std::uint8_t node) {
  node_ = node;
  state_ = NmtState::kPreOperational;
  return heartbeat_frame(NmtState::kInitialising, node);
}

std::optional<NmtCommand> NmtSlave::on_frame(const CanFrame& frame) {
  if (state_ == NmtState::kInitialising) return std::nullopt;
  const auto command = decode_nmt(frame, node_);
  if (!command) return std::nullopt;
  switch (*command) {
    case NmtCommand::kStart:
      state_ = NmtState::kOperational;
      break;
    case NmtCommand::kStop:
      state_ = NmtState::kStopped;
      break;
    case NmtCommand::kEnterPreOperational:
      state_ = NmtState::kPreOperational;
      break;
    case NmtCommand::kResetNode:
    case NmtCommand::kResetCommunication:
      state_ = NmtState::kInitialising;
      break;
  }
  return command;
}

void NmtSlave::on_error(std::uint8_t behaviour) {
  if (behaviour == 0 && state_ == NmtState::kOperational) state_ = NmtState::kPreOperational;
  if (behaviour == 2 && state_ != NmtState::kInitialising) state_ = NmtState::kStopped;
}

}  // namespace kinebus
