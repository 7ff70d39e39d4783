#pragma once
// Flash that can lose its power at any byte: what is being programmed or erased then is left in any state.

#include <array>
#include <cstdint>
#include <random>
#include <vector>

namespace kinebus {

struct PowerCut {};

class FlashModel {
 public:
  FlashModel(std::size_t bytes, std::uint32_t seed) : bytes_(bytes, 0xFF), random_(seed) {}

  /// After so many more bytes programmed or erased the power goes: PowerCut is thrown. < 0: never.
  void cut_after(std::int64_t bytes) { left_ = bytes; }

  std::span<const std::uint8_t> bytes() const { return bytes_; }
  void erase(std::size_t from, std::size_t length) {
    // Erasing changes all of a sector little by little: any cut leaves any mixture.
    if (left_ >= 0 && left_ < static_cast<std::int64_t>(length)) {
      const std::size_t kind = random_() % 3;
      for (std::size_t i = from; i < from + length; ++i)
        if (kind == 0 || (kind == 1 && random_() % 2 == 0))
          bytes_[i] = static_cast<std::uint8_t>(bytes_[i] | random_());
      throw PowerCut{};
    }
    if (left_ >= 0) left_ -= static_cast<std::int64_t>(length);
    std::fill_n(bytes_.begin() + static_cast<std::ptrdiff_t>(from), length, std::uint8_t{0xFF});
  }
  bool program(std::size_t at, std::uint32_t word) {
    bool good = true;
    for (int i = 0; i < 4; ++i) {
      const auto wanted = static_cast<std::uint8_t>(word >> (8 * i));
      std::uint8_t& byte = bytes_[at + static_cast<std::size_t>(i)];
      if (left_ == 0) {
        byte = static_cast<std::uint8_t>(byte & (wanted | random_()));  // some of its bits
        throw PowerCut{};
      }
      if (left_ > 0) --left_;
      byte = static_cast<std::uint8_t>(byte & wanted);
      good = good && byte == wanted;
    }
    return good;
  }
  std::uint64_t random() { return random_(); }

 private:
  std::vector<std::uint8_t> bytes_;
  std::mt19937 random_;
  std::int64_t left_ = -1;
};

}  // namespace kinebus
