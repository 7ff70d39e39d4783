#include "node_firmware/heat/fixed_fft.hpp"

#include <utility>

namespace kinebus::heat {
namespace {

constexpr int kQuarter = FixedFft::kPoints / 4;
constexpr double kTurn = 6.283185307179586;

/// Enough terms for a quarter of a turn.
constexpr double sine_of(double x) {
  double term = x, sum = x;
  for (int n = 1; n < 10; ++n) {
    term *= -x * x / (2 * n * (2 * n + 1));
    sum += term;
  }
  return sum;
}

constexpr std::array<std::int16_t, kQuarter + 1> kSines = [] {
  std::array<std::int16_t, kQuarter + 1> table{};
  for (int i = 0; i <= kQuarter; ++i) {
    const double sine = 32'767 * sine_of(kTurn * i / FixedFft::kPoints);
    const int below = static_cast<int>(sine);
    table[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(sine - below < 0.5 ? below : below + 1);
  }
  return table;
}();

std::int32_t scaled(std::int32_t value, std::int32_t by) {
  return static_cast<std::int32_t>((std::int64_t{value} * by + (1 << 14)) >> 15);
}

}  // namespace

std::int32_t FixedFft::sine(int i) {
  const int at = i & (kPoints - 1);
  const int within = at & (2 * kQuarter - 1);
  const std::int32_t value =
      kSines[static_cast<std::size_t>(within <= kQuarter ? within : 2 * kQuarter - within)];
  return at < 2 * kQuarter ? value : -value;
}

unsigned FixedFft::reversed(unsigned point) {
  unsigned out = 0;
  for (int bit = 0; bit < kBits; ++bit) out |= (point >> bit & 1u) << (kBits - 1 - bit);
  return out;
}

bool FixedFft::step(int butterflies) {
  for (; butterflies > 0 && stage_ < kBits; --butterflies) {
    const int half = 1 << stage_;
    const int within = next_ & (half - 1);
    const int at = ((next_ >> stage_) << (stage_ + 1)) + within;
    const auto low = static_cast<std::size_t>(at);
    Complex& a = points_[low];
    Complex& b = points_[low + static_cast<std::size_t>(half)];
    const int turn = within << (kBits - 1 - stage_);
    const std::int32_t c = cosine(turn), s = sine(turn);
    const Complex t{scaled(b.re, c) + scaled(b.im, s), scaled(b.im, c) - scaled(b.re, s)};
    b = {a.re - t.re, a.im - t.im};
    a = {a.re + t.re, a.im + t.im};
    if (++next_ == kPoints / 2) {
      next_ = 0;
      ++stage_;
    }
  }
  return stage_ == kBits;
}

}  // namespace kinebus::heat
