#pragma once
// A text that is the same as before is told by the hash of what was read of it.

#include <memory>
#include <utility>

#include "gateway/jobs/byte_source.hpp"
#include "gateway/jobs/journal/journal_codec.hpp"

namespace kinebus {

class HashedSource : public ByteSource {
 public:
  explicit HashedSource(std::unique_ptr<ByteSource> source) : source_(std::move(source)) {}
  std::size_t read(std::span<char> buffer) override {
    const std::size_t n = source_->read(buffer);
    hash_ = journal::fnv1a64(buffer.first(n), hash_);
    bytes_ += n;
    return n;
  }
  bool waits() override { return source_->waits(); }
  bool rewind() override {
    hash_ = journal::kHashStart;
    bytes_ = 0;
    return source_->rewind();
  }
  std::optional<std::uint64_t> size() const override { return source_->size(); }

  /// Of what was read since the beginning.
  std::uint64_t hash() const { return hash_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  std::unique_ptr<ByteSource> source_;
  std::uint64_t hash_ = journal::kHashStart, bytes_ = 0;
};

}  // namespace kinebus
