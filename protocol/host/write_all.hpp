#pragma once
// All of a text into a file that is open.

#include <cstdint>
#include <span>
#include <string_view>

namespace kinebus {

/// False with errno where not all could be written. What the file has then is a part of it.
bool write_all(int fd, std::string_view text);

inline bool write_all(int fd, std::span<const std::uint8_t> bytes) {
  return write_all(fd, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace kinebus
