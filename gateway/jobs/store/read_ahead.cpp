#include "gateway/jobs/store/read_ahead.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

#include "protocol/host/quiet_thread.hpp"
#include "protocol/host/wake_up.hpp"

namespace kinebus {

/// A ring of blocks with one writer (the thread) and one reader: no lock between them.
struct ReadAhead::Shared {
  struct Block {
    std::array<char, kBlockBytes> text;
    std::size_t size = 0;       ///< 0: the text's end
    std::uint32_t reading = 0;  ///< of an earlier one: to be passed over
  };
  std::unique_ptr<ByteSource> source;
  std::array<Block, kBlocks> blocks;
  std::atomic<std::uint32_t> filled{0}, taken{0}, reading{0};
  std::atomic<bool> ends{false};
  WakeUp room, news;

  Block& first() { return blocks[taken.load(std::memory_order_relaxed) % kBlocks]; }
  bool empty() const {
    return taken.load(std::memory_order_relaxed) == filled.load(std::memory_order_acquire);
  }
};

ReadAhead::ReadAhead(std::unique_ptr<ByteSource> source)
    : shared_(std::make_shared<Shared>()), size_(source->size()) {
  shared_->source = std::move(source);
  quiet_thread([shared = shared_] { fill(*shared); }).detach();
}

ReadAhead::~ReadAhead() {
  shared_->ends = true;
  shared_->room.wake();
}

void ReadAhead::fill(Shared& shared) {
  std::uint32_t mine = 0;
  for (bool whole = false; !shared.ends;) {
    if (const std::uint32_t reading = shared.reading; reading != mine) {
      mine = reading;
      shared.source->rewind();
      whole = false;
    }
    const std::uint32_t filled = shared.filled.load(std::memory_order_relaxed);
    if (whole || filled - shared.taken.load(std::memory_order_acquire) == kBlocks) {
      shared.room.wait();
      continue;
    }
    Shared::Block& block = shared.blocks[filled % kBlocks];
    block.size = shared.source->read(block.text);
    block.reading = mine;
    whole = block.size == 0;
    shared.filled.store(filled + 1, std::memory_order_release);
    shared.news.wake();
  }
  // Closed here, whoever lets the ring go last.
  shared.source.reset();
}

void ReadAhead::pop() {
  at_ = 0;
  shared_->taken.fetch_add(1, std::memory_order_release);
  shared_->room.wake();
}

bool ReadAhead::waits() {
  while (!ended_ && !shared_->empty()) {
    if (shared_->first().reading == reading_) return false;
    pop();
  }
  return !ended_;
}

std::size_t ReadAhead::read(std::span<char> buffer) {
  while (waits()) shared_->news.wait();
  if (ended_) return 0;
  const Shared::Block& block = shared_->first();
  const std::size_t n = std::min(buffer.size(), block.size - at_);
  std::copy_n(block.text.data() + at_, n, buffer.data());
  at_ += n;
  ended_ = block.size == 0;
  if (at_ == block.size) pop();
  return n;
}

bool ReadAhead::rewind() {
  ended_ = false;
  at_ = 0;
  shared_->reading = ++reading_;
  shared_->room.wake();
  return true;
}

}  // namespace kinebus
