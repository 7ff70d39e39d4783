#pragma once
// What the emulated processor sees of a peripheral: a block of registers with a life of its own in time.
// Models know nothing of the processor that runs them, and are tested without it.

#include <cstdint>

#include "vcan_tests/emulator/cycle.hpp"

namespace kinebus::emulator {

/// Where a peripheral puts its interrupt request: a level, as on the chip.
class InterruptLines {
 public:
  virtual ~InterruptLines() = default;
  virtual void set_line(int irq, bool level) = 0;
};

class Peripheral {
 public:
  Peripheral() = default;
  Peripheral(const Peripheral&) = delete;
  Peripheral& operator=(const Peripheral&) = delete;
  virtual ~Peripheral() = default;

  /// `offset`: of the word, from the peripheral's base address. Reading may have side effects, as on the
  /// chip.
  virtual std::uint32_t read(std::uint32_t offset, Cycle now) = 0;
  /// A byte or half-word is written in its place in the word, the rest zero.
  virtual void write(std::uint32_t offset, std::uint32_t value, Cycle now) = 0;
  /// When advance() has something to do that nobody asks for (an interrupt, a trigger).
  virtual Cycle next_event() const { return kNever; }
  virtual void advance(Cycle now) { (void)now; }
};

}  // namespace kinebus::emulator
