#pragma once
// A text that a thread of its own reads ahead of who uses it: a slow disk keeps that thread waiting, never
// the loop.

#include <cstdint>
#include <memory>

#include "gateway/jobs/byte_source.hpp"

namespace kinebus {

class ReadAhead : public ByteSource {
 public:
  /// So much is read ahead: at 1000 short lines a second some 15 s.
  static constexpr std::size_t kBlocks = 8, kBlockBytes = 64 << 10;

  /// `source` is at its beginning, and from here on the thread's alone.
  explicit ReadAhead(std::unique_ptr<ByteSource> source);
  /// Waits for nobody: the thread ends when the disk lets it go.
  ~ReadAhead() override;
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  bool waits() override;
  /// While waits(), it waits for the disk.
  std::size_t read(std::span<char> buffer) override;
  bool rewind() override;
  std::optional<std::uint64_t> size() const override { return size_; }

 private:
  struct Shared;
  static void fill(Shared& shared);
  void pop();

  std::shared_ptr<Shared> shared_;
  std::optional<std::uint64_t> size_;
  std::uint32_t reading_ = 0;  ///< how often it was rewound
  std::size_t at_ = 0;         ///< in the first block
  bool ended_ = false;
};

}  // namespace kinebus
