#pragma once
// A queue with absolute indices in reused slots. It grows when full, so that nothing is ever lost or refused;
// once it has its working size, it allocates nothing.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kinebus {

template <typename T>
class GrowingRing {
 public:
  explicit GrowingRing(std::size_t capacity) : slots_(std::bit_ceil(capacity)), mask_(slots_.size() - 1) {}

  std::uint64_t begin() const { return begin_; }
  std::uint64_t end() const { return end_; }
  std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }
  bool empty() const { return begin_ == end_; }

  T& operator[](std::uint64_t index) { return slots_[index & mask_]; }
  const T& operator[](std::uint64_t index) const { return slots_[index & mask_]; }
  T& back() { return (*this)[end_ - 1]; }

  /// A slot at the end; it still holds what it held when last in use. Invalidates references.
  T& push() {
    if (size() == slots_.size()) grow();
    return slots_[end_++ & mask_];
  }
  /// Drops everything before `index`.
  void drop_to(std::uint64_t index) {
    if (index > begin_) begin_ = index;
  }
  void pop_back() { --end_; }
  void clear() { begin_ = end_; }

 private:
  void grow() {
    std::vector<T> larger(slots_.size() * 2);
    for (std::uint64_t i = begin_; i != end_; ++i) larger[i & (larger.size() - 1)] = slots_[i & mask_];
    slots_ = std::move(larger);
    mask_ = slots_.size() - 1;
  }

  std::vector<T> slots_;
  std::size_t mask_;
  std::uint64_t begin_ = 0, end_ = 0;
};

}  // namespace kinebus
