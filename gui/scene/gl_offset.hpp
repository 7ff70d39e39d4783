#pragma once
// OpenGL takes offsets into the bound buffer where it once took pointers.

#include <cstddef>

namespace kinebus::gui {

inline const void* buffer_offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);  // NOLINT(performance-no-int-to-ptr)
}

}  // namespace kinebus::gui
