#pragma once
// Frames as text, in the notation of can-utils: 601#4041600000000000, 1F334455#1122, 123#R; in logs with time
// and interface in front: (1436509052.249713) can0 601#4041600000000000

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>

#include "protocol/can/frame.hpp"

namespace kinebus {

/// A short text in a buffer of its own.
template <std::size_t kCapacity>
class FixedText {
 public:
  constexpr std::string_view view() const { return {chars_.data(), size_}; }
  constexpr operator std::string_view() const { return view(); }
  constexpr void add(char c) {
    if (size_ < kCapacity) chars_[size_++] = c;
  }
  constexpr void add(std::string_view text) {
    for (const char c : text) add(c);
  }
  constexpr void clear() { size_ = 0; }

 private:
  std::array<char, kCapacity> chars_{};
  std::size_t size_ = 0;
};

using FrameText = FixedText<32>;
using CandumpText = FixedText<80>;

struct CandumpLine {
  std::optional<std::chrono::microseconds> time;  ///< as written, any epoch
  std::string_view interface {};                  ///< part of the parsed line; may be empty
  CanFrame frame;
};

FrameText to_text(const CanFrame& frame);
/// A line of a log, as `candump -l` writes it, without a line end.
CandumpText to_candump(const CandumpLine& line);

/// The frame alone; blanks around it are fine. Identifiers: 3 hex digits (up to 7FF), or 8 (29 bits). Dots
/// between data bytes are read over. nullopt: anything else, CAN FD included.
std::optional<CanFrame> parse_frame(std::string_view text);
/// A frame with or without time and interface in front of it.
std::optional<CandumpLine> parse_candump(std::string_view line);

}  // namespace kinebus
