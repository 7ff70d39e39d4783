#pragma once
// The drivers' UARTs: one wire each, open drain, one at a time at 40 kbaud. TIM8 counts quarters of a bit; in
// each DMA2 writes a word to the port of the wire and then reads the port. No instruction takes part, and the
// steps' words, which have the higher priority there, wait for one such word at most.

#include <array>
#include <cstdint>
#include <span>

#include "node_firmware/port/stm32f446_octopus/board.hpp"
#include "node_firmware/step/one_wire.hpp"
#include "node_firmware/step/tmc2209_datagram.hpp"

namespace kinebus::stm32 {

class DriverWire {
 public:
  /// After the pins were configured.
  static void start();
  /// Bytes to the driver, and room for those of its answer; the echo is heard, too.
  void begin(std::size_t driver, std::span<const std::uint8_t> said, std::size_t answer_bytes);
  bool done() const;
  std::size_t take(std::span<std::uint8_t> heard);

 private:
  static constexpr std::uint32_t kBaud = 40'000;
  static constexpr std::size_t kQuartersOfByte = step::kSamples * step::kBitsOfByte;
  // The driver waits for 8 bits before it answers; its clock may be slow by some per cent.
  static constexpr std::size_t kPatience = 16 * step::kSamples, kAfterLast = 2;
  static constexpr std::size_t kMostWords = tmc2209::kValueBytes * kQuartersOfByte,
                               kMostSamples =
                                   (tmc2209::kRequestBytes + tmc2209::kValueBytes) * kQuartersOfByte +
                                   kPatience;

  // Read and written by DMA.
  std::array<std::uint32_t, kMostWords> words_{};
  std::array<std::uint16_t, kMostSamples> samples_{};
  std::size_t count_ = 0;  ///< of samples
  OutputPin wire_ = octopus::kDrivers[0].uart;
};
}  // namespace kinebus::stm32
