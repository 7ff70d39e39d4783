#pragma once
// What the pins of a board do in the next 64 us, as words that a timer and a DMA controller put out one a
// microsecond. 0: everything stays as it is.

#include <array>
#include <cstddef>
#include <cstdint>

#include "node_firmware/core/motion_plan.hpp"

namespace kinebus::step {

/// A slot is a microsecond; a frame is what is computed at once. An eighth of a piece of the plan.
inline constexpr int kSlots = 64;
inline constexpr PlanCounts kSlotCounts = 4, kFrameCounts = kSlotCounts * kSlots;
inline constexpr int kFrameBits = 8;
static_assert(kPlanCount.count() * kSlotCounts == 1000 && kFrameCounts == 1 << kFrameBits);

/// The direction is set so many slots before its step, and a pulse is as long. Drivers want at most 0.65 us
/// and 1.9 us (DRV8825; TMC2209: 20 ns and 100 ns).
inline constexpr int kSetUp = 2, kPulse = 2;
/// At least so many slots from one step of an axis to the next, whatever their directions: pulse and pause
/// are kPulse at least, and a direction stays for as long after its last step. 250,000 steps/s.
inline constexpr int kSpacing = 4;

/// What reaches beyond a frame: a step of the last slot begins kSetUp later and ends kPulse after that.
inline constexpr int kTail = kSetUp + kPulse;
/// Steps of slots before this one end within the frame.
inline constexpr int kEarly = kSlots - kTail;

/// For a port of pins (BSRR of the STM32): the lower half of a word sets them, the upper half resets them.
struct PinWords {
  static constexpr std::uint32_t high(std::uint32_t pins) { return pins; }
  static constexpr std::uint32_t low(std::uint32_t pins) { return pins << 16; }
};
/// Where DMA does not reach the ports: for the outputs of a timer, which its mode forces (CCMR of the STM32's
/// timers: 5 is high, 4 low, 0 leaves an output as it is). pins: the lowest bit of a channel's mode.
struct ForcedWords {
  static constexpr std::uint32_t kChannel1 = 1u << 4;
  static constexpr std::uint32_t high(std::uint32_t pins) { return 5 * pins; }
  static constexpr std::uint32_t low(std::uint32_t pins) { return 4 * pins; }
};

/// Two frames of every port: one is put out while the other is filled. PortWords: what a word does.
template <std::size_t kPorts, typename PortWords = PinWords>
class StepFrames {
 public:
  using Words = PortWords;
  /// Empties the half that is to be filled; what the frame before has begun goes on in it.
  void begin(std::size_t half) {
    half_ = half;
    bool* used = used_.data();
    for (Port& port : ports_) {
      std::uint32_t* words = port.words.data() + half * kSlots;
      if (used[half]) {
        used[half] = false;
        // Not by memset(), which takes twice as long.
        for (std::uint32_t* word = words; word != words + kSlots; word += 32) {
          word[0] = word[1] = word[2] = word[3] = word[4] = word[5] = word[6] = word[7] = 0;
          word[8] = word[9] = word[10] = word[11] = word[12] = word[13] = word[14] = word[15] = 0;
          word[16] = word[17] = word[18] = word[19] = word[20] = word[21] = word[22] = word[23] = 0;
          word[24] = word[25] = word[26] = word[27] = word[28] = word[29] = word[30] = word[31] = 0;
          asm volatile("" ::: "memory");
        }
      }
      if (used[kTailUsed]) {
        used[kTailUsed] = false;
        used[half] = true;
        for (std::size_t i = 0; i < kTail; ++i) words[i] = port.tail[i];
        port.tail = {};
      }
      used += kParts;
    }
  }
  /// slot: below kSlots + kTail.
  void put(std::size_t port, int slot, std::uint32_t bits) {
    Port& p = ports_[port];
    if (slot < kSlots) {
      p.words[half_ * kSlots + static_cast<std::size_t>(slot)] |= bits;
      used_[port * kParts + half_] = true;
    } else {
      p.tail[static_cast<std::size_t>(slot - kSlots)] |= bits;
      used_[port * kParts + kTailUsed] = true;
    }
  }
  /// After pulses of a port's lane: it is emptied only then.
  void mark(std::size_t port) { used_[port * kParts + half_] = true; }
  /// The words of a port in the half that is filled.
  class Lane {
   public:
    explicit Lane(StepFrames& frames, std::size_t port)
        : frames_(frames), port_(port), words_(frames.ports_[port].words.data() + frames.half_ * kSlots) {}
    /// A pulse that begins kSetUp after `slot`; pins: as Words has them. mark() has to follow.
    [[gnu::always_inline]] void pulse(int slot, std::uint32_t pins) {
      if (slot < kEarly) [[likely]] {
        early_pulse(slot, pins);
      } else {
        frames_.put(port_, slot + kSetUp, Words::high(pins));
        frames_.put(port_, slot + kSetUp + kPulse, Words::low(pins));
      }
    }

    /// The same, of a slot before kEarly.
    [[gnu::always_inline]] void early_pulse(int slot, std::uint32_t pins) {
      std::uint32_t* word = words_ + slot;
      asm("" : "+r"(word));  // one address for both: the compiler would reckon two
      word[kSetUp] |= Words::high(pins);
      word[kSetUp + kPulse] |= Words::low(pins);
    }

   private:
    StepFrames& frames_;
    std::size_t port_;
    std::uint32_t* words_;
  };
  Lane lane(std::size_t port) { return Lane(*this, port); }
  /// Both halves of a port, one after the other.
  const std::array<std::uint32_t, std::size_t{2} * kSlots>& words(std::size_t port) const {
    return ports_[port].words;
  }

 private:
  struct Port {
    std::array<std::uint32_t, std::size_t{2} * kSlots> words{};
    std::array<std::uint32_t, kTail> tail{};
  };
  std::array<Port, kPorts> ports_{};
  std::size_t half_ = 0;
  // Not empty, by port: the two halves, and the tail.
  static constexpr std::size_t kTailUsed = 2, kParts = 4;
  std::array<bool, kParts * kPorts> used_{};
};

}  // namespace kinebus::step
