#pragma once
// Where both motors of a node were, every 2 ms of the system's clock, as a file: for tests that look at the
// true path of all nodes together. 24 bytes a sample: time in ns, then both positions, counts with 32
// fractional bits.

#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "node_firmware/core/node.hpp"

namespace kinebus {

class PositionTrace {
 public:
  static constexpr LocalTime kPeriod = std::chrono::milliseconds{2};

  /// Appends to `path`; nothing is written without one. False: cannot be opened.
  bool open(const std::string& path) {
    if (path.empty()) return true;
    file_.reset(std::fopen(path.c_str(), "ab"));
    return file_ != nullptr;
  }
  bool on() const { return file_ != nullptr; }
  LocalTime next() const { return next_; }
  /// Before anything that happened after `now` is given to `node`.
  void sample(Node& node, LocalTime now) {
    if (!file_) return;
    // After a pause of the process what lies far back cannot be asked for any more.
    if (now - next_ > std::chrono::seconds{1}) next_ = now / kPeriod * kPeriod;
    for (; next_ <= now; next_ += kPeriod) {
      const std::array<std::int64_t, 3> row{next_.count(), node.position(next_, 0), node.position(next_, 1)};
      std::fwrite(row.data(), sizeof row, 1, file_.get());
    }
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  LocalTime next_{0};
};

}  // namespace kinebus
