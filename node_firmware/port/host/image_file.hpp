#pragma once
// A node's parameter image in a file: what flash is on the board. Replaced as a whole or not at all.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kinebus {

class ImageFile {
 public:
  /// Empty: nothing is kept.
  explicit ImageFile(std::string path) : path_(std::move(path)) {}
  /// Empty when there is no such file yet.
  std::vector<std::uint8_t> read() const;
  /// Written beside, flushed to the disk, renamed. False: the file is as before.
  bool replace(std::span<const std::uint8_t> bytes) const;

 private:
  std::string path_;
};

}  // namespace kinebus
