#pragma once
// Bytes in at the end, out at the front, always in one piece. Room is handed out as it is, where std::string
// and std::vector would clear what is about to be filled.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace kinebus::joblink {

class ByteQueue {
 public:
  /// Room behind the end, of `size` bytes; what added() says of them counts. Views from before are void.
  std::span<std::uint8_t> room(std::size_t size);
  void added(std::size_t count) { end_ += count; }
  std::span<const std::uint8_t> bytes() const { return {storage_.get() + begin_, end_ - begin_}; }
  std::size_t size() const { return end_ - begin_; }
  bool empty() const { return begin_ == end_; }
  /// Takes `count` of the bytes away; views stay as they are.
  void drop(std::size_t count);
  void clear() { begin_ = end_ = 0; }

 private:
  std::unique_ptr<std::uint8_t[]> storage_;
  std::size_t capacity_ = 0, begin_ = 0, end_ = 0;
};

}  // namespace kinebus::joblink
