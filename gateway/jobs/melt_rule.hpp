#pragma once
// Whether the text of a job waits until what it feeds melts: of each hot end by what it was told, and asked
// of the one that is in use where filament is fed next.

#include <array>
#include <cstddef>
#include <optional>

#include "gateway/description/machine_description.hpp"
#include "gateway/gcode/canonical.hpp"

namespace kinebus {

class MeltRule {
 public:
  /// A text: T0 is in use, and no hot end has been told anything.
  void begin(const MachineDescription& machine);
  /// Nothing is waited for: who commands it is told at once.
  void look_away();
  void take(const canonical::Command& command);
  /// Filament is fed next, and would go into a hot end that nobody has waited for. What is fed behind a
  /// target that melts nothing is no matter of waiting: the checks refuse it, or let filament that was taken
  /// back go where it came from.
  bool is_to_be_awaited() const;
  void await() { in_use().awaited = true; }
  /// The wait was cut short.
  void not_awaited() { in_use().awaited = false; }

 private:
  /// One that no node has is taken as awaited: it is simulated and stands for heat that others look after.
  struct Hotend {
    bool on_node = false, awaited = true;
    std::optional<double> celsius;  ///< by the text; none: it has said nothing
  };
  Hotend& in_use() { return hotends_[tool_]; }
  const Hotend& in_use() const { return hotends_[tool_]; }

  std::array<Hotend, kMostOfAKind> hotends_{};
  std::size_t tool_ = 0;
  double melts_c_ = 0;
};

}  // namespace kinebus
