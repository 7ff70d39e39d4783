#pragma once
// Where a job's text comes from: a file, the job store, a string, a live serial line. The cores only read.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace kinebus {

/// A text of any length, read from front to back in pieces, more than once.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  /// Fills the front of `buffer`; returns the bytes filled. 0: the end.
  virtual std::size_t read(std::span<char> buffer) = 0;
  /// What follows is on its way: to read() now would wait for it.
  virtual bool waits() { return false; }
  /// Back to the first byte. False: the source cannot be read again.
  virtual bool rewind() = 0;
  /// Total length where it is known (for the progress display).
  virtual std::optional<std::uint64_t> size() const { return std::nullopt; }
};

/// A text held in memory.
class StringSource : public ByteSource {
 public:
  explicit StringSource(std::string text) : text_(std::move(text)) {}
  std::size_t read(std::span<char> buffer) override {
    const std::size_t n = std::min(buffer.size(), text_.size() - at_);
    std::copy_n(text_.data() + at_, n, buffer.data());
    at_ += n;
    return n;
  }
  bool rewind() override {
    at_ = 0;
    return true;
  }
  std::optional<std::uint64_t> size() const override { return text_.size(); }

 private:
  std::string text_;
  std::size_t at_ = 0;
};

}  // namespace kinebus
