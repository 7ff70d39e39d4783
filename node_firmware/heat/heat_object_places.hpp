#pragma once
// Where an object of the heat node belongs.

#include <cstddef>
#include <cstdint>

#include "protocol/canopen/heat_units.hpp"

namespace kinebus::heat {

inline bool is_of_the_accelerometer(std::uint16_t index) {
  return index >= heat_object::kVibrationState.index && index <= heat_object::kAcceleration.index;
}

/// Of a subindex of an array.
inline std::size_t place_of(ObjectAddress address) {
  return address.subindex == 0 ? 0 : address.subindex - 1u;
}

}  // namespace kinebus::heat
