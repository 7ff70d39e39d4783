#pragma once
// A DMA controller of the STM32F4: streams that carry words from memory to a peripheral, or half-words from a
// peripheral to memory, one for each request, in direct mode: the next word is fetched from memory as soon as
// one has been written. Other kinds of transfer are refused with an error flag.

#include <array>
#include <functional>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

class Dma final : public Peripheral {
 public:
  static constexpr int kStreams = 8;
  /// irqs: by stream.
  Dma(InterruptLines& lines, const std::array<int, kStreams>& irqs) : lines_(lines), irqs_(irqs) {}

  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  void reset();

  /// A peripheral asks this stream, by this channel, for a word.
  void on_request(int stream, int channel, Cycle at);

  std::function<std::uint32_t(std::uint32_t address)> fetch;                     ///< from memory
  std::function<void(std::uint32_t address, std::uint32_t word, Cycle at)> put;  ///< to a peripheral
  std::function<std::uint32_t(std::uint32_t address, Cycle at)> take;            ///< from a peripheral
  std::function<void(std::uint32_t address, std::uint32_t half_word)> keep;      ///< in memory

 private:
  struct Stream {
    std::uint32_t cr = 0, ndtr = 0, par = 0, m0ar = 0, m1ar = 0, fcr = 0x21;
    std::uint32_t left = 0;  ///< of the transfers; 0 when all were made
    std::uint32_t word = 0;  ///< fetched, and not yet written
  };
  static bool to_memory(const Stream& s) { return (s.cr >> 6 & 3) == 0; }
  void begin(int stream);
  void raise(int stream, std::uint32_t flag);
  void update_line(int stream);

  InterruptLines& lines_;
  std::array<int, kStreams> irqs_;
  std::array<Stream, kStreams> streams_{};
  std::array<std::uint32_t, kStreams> flags_{};
};

}  // namespace kinebus::emulator
