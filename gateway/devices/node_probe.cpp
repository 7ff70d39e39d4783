#include "gateway/devices/node_probe.hpp"

#include "protocol/canopen/cob_id.hpp"

namespace kinebus {

bool NodeProbe::on_frame(BusTime, const CanFrame& frame) {
  constexpr std::size_t kInputs = 6;  // of TPDO1: two statuswords and two modes come before it
  if (frame.extended || frame.remote || frame.length <= kInputs) return false;
  if (frame.id != cob_id::tpdo(1, place_.node_id)) return false;
  touches_ = ((frame.bytes()[kInputs] >> (place_.channel - 1)) & 1) != 0;
  return true;
}

std::unique_ptr<ContactProbe> node_probe(const ProbeDescription& probe, const MachineDescription&) {
  return std::make_unique<NodeProbe>(probe.place);
}

}  // namespace kinebus
