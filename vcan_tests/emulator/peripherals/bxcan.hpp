#pragma once
// bxCAN: three mailboxes, two FIFOs of three with overrun, filter banks, error counters up to bus-off and
// back. The bus is outside: it asks for what is to be sent, and tells what was sent, what came, and what went
// wrong.

#include <array>
#include <cstdint>
#include <vector>

#include "protocol/can/frame.hpp"
#include "vcan_tests/emulator/peripherals/bxcan_filters.hpp"
#include "vcan_tests/emulator/peripherals/can_controller.hpp"
#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

class BxCan final : public Peripheral, public CanController {
 public:
  static constexpr int kTransmitIrq = 19, kFifo0Irq = 20, kFifo1Irq = 21, kStateIrq = 22;

  explicit BxCan(InterruptLines& lines) : lines_(lines) {}
  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  Cycle next_event() const override { return recovers_ < joins_ ? recovers_ : joins_; }
  void advance(Cycle now) override;
  void reset();

  // The bus.
  std::vector<Request> take_requests() override;
  /// It takes part: out of its initialisation, and 11 recessive bits were seen since.
  bool listening() const override { return (mcr_ & 3) == 0 && joined_ && !bus_off_; }
  /// The bus is held dominant, as by a broken transceiver or a short, or let go.
  void set_dominant(bool dominant, Cycle now);
  void on_sent(int mailbox) override;
  void on_aborted(int mailbox) override;
  void on_frame(const CanFrame& frame, Cycle now) override;
  void on_error(bool sending, Cycle now) override;
  void on_no_acknowledge(Cycle now) override;

  /// Bits a second as the registers say; 0: not set up.
  std::uint32_t bit_rate() const;
  double sample_point() const;
  const Counters& counters() const { return counters_; }
  std::uint32_t transmit_errors() const { return tec_; }
  std::uint32_t receive_errors() const { return rec_; }
  bool bus_off() const override { return bus_off_; }

 private:
  struct Mailbox {
    std::uint32_t tir = 0, tdtr = 0, low = 0, high = 0;
    bool pending = false, abort_asked = false;
  };
  struct Stored {
    std::uint32_t rir = 0, rdtr = 0, low = 0, high = 0;
  };
  struct Fifo {
    std::array<Stored, 3> stored{};
    int count = 0;
    bool overrun = false, full_flag = false;
  };

  static CanFrame frame_of(const Mailbox& mailbox);
  void store(Fifo& fifo, const CanFrame& frame, int index);
  void enter_bus_off(Cycle now);
  void send_pending(Cycle now);
  void watch_errors();
  std::uint32_t tsr() const;
  std::uint32_t esr() const;
  void update_lines();

  InterruptLines& lines_;
  std::uint32_t mcr_ = 0x10002, msr_flags_ = 0, ier_ = 0, btr_ = 0x01230000, done_flags_ = 0;
  std::array<Mailbox, kMailboxes> mailboxes_{};
  std::array<Fifo, 2> fifos_{};
  CanFilterBanks filters_;
  std::uint32_t tec_ = 0, rec_ = 0;
  std::uint32_t last_state_ = 0, lec_ = 0;
  bool bus_off_ = false;
  Cycle recovers_ = kNever;
  bool joined_ = false, dominant_ = false;
  Cycle joins_ = kNever;
  std::vector<Request> requests_;
  Counters counters_{};
};

}  // namespace kinebus::emulator
