#include "vcan_tests/emulator/peripherals/dma.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint32_t kStreamOn = 1, kTellError = 4, kTellHalf = 8, kTellComplete = 0x10;
constexpr std::uint32_t kRoundAndRound = 0x100;
// Direction, widths, increments, double buffer: memory to peripheral, words, through memory alone.
constexpr std::uint32_t kStreamKind = 3u << 6 | 1u << 9 | 1u << 10 | 3u << 11 | 3u << 13 | 1u << 18;
constexpr std::uint32_t kWordsToPeripheral = 1u << 6 | 1u << 10 | 2u << 11 | 2u << 13;
constexpr std::uint32_t kHalfWordsToMemory = 1u << 10 | 1u << 11 | 1u << 13;
constexpr std::uint32_t kStreamError = 8, kHalfDone = 0x10, kAllDone = 0x20;
constexpr std::array<unsigned, 4> kFlagsAt{0, 6, 16, 22};

}  // namespace

void Dma::reset() {
  streams_ = {};
  flags_ = {};
  for (int i = 0; i < kStreams; ++i) update_line(i);
}

void Dma::begin(int stream) {
  Stream& s = streams_[static_cast<std::size_t>(stream)];
  const std::uint32_t kind = s.cr & kStreamKind, odd = to_memory(s) ? 1 : 3;
  if ((kind != kWordsToPeripheral && kind != kHalfWordsToMemory) || (s.fcr & 4) != 0 || s.ndtr == 0 ||
      (s.par & odd) != 0 || (s.m0ar & odd) != 0) {
    s.cr &= ~kStreamOn;
    return raise(stream, kStreamError);
  }
  s.left = s.ndtr;
  if (!to_memory(s)) s.word = fetch(s.m0ar);
}

void Dma::on_request(int stream, int channel, Cycle at) {
  Stream& s = streams_[static_cast<std::size_t>(stream)];
  if ((s.cr & kStreamOn) == 0 || static_cast<int>(s.cr >> 25 & 7) != channel) return;
  if (to_memory(s))
    keep(s.m0ar + 2 * (s.ndtr - s.left), take(s.par, at) & 0xFFFF);
  else
    put(s.par, s.word, at);
  if (--s.left == s.ndtr / 2) raise(stream, kHalfDone);
  if (s.left == 0) {
    raise(stream, kAllDone);
    if ((s.cr & kRoundAndRound) == 0) {
      s.cr &= ~kStreamOn;
      return;
    }
    s.left = s.ndtr;
  }
  if (!to_memory(s)) s.word = fetch(s.m0ar + 4 * (s.ndtr - s.left));
}

void Dma::raise(int stream, std::uint32_t flag) {
  flags_[static_cast<std::size_t>(stream)] |= flag;
  update_line(stream);
}

void Dma::update_line(int stream) {
  const auto i = static_cast<std::size_t>(stream);
  const std::uint32_t flags = flags_[i], cr = streams_[i].cr;
  lines_.set_line(irqs_[i], ((flags & kHalfDone) != 0 && (cr & kTellHalf) != 0) ||
                                ((flags & kAllDone) != 0 && (cr & kTellComplete) != 0) ||
                                ((flags & kStreamError) != 0 && (cr & kTellError) != 0));
}

std::uint32_t Dma::read(std::uint32_t offset, Cycle) {
  if (offset < 8) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value |= flags_[offset + i] << kFlagsAt[i];
    return value;
  }
  if (offset < 0x10 || offset >= 0x10 + 0x18 * kStreams) return 0;
  const Stream& s = streams_[(offset - 0x10) / 0x18];
  switch ((offset - 0x10) % 0x18) {
    case 0x00:
      return s.cr;
    case 0x04:
      return s.left;
    case 0x08:
      return s.par;
    case 0x0C:
      return s.m0ar;
    case 0x10:
      return s.m1ar;
    default:
      return s.fcr;
  }
}

void Dma::write(std::uint32_t offset, std::uint32_t value, Cycle) {
  if (offset == 8 || offset == 0xC) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t stream = offset - 8 + i;
      flags_[stream] &= ~(value >> kFlagsAt[i] & 0x3F);
      update_line(static_cast<int>(stream));
    }
    return;
  }
  if (offset < 0x10 || offset >= 0x10 + 0x18 * kStreams) return;
  const std::uint32_t stream = (offset - 0x10) / 0x18;
  Stream& s = streams_[stream];
  const std::uint32_t what = (offset - 0x10) % 0x18;
  if ((s.cr & kStreamOn) != 0) {
    // In operation only the interrupts may be changed, and the end of it asked for.
    constexpr std::uint32_t kFree = kStreamOn | kTellError | kTellHalf | kTellComplete;
    if (what == 0) s.cr = (s.cr & ~kFree) | (value & kFree);
    update_line(static_cast<int>(stream));
    return;
  }
  switch (what) {
    case 0x00:
      s.cr = value;
      if ((value & kStreamOn) != 0) begin(static_cast<int>(stream));
      break;
    case 0x04:
      s.ndtr = s.left = value & 0xFFFF;
      break;
    case 0x08:
      s.par = value;
      break;
    case 0x0C:
      s.m0ar = value;
      break;
    case 0x10:
      s.m1ar = value;
      break;
    default:
      s.fcr = value;
      break;
  }
  update_line(static_cast<int>(stream));
}

}  // namespace kinebus::emulator
