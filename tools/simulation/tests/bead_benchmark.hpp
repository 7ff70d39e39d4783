#pragma once
// The job that beads are judged by.

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace kinebus {

/// Beads of 0.45 x 0.2 mm: a skirt, corners, squares of 3 and 1.5 mm, changes of speed, a zigzag; travels
/// with retraction.
class BeadBenchmark {
 public:
  BeadBenchmark() {
    text_ = "G21 G90 M83\nG92 E0\nM104 S210\nG1 Z5 F6000\nG1 E1 F600\n";
    travel(-35, -35);
    line(-5, -35, 1200);
    rectangle(-30, -30, 60, 60, 6000);
    rectangle(-25, -25, 20, 10, 4800);
    for (int i = 0; i < 6; ++i) rectangle(-20 + 7 * i, -5, 3, 3, 3600);
    for (int i = 0; i < 4; ++i) rectangle(-20 + 7 * i, 5, 1.5, 1.5, 3000);
    travel(-25, 15);
    for (int i = 0; i < 3; ++i) {
      line(x_ + 8, 15, 6000);
      line(x_ + 4, 15, 1200);
      line(x_ + 5, 15, 4800);
    }
    travel(-25, 20);
    for (int i = 0; i < 20; ++i) line(x_ + 2, i % 2 == 0 ? 22 : 20, 5400);
  }
  const std::string& text() const { return text_; }

 private:
  void travel(double x, double y) {
    text_ += fmt::format("G1 E-0.8 F2100\nG0 X{:.3f} Y{:.3f} F12000\nG1 E0.8 F2100\n", x, y);
    x_ = x, y_ = y;
  }
  void line(double x, double y, int feed) {
    constexpr double kPerMm = 0.45 * 0.2 / (1.75 * 1.75 * 0.7853981634);
    const double e = std::hypot(x - x_, y - y_) * kPerMm;
    text_ += fmt::format("G1 X{:.3f} Y{:.3f} E{:.5f} F{}\n", x, y, e, feed);
    x_ = x, y_ = y;
  }
  void rectangle(double x, double y, double width, double height, int feed) {
    travel(x, y);
    line(x + width, y, feed);
    line(x + width, y + height, feed);
    line(x, y + height, feed);
    line(x, y, feed);
  }
  std::string text_;
  double x_ = 0, y_ = 0;
};

}  // namespace kinebus
