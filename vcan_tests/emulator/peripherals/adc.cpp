#include "vcan_tests/emulator/peripherals/adc.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus::emulator {
namespace {
constexpr std::uint32_t kEndOfConversion = 2, kInjectedEnd = 4, kInjectedStarted = 8, kRegularStarted = 16,
                        kRegularLost = 32;
constexpr std::uint32_t kByDma = 1u << 8, kOverrunInterrupt = 1u << 26;
constexpr std::uint32_t kOn = 1, kContinuous = 2, kLeft = 1u << 11, kInjectedStart = 1u << 22,
                        kRegularStart = 1u << 30;
constexpr std::uint32_t kEndInterrupt = 1u << 5, kInjectedInterrupt = 1u << 7, kScan = 1u << 8;
constexpr std::uint32_t kInjectedSimultaneous = 5;
constexpr Cycle kConversionClocks = 12;
constexpr std::array<Cycle, 8> kSamplingClocks{3, 15, 28, 56, 84, 112, 144, 480};
}  // namespace

void AdcBlock::reset() {
  converters_ = {};
  ccr_ = 0;
  pending_end_ = {kNever, kNever, kNever};
  next_ = kNever;
  update_line();
}

Cycle AdcBlock::sampling(const Converter& c, int channel) const {
  const std::uint32_t code =
      channel < 10 ? c.smpr[1] >> (3 * channel) & 7 : c.smpr[0] >> (3 * (channel - 10)) & 7;
  return kSamplingClocks[code] * clock();
}

int AdcBlock::injected_channel(const Converter& c, int rank) {
  // A group shorter than four is converted from JSQ(4 - n + 1) on.
  const int place = 4 - injected_count(c) + rank;
  return static_cast<int>(c.jsqr >> (5 * place) & 0x1F);
}

int AdcBlock::regular_channel(const Converter& c, int rank) {
  if (rank < 6) return static_cast<int>(c.sqr[2] >> (5 * rank) & 0x1F);
  if (rank < 12) return static_cast<int>(c.sqr[1] >> (5 * (rank - 6)) & 0x1F);
  return static_cast<int>(c.sqr[0] >> (5 * (rank - 12)) & 0x1F);
}

std::uint32_t AdcBlock::quantised(int channel, Cycle at) const {
  const double fraction = sample ? sample(channel, at) : 0;
  return static_cast<std::uint32_t>(std::clamp(std::floor(fraction * 4096 + 0.5), 0.0, 4095.0));
}

void AdcBlock::start_injected(Converter& c, Cycle now) {
  if ((c.cr2 & kOn) == 0) return;
  c.injected_rank = 0;
  c.sr |= kInjectedStarted;
  c.injected_ready = now + sampling(c, injected_channel(c, 0));
}

void AdcBlock::start_regular(Converter& c, Cycle now) {
  if ((c.cr2 & kOn) == 0) return;
  c.regular_rank = 0;
  c.sr |= kRegularStarted;
  c.regular_ready = now + sampling(c, regular_channel(c, 0)) + kConversionClocks * clock();
}

void AdcBlock::on_trigger(std::uint32_t jextsel, Cycle now) {
  for (std::size_t i = 0; i < converters_.size(); ++i) {
    Converter& c = converters_[i];
    const bool slave = i == 1 && (ccr_ & 0x1F) == kInjectedSimultaneous;
    const Converter& chooser = slave ? converters_[0] : c;
    if ((chooser.cr2 >> 20 & 3) == 0 || (chooser.cr2 >> 16 & 0xF) != jextsel) continue;
    start_injected(c, now);
  }
  schedule();
}

void AdcBlock::convert(Converter& c, Cycle now) {
  // Ready means: sampled. The value is held from there on, the result comes a conversion's time later.
  while (c.injected_ready <= now) {
    const int channel = injected_channel(c, c.injected_rank);
    const std::uint32_t offset = c.jofr[static_cast<std::size_t>(c.injected_rank)] & 0xFFF;
    c.jdr[static_cast<std::size_t>(c.injected_rank)] = quantised(channel, c.injected_ready) - offset;
    const Cycle done = c.injected_ready + kConversionClocks * clock();
    const bool scan = (c.cr1 & kScan) != 0;
    if (scan && c.injected_rank + 1 < injected_count(c)) {
      ++c.injected_rank;
      c.injected_ready = done + sampling(c, injected_channel(c, c.injected_rank));
    } else {
      c.injected_rank = -2;  // the last one is being converted
      c.injected_ready = kNever;
      c.regular_ready = c.regular_ready == kNever ? kNever : std::max(c.regular_ready, done);
      pending_end_[static_cast<std::size_t>(&c - converters_.data())] = done;
    }
  }
  Cycle& end = pending_end_[static_cast<std::size_t>(&c - converters_.data())];
  if (end <= now) {
    end = kNever;
    c.injected_rank = -1;
    c.sr |= kInjectedEnd;
  }
  while (c.regular_ready <= now) {
    const std::uint32_t result =
        quantised(regular_channel(c, c.regular_rank), c.regular_ready - kConversionClocks * clock());
    const int count = (c.cr1 & kScan) != 0 ? static_cast<int>(c.sqr[0] >> 20 & 0xF) + 1 : 1;
    ++c.regular_rank;
    const Cycle at = c.regular_ready;
    if (c.regular_rank >= count) {
      c.regular_rank = (c.cr2 & kContinuous) != 0 ? 0 : -1;
    }
    c.regular_ready = c.regular_rank < 0 ? kNever
                                         : c.regular_ready + sampling(c, regular_channel(c, c.regular_rank)) +
                                               kConversionClocks * clock();
    hand_over(c, result, at);  // last: who takes it reads a register
  }
}

// With DMA a result that nobody has taken is not written over: no more are handed over then (OVR).
void AdcBlock::hand_over(Converter& c, std::uint32_t result, Cycle at) {
  const bool by_dma = (c.cr2 & kByDma) != 0;
  if (by_dma && ((c.sr & (kEndOfConversion | kRegularLost)) != 0)) {
    c.sr |= kRegularLost;
    return;
  }
  c.dr = (c.cr2 & kLeft) != 0 ? result << 4 : result;
  c.sr |= kEndOfConversion;
  if (by_dma && on_request) on_request(static_cast<int>(&c - converters_.data()) + 1, at);
}

void AdcBlock::advance(Cycle now) {
  if (now < next_) return;
  for (Converter& c : converters_) convert(c, now);
  schedule();
  update_line();
}

void AdcBlock::schedule() {
  next_ = kNever;
  for (std::size_t i = 0; i < converters_.size(); ++i)
    next_ = std::min({next_, converters_[i].injected_ready, converters_[i].regular_ready, pending_end_[i]});
}

void AdcBlock::update_line() {
  bool level = false;
  for (const Converter& c : converters_)
    level = level || ((c.sr & kInjectedEnd) != 0 && (c.cr1 & kInjectedInterrupt) != 0) ||
            ((c.sr & kEndOfConversion) != 0 && (c.cr1 & kEndInterrupt) != 0) ||
            ((c.sr & kRegularLost) != 0 && (c.cr1 & kOverrunInterrupt) != 0);
  lines_.set_line(kIrq, level);
}

std::uint32_t AdcBlock::read(std::uint32_t offset, Cycle now) {
  advance(now);
  if (offset >= 0x300) {
    if (offset == 0x300) return converters_[0].sr | converters_[1].sr << 8 | converters_[2].sr << 16;
    return offset == 0x304 ? ccr_ : 0;
  }
  Converter& c = converters_[offset / 0x100];
  switch (offset & 0xFF) {
    case 0x00:
      return c.sr;
    case 0x04:
      return c.cr1;
    case 0x08:
      return c.cr2;
    case 0x0C:
      return c.smpr[0];
    case 0x10:
      return c.smpr[1];
    case 0x2C:
      return c.sqr[0];
    case 0x30:
      return c.sqr[1];
    case 0x34:
      return c.sqr[2];
    case 0x38:
      return c.jsqr;
    case 0x3C:
    case 0x40:
    case 0x44:
    case 0x48:
      return c.jdr[((offset & 0xFF) - 0x3C) / 4] & 0xFFFF;
    case 0x4C:
      c.sr &= ~kEndOfConversion;
      update_line();
      return c.dr;
    default:
      return 0;
  }
}

void AdcBlock::write(std::uint32_t offset, std::uint32_t value, Cycle now) {
  advance(now);
  if (offset >= 0x300) {
    if (offset == 0x304) ccr_ = value;
    return;
  }
  Converter& c = converters_[offset / 0x100];
  switch (offset & 0xFF) {
    case 0x00:
      c.sr &= value;
      break;
    case 0x04:
      c.cr1 = value;
      break;
    case 0x08:
      c.cr2 = value & ~(kInjectedStart | kRegularStart);
      if ((value & kInjectedStart) != 0) start_injected(c, now);
      if ((value & kRegularStart) != 0) start_regular(c, now);
      break;
    case 0x0C:
      c.smpr[0] = value;
      break;
    case 0x10:
      c.smpr[1] = value;
      break;
    case 0x14:
    case 0x18:
    case 0x1C:
    case 0x20:
      c.jofr[((offset & 0xFF) - 0x14) / 4] = value;
      break;
    case 0x2C:
      c.sqr[0] = value;
      break;
    case 0x30:
      c.sqr[1] = value;
      break;
    case 0x34:
      c.sqr[2] = value;
      break;
    case 0x38:
      c.jsqr = value;
      break;
    default:
      return;
  }
  schedule();
  update_line();
}

}  // namespace kinebus::emulator
