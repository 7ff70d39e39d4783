#pragma once
// What the wall shows now, as JSON, and what Prometheus reads; written by who asks the queue, read by the
// sessions.

#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "gateway/fleet/machine_view.hpp"

namespace kinebus::fleet {

class WallText {
 public:
  std::string get() const {
    const std::lock_guard lock(busy_);
    return text_;
  }
  void set(std::string text) {
    const std::lock_guard lock(busy_);
    text_ = std::move(text);
  }
  std::string metrics() const {
    const std::lock_guard lock(busy_);
    return metrics_;
  }
  void set_metrics(std::string text) {
    const std::lock_guard lock(busy_);
    metrics_ = std::move(text);
  }

 private:
  mutable std::mutex busy_;
  std::string text_ = "{}", metrics_;
};

/// The page: HTML with style and script inside.
extern const char* const kWallPage;

}  // namespace kinebus::fleet
