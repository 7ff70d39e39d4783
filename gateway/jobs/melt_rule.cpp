#include "gateway/jobs/melt_rule.hpp"

#include "gateway/jobs/machine_setup.hpp"

namespace kinebus {

void MeltRule::begin(const MachineDescription& machine) {
  hotends_ = {};
  tool_ = 0;
  melts_c_ = machine.thermal.min_extrude_c;
  for (const HeaterDescription& heater : machine.heaters)
    if (heater.kind == HeaterKind::kHotend && heater.place.on_node() && heater.index < hotends_.size())
      hotends_[heater.index] = {.on_node = true, .awaited = false, .celsius = {}};
}

void MeltRule::look_away() {
  for (Hotend& hotend : hotends_) hotend.awaited = true;
}

void MeltRule::take(const canonical::Command& command) {
  if (const auto* tool = std::get_if<canonical::Tool>(&command))
    tool_ = static_cast<std::size_t>(tool->hotend) % hotends_.size();
  const auto* thermal = std::get_if<canonical::Thermal>(&command);
  const auto id = thermal != nullptr ? heater_of(*thermal) : std::nullopt;
  if (!id || id->kind != HeaterKind::kHotend || id->index >= hotends_.size()) return;
  Hotend& told = hotends_[id->index];
  if (!told.on_node) return;
  told.celsius = thermal->value;
  told.awaited = thermal->value >= melts_c_ && (told.awaited || thermal->wait);
}

bool MeltRule::is_to_be_awaited() const {
  return !in_use().awaited && !(in_use().celsius && *in_use().celsius < melts_c_);
}

}  // namespace kinebus
