#pragma once
// The object table of a heat node, with the places of its objects for code that names them.

#include "protocol/canopen/board_objects.hpp"
#include "protocol/canopen/boards/heat.hpp"
#include "protocol/canopen/node_objects.hpp"

namespace kinebus {

inline constexpr const auto& kHeatObjects = BoardObjects<HeatBoard>::kEntries;
inline constexpr const ObjectTable& kHeatTable = BoardObjects<HeatBoard>::kTable;
inline constexpr std::size_t kHeatObjectCount = kHeatObjects.size();

/// As slot_of, of a heat node. Of an array: that of its first; the others follow.
consteval ObjectSlot heat_slot_of(ObjectAddress address) {
  const int place = kHeatTable.find(address);
  if (place < 0) object_table::no_such_object_in_the_table();
  return kHeatObjects[static_cast<std::size_t>(place)].value_slot();
}

}  // namespace kinebus
