#pragma once
// bxCAN's filter banks (RM0090 32.7.4): which frames CAN1 keeps, in which FIFO, under which number.

#include <array>
#include <cstdint>
#include <optional>

#include "protocol/can/frame.hpp"

namespace kinebus::emulator {

class CanFilterBanks {
 public:
  static constexpr std::uint32_t kFrom = 0x200;  ///< offset of the first of their registers
  static constexpr std::uint32_t kRemote = 2, kExtended = 4;

  struct Match {
    int fifo = 0, index = 0;
  };

  std::uint32_t read(std::uint32_t offset) const;
  /// What cannot be written now, stays.
  void write(std::uint32_t offset, std::uint32_t value);
  std::optional<Match> match(const CanFrame& frame) const;
  /// As the mailbox of a FIFO and a wide filter have it: STID, EXID, IDE, RTR.
  static std::uint32_t identifier(const CanFrame& frame);

 private:
  static constexpr std::uint32_t kBanksFrom = 0x240;
  struct Bank {
    std::uint32_t r1 = 0, r2 = 0;
  };

  bool open() const { return (fmr_ & 1) != 0; }

  std::uint32_t fmr_ = 0x2A1C0E01, fm1r_ = 0, fs1r_ = 0, ffa1r_ = 0, fa1r_ = 0;
  std::array<Bank, 28> banks_{};
};

}  // namespace kinebus::emulator
