#include "vcan_tests/emulator/peripherals/bxcan_filters.hpp"

namespace kinebus::emulator {
namespace {

// The identifier as a 16-bit filter has it: STDID, RTR, IDE, EXID[17:15].
std::uint32_t short_identifier(const CanFrame& frame) {
  const std::uint32_t rtr = frame.remote ? 1u << 4 : 0;
  if (!frame.extended) return frame.id << 5 | rtr;
  return (frame.id >> 18) << 5 | rtr | 1u << 3 | (frame.id >> 15 & 7);
}

}  // namespace

std::uint32_t CanFilterBanks::identifier(const CanFrame& frame) {
  return (frame.extended ? frame.id << 3 | kExtended : frame.id << 21) | (frame.remote ? kRemote : 0);
}

std::uint32_t CanFilterBanks::read(std::uint32_t offset) const {
  if (offset >= kBanksFrom) {
    const std::uint32_t number = (offset - kBanksFrom) / 8;
    if (number >= banks_.size()) return 0;
    return (offset & 4) == 0 ? banks_[number].r1 : banks_[number].r2;
  }
  switch (offset) {
    case 0x200:
      return fmr_;
    case 0x204:
      return fm1r_;
    case 0x20C:
      return fs1r_;
    case 0x214:
      return ffa1r_;
    case 0x21C:
      return fa1r_;
    default:
      return 0;
  }
}

void CanFilterBanks::write(std::uint32_t offset, std::uint32_t value) {
  if (offset >= kBanksFrom) {
    const std::uint32_t number = (offset - kBanksFrom) / 8;
    if (number >= banks_.size()) return;
    if (!open() && (fa1r_ >> number & 1) != 0) return;  // only inactive banks may change
    Bank& bank = banks_[number];
    ((offset & 4) == 0 ? bank.r1 : bank.r2) = value;
    return;
  }
  switch (offset) {
    case 0x200:
      fmr_ = value;
      break;
    case 0x204:
      if (open()) fm1r_ = value;
      break;
    case 0x20C:
      if (open()) fs1r_ = value;
      break;
    case 0x214:
      if (open()) ffa1r_ = value;
      break;
    case 0x21C:
      fa1r_ = value;
      break;
    default:
      break;
  }
}

std::optional<CanFilterBanks::Match> CanFilterBanks::match(const CanFrame& frame) const {
  if (open()) return std::nullopt;
  const std::uint32_t banks = fmr_ >> 8 & 0x3F;  // the rest belongs to CAN2
  std::array<int, 2> index{};
  std::optional<Match> found;
  int best_rank = 4;  // 32 bits before 16, list before mask
  const std::uint32_t wide = identifier(frame);
  const std::uint32_t narrow = short_identifier(frame);
  for (std::uint32_t b = 0; b < banks && b < banks_.size(); ++b) {
    const Bank& bank = banks_[b];
    const bool is_wide = (fs1r_ >> b & 1) != 0, list = (fm1r_ >> b & 1) != 0, active = (fa1r_ >> b & 1) != 0;
    const std::size_t fifo = ffa1r_ >> b & 1;
    std::array<bool, 4> hits{};
    int filters = 0;
    if (is_wide && !list) {
      filters = 1;
      hits[0] = ((wide ^ bank.r1) & bank.r2 & ~1u) == 0;
    } else if (is_wide) {
      filters = 2;
      hits[0] = ((wide ^ bank.r1) & ~1u) == 0;
      hits[1] = ((wide ^ bank.r2) & ~1u) == 0;
    } else if (!list) {
      filters = 2;
      hits[0] = ((narrow ^ bank.r1) & (bank.r1 >> 16) & 0xFFFF) == 0;
      hits[1] = ((narrow ^ bank.r2) & (bank.r2 >> 16) & 0xFFFF) == 0;
    } else {
      filters = 4;
      hits = {narrow == (bank.r1 & 0xFFFF), narrow == bank.r1 >> 16, narrow == (bank.r2 & 0xFFFF),
              narrow == bank.r2 >> 16};
    }
    const int rank = (is_wide ? 0 : 2) + (list ? 0 : 1);
    for (int i = 0; i < filters; ++i)
      if (active && hits[static_cast<std::size_t>(i)] && rank < best_rank) {
        best_rank = rank;
        found = Match{static_cast<int>(fifo), index[fifo] + i};
      }
    index[fifo] += filters;
  }
  return found;
}

}  // namespace kinebus::emulator
