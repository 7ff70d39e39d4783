#pragma once
// The object table of an axis-pair node, with the places of its objects for code that names them. SDO server,
// PDO mapping and gateway read it; EDS and DBC files come from the same boards (boards/all.hpp).

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/canopen/board_objects.hpp"
#include "protocol/canopen/boards/stm32f405.hpp"

namespace kinebus {

inline constexpr const auto& kNodeObjects = BoardObjects<Stm32f405Board>::kEntries;
inline constexpr const auto& kNodeObjectNames = BoardObjects<Stm32f405Board>::kNames;
inline constexpr const ObjectTable& kNodeTable = BoardObjects<Stm32f405Board>::kTable;
inline constexpr std::size_t kNodeObjectCount = kNodeObjects.size();
/// The most objects that a node with an axis pair has on any board.
inline constexpr std::size_t kMostNodeObjects = kNodeObjectCount;

namespace object_table {
void no_such_object_in_the_table();  // not constexpr: its name is the compiler's message
}  // namespace object_table

/// Of an entry of kNodeObjects.
constexpr const ObjectNames& names_of(const ObjectEntry& entry) {
  return kNodeObjectNames[static_cast<std::size_t>(&entry - kNodeObjects.data())];
}

/// Place of an object in kNodeObjects. Binary search; -1: no such object.
constexpr int find_object(ObjectAddress address) {
  return kNodeTable.find(address);
}

/// Where the value of an object is, found at compile time; an address that is not in the table does not
/// compile.
consteval ObjectSlot slot_of(ObjectAddress address) {
  const int place = find_object(address);
  if (place < 0) object_table::no_such_object_in_the_table();
  return kNodeObjects[static_cast<std::size_t>(place)].value_slot();
}

/// An object that both axes have: slot_of_axes(object::kControlword)[axis].
struct AxisSlots {
  std::array<ObjectSlot, 2> slots;
  constexpr ObjectSlot operator[](std::size_t axis) const { return slots[axis]; }
};
consteval AxisSlots slot_of_axes(ObjectAddress base) {
  return {{slot_of(base), slot_of({static_cast<std::uint16_t>(base.index + kAxisOffset), base.subindex})}};
}

}  // namespace kinebus
