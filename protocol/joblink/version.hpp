#pragma once
// The version of the job link. The major number changes when old and new programs cannot talk any more.

#include <cstdint>

namespace kinebus::joblink {
inline constexpr std::uint32_t kVersionMajor = 2;
inline constexpr std::uint32_t kVersionMinor = 0;
}  // namespace kinebus::joblink
