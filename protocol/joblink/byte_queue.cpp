#include "protocol/joblink/byte_queue.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace kinebus::joblink {

std::span<std::uint8_t> ByteQueue::room(std::size_t size) {
  if (capacity_ - end_ < size) {
    const std::size_t used = end_ - begin_;
    // Moved to the front only where as much was taken as is left: a byte is moved once on the average.
    if (begin_ >= used && capacity_ - used >= size) {
      std::copy_n(storage_.get() + begin_, used, storage_.get());
    } else {
      const std::size_t larger = std::max(2 * capacity_, used + size);
      auto storage = std::make_unique_for_overwrite<std::uint8_t[]>(larger);
      std::copy_n(storage_.get() + begin_, used, storage.get());
      storage_ = std::move(storage);
      capacity_ = larger;
    }
    begin_ = 0;
    end_ = used;
  }
  return {storage_.get() + end_, size};
}

void ByteQueue::drop(std::size_t count) {
  assert(count <= size());
  begin_ += count;
  if (begin_ == end_) clear();
}

}  // namespace kinebus::joblink
