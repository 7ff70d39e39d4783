#pragma once
// Records on their way from the gateway to whoever stores them.

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "gateway/jobs/journal/journal_record.hpp"

namespace kinebus::journal {

/// Bounded: when nobody fetches, nothing more is noted (`lost()` tells), and what was noted stays consistent.
class Queue {
 public:
  static constexpr std::size_t kCapacity = 4096;

  /// Without it nothing is noted, and everything counts as stored.
  void enable() { enabled_ = true; }
  void push(const Record& record);
  std::optional<Record> pop();
  /// The first `count` records since the start are in the file (or never will be).
  void on_stored(std::uint64_t count) { stored_ = count; }
  bool all_stored() const { return stored_ >= pushed_; }
  std::uint64_t lost() const { return lost_; }

 private:
  std::deque<Record> records_;
  std::uint64_t pushed_ = 0, stored_ = 0, lost_ = 0;
  bool enabled_ = false;
};

}  // namespace kinebus::journal
