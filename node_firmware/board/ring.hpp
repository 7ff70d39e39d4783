#pragma once
// One producer, one consumer, one of them an interrupt: a ring with atomic indices.

#include <array>
#include <atomic>
#include <cstdint>

namespace kinebus {

template <typename T, std::uint32_t kSize>
class Ring {
  static_assert((kSize & (kSize - 1)) == 0);

 public:
  /// False: full.
  bool push(const T& item) {
    const std::uint32_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == kSize) return false;
    items_[end % kSize] = item;
    end_.store(end + 1, std::memory_order_release);
    return true;
  }
  std::uint32_t size() const {
    return end_.load(std::memory_order_relaxed) - begin_.load(std::memory_order_acquire);
  }
  /// nullptr: empty. Valid until drop().
  const T* front() const {
    const std::uint32_t begin = begin_.load(std::memory_order_relaxed);
    return end_.load(std::memory_order_acquire) == begin ? nullptr : &items_[begin % kSize];
  }
  void drop() { begin_.store(begin_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

 private:
  std::array<T, kSize> items_{};
  std::atomic<std::uint32_t> begin_{0}, end_{0};
};

}  // namespace kinebus
