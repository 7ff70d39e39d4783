#include "gateway/devices/node_input.hpp"

#include "protocol/canopen/cob_id.hpp"

namespace kinebus {

bool NodeInput::on_frame(BusTime, const CanFrame& frame) {
  constexpr std::size_t kInputs = 6;  // of TPDO1: two statuswords and two modes come before it
  if (frame.extended || frame.remote || frame.length <= kInputs) return false;
  if (frame.id != cob_id::tpdo(1, place_.node_id)) return false;
  const bool on = (static_cast<unsigned>(frame.bytes()[kInputs]) >> (place_.channel - 1U) & 1U) != 0;
  const InputLevel before = level_;
  level_ = on ? InputLevel::kOn : InputLevel::kOff;
  if (before != InputLevel::kUnknown && before != level_) ++(on ? changes_.rises : changes_.falls);
  return true;
}

std::unique_ptr<Input> node_input(const InputDescription& input, const MachineDescription&) {
  return std::make_unique<NodeInput>(input.place);
}

}  // namespace kinebus
