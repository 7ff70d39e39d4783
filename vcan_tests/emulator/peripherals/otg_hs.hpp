#pragma once
// OTG_HS or OTG_FS in device mode with its own full-speed transceiver, as RM0090 and RM0390 tell it:
// registers on one side, a host's transactions on the other. It is strict: what the manuals forbid, or the
// errata, is noted.

#include <array>
#include <deque>
#include <string>
#include <vector>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

/// How one such core differs from another.
struct OtgFacts {
  int irq = 77;
  std::uint32_t memory_words = 1024;
  int endpoints = 6;
  /// Its GCCFG and GOTGCTL are the F446's: whether VBUS is there is said elsewhere, and DCTL begins detached.
  bool later_core = false;
};

class OtgHs final : public Peripheral {
 public:
  static constexpr int kIrq = OtgFacts{}.irq;
  using Bytes = std::vector<std::uint8_t>;
  enum class Answer : std::uint8_t { kNothing, kAck, kNak, kStall };
  struct Received {
    Answer answer = Answer::kNothing;
    Bytes bytes;
    int toggle = 0;
  };

  explicit OtgHs(InterruptLines& lines, const OtgFacts& facts = {}) : lines_(lines), facts_(facts) {
    reset();
  }

  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  void reset();

  // What a host sees on the cable. Where VBUS goes is the board's matter: the core is told not to sense it.
  /// D+ is pulled up: a full-speed device is there.
  bool pulled_up(Cycle now) const;
  void bus_reset();
  void start_of_frame();
  /// Nothing on the bus for 3 ms.
  void suspend();
  Answer setup(int address, const std::array<std::uint8_t, 8>& bytes);
  Answer out(int address, int endpoint, const Bytes& bytes, int toggle);
  Received in(int address, int endpoint);

  /// What the program did against the rules.
  const std::vector<std::string>& violations() const { return violations_; }
  /// Packets in the receive FIFO that the program has not taken.
  std::size_t untaken() const { return receive_.size(); }

 private:
  static constexpr int kEndpoints = 6;
  struct Endpoint {
    std::uint32_t ctl = 0, interrupt = 0, tsiz = 0, written = 0;
    int toggle = 0;
    bool nak = true;
    std::deque<std::uint32_t> fifo;
  };
  struct Entry {
    std::uint32_t status = 0;
    std::deque<std::uint32_t> words;
  };
  std::uint32_t status() const;
  std::uint32_t endpoint_read(std::uint32_t offset);
  void endpoint_write(std::uint32_t offset, std::uint32_t value);
  void write_control(Endpoint& e, bool is_in, int number, std::uint32_t value);
  void write_fifo(int number, std::uint32_t value);
  void write_reset(std::uint32_t value);
  std::uint32_t pop_status();
  std::uint32_t pop_word();
  void push(int endpoint, std::uint32_t what, const Bytes& bytes, int toggle);
  bool room_for(std::size_t bytes) const;
  std::uint32_t send_words(int number) const;
  bool addressed(int address) const { return address == static_cast<int>(address_); }
  std::uint32_t programmed_address() const;
  void violation(const std::string& what);
  void update_line();

  InterruptLines& lines_;
  OtgFacts facts_;
  std::array<std::uint32_t, 0x1000 / 4> plain_{};
  std::array<Endpoint, kEndpoints> in_, out_;
  std::deque<Entry> receive_;
  std::deque<std::uint32_t> reading_;  // words of the packet whose status was taken
  std::uint32_t flags_ = 0;            // GINTSTS bits that stay until cleared
  std::uint32_t address_ = 0;          // in force: a new one once the status stage has gone out
  int writing_ = -1;                   // the FIFO into which a packet is not yet wholly written
  Cycle forced_at_ = kNever;
  std::vector<std::string> violations_;
};

}  // namespace kinebus::emulator
