#pragma once
// The stored jobs as a serial session needs them (M20 to M32). The I/O layer joins it to the store.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace kinebus {

class SerialFiles {
 public:
  struct Entry {
    std::string name;
    std::uint64_t bytes = 0;
  };
  /// What was asked for, when `done`: the disk is asked beside the loop, and whoever asked looks again. The
  /// asker may forget it at any time: a job that has not begun by then does not begin.
  struct Answer {
    bool done = false;
    std::string refused{};         ///< why; empty: done as asked
    std::vector<Entry> entries{};  ///< list(): by name; size(): one
  };
  using Asked = std::shared_ptr<Answer>;

  virtual ~SerialFiles() = default;
  virtual void list(const Asked& answer) = 0;
  virtual void size(const Asked& answer, std::string_view name) = 0;
  /// Starts a stored job the way every client does.
  virtual void run(const Asked& answer, std::string_view name) = 0;
  virtual void remove(const Asked& answer, std::string_view name) = 0;
  /// Stores a whole text under `name`, atomically.
  virtual void store(const Asked& answer, std::string_view name, std::string text) = 0;
};

}  // namespace kinebus
