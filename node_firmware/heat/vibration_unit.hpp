#pragma once
// What a heat node asks of its accelerometer, 2270h ff. A board that has none gives none, and links nothing
// of it.

#include <cstdint>

#include "protocol/canopen/abort_code.hpp"
#include "protocol/canopen/object.hpp"

namespace kinebus::heat {

class VibrationUnit {
 public:
  virtual AbortCode read(ObjectAddress address, std::int64_t& value) const = 0;
  virtual AbortCode write(ObjectAddress address, std::int64_t value) = 0;

 protected:
  ~VibrationUnit() = default;
};

}  // namespace kinebus::heat
