#include "node_firmware/core/switch_inputs.hpp"

#include <algorithm>

namespace kinebus {

void SwitchInputs::configure(int input, const Config& config) {
  inputs_[static_cast<std::size_t>(input)].config = config;
  if (shown_ != active_inputs()) changed_ = true;
}

void SwitchInputs::on_level(LocalTime at, int input, bool level, const LatchedPositions& latched,
                            const ScaleCounts& scales) {
  if (input < 0 || input >= kSwitchInputs) return;
  Input& in = inputs_[static_cast<std::size_t>(input)];
  if (level == in.level) {
    if (in.pending) ++glitches_;
    in.pending = false;
  } else if (!in.pending) {
    in.pending = true;
    in.since = at;
    in.latched = latched;
    in.scales = scales;
  }
}

std::optional<SwitchEvent> SwitchInputs::next_event(LocalTime now) {
  Input* first = nullptr;
  for (Input& in : inputs_)
    if (in.pending && now - in.since >= in.config.debounce && (first == nullptr || in.since < first->since))
      first = &in;
  if (first == nullptr) return std::nullopt;
  first->pending = false;
  first->level = !first->level;
  changed_ = true;
  return SwitchEvent{static_cast<int>(first - inputs_.data()),
                     first->config.function,
                     first->active(),
                     first->since,
                     first->latched,
                     first->scales};
}

LocalTime SwitchInputs::next_deadline() const {
  LocalTime deadline = LocalTime::max();
  for (const Input& in : inputs_)
    if (in.pending) deadline = std::min(deadline, in.since + in.config.debounce);
  if (changed_) deadline = std::min(deadline, shown_at_ + (untold_ != 0 ? kShown : LocalTime{0}));
  return deadline;
}

std::uint8_t SwitchInputs::active_inputs() const {
  unsigned bits = 0;
  for (std::size_t i = 0; i < inputs_.size(); ++i)
    if (inputs_[i].active()) bits |= 1u << i;
  return static_cast<std::uint8_t>(bits);
}

void SwitchInputs::show(LocalTime now) {
  if (!changed_) return;
  if (untold_ != 0 && now - shown_at_ >= kShown) untold_ = 0;
  const unsigned differs = active_inputs() ^ shown_;
  const unsigned shows = differs & ~static_cast<unsigned>(untold_);
  changed_ = differs != shows;
  if (shows == 0) return;
  shown_ = static_cast<std::uint8_t>(shown_ ^ shows);
  untold_ = static_cast<std::uint8_t>(untold_ | shows);
  shown_at_ = now;
}

bool SwitchInputs::active(SwitchFunction function) const {
  return std::any_of(inputs_.begin(), inputs_.end(),
                     [&](const Input& in) { return in.config.function == function && in.active(); });
}

bool SwitchInputs::configured(SwitchFunction function) const {
  return std::any_of(inputs_.begin(), inputs_.end(),
                     [&](const Input& in) { return in.config.function == function; });
}

}  // namespace kinebus
