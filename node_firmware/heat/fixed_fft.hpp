#pragma once
// A Fourier transform of 1024 points in whole numbers, done in small pieces: on a core without multiplication
// of 64 bits all of it takes longer than control may wait.

#include <array>
#include <cstdint>

namespace kinebus::heat {

class FixedFft {
 public:
  static constexpr int kBits = 10, kPoints = 1 << kBits;
  static constexpr int kButterflies = kBits * kPoints / 2;
  struct Complex {
    std::int32_t re = 0, im = 0;
  };

  /// Before begin(): in the order of time, |re| and |im| at most 2^20.
  Complex& input(int point) { return points_[reversed(static_cast<unsigned>(point))]; }
  void begin() { stage_ = next_ = 0; }
  /// Does at most so many of its butterflies; true: it is done.
  bool step(int butterflies);
  /// Afterwards: the sums of input * exp(-2 pi i k n / kPoints).
  const Complex& output(int bin) const { return points_[static_cast<std::size_t>(bin)]; }

  /// sin(2 pi i / kPoints), 2^-15.
  static std::int32_t sine(int i);
  static std::int32_t cosine(int i) { return sine(i + kPoints / 4); }

 private:
  static unsigned reversed(unsigned point);

  std::array<Complex, kPoints> points_{};
  int stage_ = kBits, next_ = 0;
};

}  // namespace kinebus::heat
