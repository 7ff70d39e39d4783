#pragma once
// The stored jobs as a serial session needs them (M20 to M32). The I/O layer joins it to the store.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/jobs/byte_source.hpp"
#include "gateway/result.hpp"

namespace kinebus {

class SerialFiles {
 public:
  struct Entry {
    std::string name;
    std::uint64_t bytes = 0;
  };
  virtual ~SerialFiles() = default;
  virtual std::vector<Entry> list() = 0;
  virtual Result<std::unique_ptr<ByteSource>, std::string> open(std::string_view name) = 0;
  /// Starts a stored job the way every client does. Refused: why.
  virtual std::string run(std::string_view name) = 0;
  virtual std::string remove(std::string_view name) = 0;  ///< empty: done
  /// Stores a whole text under `name`, atomically. Empty: done.
  virtual std::string store(std::string_view name, std::string_view text) = 0;
};

}  // namespace kinebus
