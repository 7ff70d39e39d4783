#pragma once
// One FDCAN instance of the STM32G0 with its part of the message RAM (RM0444): classic frames, 28 standard
// filters, two receive FIFOs of three, three transmit buffers as FIFO or queue, error counters up to bus-off,
// which it leaves only when the program lets it go.
//
// What the manual leaves open is done in the way that is hardest for a program: message RAM holds anything
// after power-on, protected registers take nothing without CCE, a transmit buffer that is not the one of the
// put index is lost, and 11 recessive bits go by before it takes part.

#include <array>
#include <optional>

#include "vcan_tests/emulator/peripherals/can_controller.hpp"
#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

class Fdcan final : public Peripheral, public CanController {
 public:
  static constexpr std::uint32_t kMemoryBytes = 0x350;
  /// irqs: of interrupt lines 0 and 1.
  Fdcan(InterruptLines& lines, int irq0, int irq1) : lines_(lines), irqs_{irq0, irq1} { reset(); }

  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  Cycle next_event() const override { return joins_; }
  void advance(Cycle now) override;
  void reset();
  /// Its part of the message RAM; keeps what it has over a reset.
  std::uint32_t read_memory(std::uint32_t offset) const { return memory_[offset / 4]; }
  void write_memory(std::uint32_t offset, std::uint32_t value) { memory_[offset / 4] = value; }
  void lose_memory();

  std::vector<Request> take_requests() override;
  void on_sent(int buffer) override;
  void on_aborted(int buffer) override;
  void on_frame(const CanFrame& frame, Cycle now) override;
  void on_error(bool sending, Cycle now) override;
  void on_no_acknowledge(Cycle now) override;
  bool bus_off() const override { return bus_off_; }
  bool listening() const override { return (cccr_ & 1) == 0 && joined_ && !bus_off_; }

  /// Bits a second and sample point as the registers say, at 64 MHz.
  std::uint32_t bit_rate() const;
  double sample_point() const;
  const Counters& counters() const { return counters_; }

 private:
  struct Fifo {
    std::uint32_t count = 0, get = 0;
    bool lost = false;
  };
  CanFrame frame_of(int buffer) const;
  /// The FIFO of the first filter that fits; what fits none goes as RXGFC says.
  std::optional<std::size_t> match(const CanFrame& frame) const;
  void store(std::size_t fifo, const CanFrame& frame);
  void leave_init(Cycle now);
  void send_pending(Cycle now);
  void watch_errors();
  std::uint32_t state() const;
  void update_lines();
  bool configurable() const { return (cccr_ & 3) == 3; }
  int put_index() const;

  InterruptLines& lines_;
  std::array<int, 2> irqs_;
  std::uint32_t cccr_ = 1, nbtp_ = 0, ir_ = 0, ie_ = 0, ils_ = 0, ile_ = 0, rxgfc_ = 0, txbc_ = 0;
  std::uint32_t pending_ = 0, occurred_ = 0, cancelled_ = 0, cancelling_ = 0;
  std::array<Fifo, 2> fifos_{};
  std::array<std::uint32_t, kMemoryBytes / 4> memory_{};
  std::uint32_t tec_ = 0, rec_ = 0, last_state_ = 0;
  bool bus_off_ = false, joined_ = false;
  Cycle joins_ = kNever;
  std::vector<Request> requests_;
  Counters counters_{};
};

/// The message RAM as a place of its own on the bus: instance 1, then 2.
class CanMessageRam final : public Peripheral {
 public:
  explicit CanMessageRam(Fdcan& second) : second_(second) {}
  std::uint32_t read(std::uint32_t offset, Cycle) override {
    return offset >= Fdcan::kMemoryBytes && offset < 2 * Fdcan::kMemoryBytes
               ? second_.read_memory(offset - Fdcan::kMemoryBytes)
               : 0;
  }
  void write(std::uint32_t offset, std::uint32_t value, Cycle) override {
    if (offset >= Fdcan::kMemoryBytes && offset < 2 * Fdcan::kMemoryBytes)
      second_.write_memory(offset - Fdcan::kMemoryBytes, value);
  }

 private:
  Fdcan& second_;
};

}  // namespace kinebus::emulator
