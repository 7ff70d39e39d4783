#include "gui/screenshots/demo_job.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace kinebus::gui {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kFilamentPerMm = 0.033;

/// Writes moves with as much extrusion as they are long.
class Writer {
 public:
  void line(const char* text) {
    text_ += text;
    text_ += '\n';
  }
  void travel(double x, double y, double z) {
    char text[120];
    text_.append(text, std::snprintf(text, sizeof text, "G0 X%.3f Y%.3f Z%.3f\n", x, y, z));
    x_ = x;
    y_ = y;
  }
  void work(double x, double y, double feed_mm_per_min) {
    e_ += std::hypot(x - x_, y - y_) * kFilamentPerMm;
    char text[120];
    text_.append(text,
                 std::snprintf(text, sizeof text, "G1 X%.3f Y%.3f E%.4f F%.0f\n", x, y, e_, feed_mm_per_min));
    x_ = x;
    y_ = y;
  }
  QByteArray take() { return std::move(text_); }

 private:
  QByteArray text_;
  double x_ = 0, y_ = 0, e_ = 0;
};

double wall_mm(double angle, double height, double offset) {
  const double swell = 34 + 11 * std::sin(height * 3.4 + 0.4);
  return swell + 2.6 * std::sin(8 * angle + height * 5) - offset;
}

void ring(Writer& w, double height, double z, double offset, int pieces, double feed) {
  for (int i = 0; i <= pieces; ++i) {
    const double angle = kTurn * i / pieces, r = wall_mm(angle, height, offset);
    if (i == 0)
      w.travel(r, 0, z);
    else
      w.work(r * std::cos(angle), r * std::sin(angle), feed);
  }
}

}  // namespace

QByteArray vase_job(int layers, int walls, double layer_mm) {
  Writer w;
  for (const char* text : {"; vase", "G21", "G90", "M82", "M140 S40", "M109 S180", "G92 E0", "M106 S200"})
    w.line(text);
  for (int layer = 0; layer < layers; ++layer) {
    const double z = layer_mm * (layer + 1), height = z / 30;
    for (int k = 1; k <= walls; ++k) {
      w.line(k == walls ? ";TYPE:External perimeter" : ";TYPE:Perimeter");
      ring(w, height, z, 0.45 * (walls - k), 80, k == walls && walls > 1 ? 3600 : 6600);
    }
    if (z > 1) continue;
    w.line(";TYPE:Solid infill");
    for (int row = 0; row <= 50; ++row) {
      const double y = -30 + 1.2 * row;
      const double x = std::sqrt(std::max(0.0, 31.0 * 31 - y * y)) * (row % 2 == 0 ? -1 : 1);
      w.travel(-x, y, z);
      w.work(x, y, 9000);
    }
  }
  for (const char* text : {"M107", "M104 S0", "M140 S0"}) w.line(text);
  return w.take();
}

QByteArray wrong_job() {
  Writer w;
  for (const char* text : {"; too wide for the machine", "G21", "G90", "M82", "M109 S180", "G92 E0"})
    w.line(text);
  for (int layer = 0; layer < 6; ++layer) ring(w, 0.1, 0.25 * (layer + 1), 0, 60, 4800);
  for (const char* text : {"G1 X210 Y40 E200 F3000", "G1 X0 Y0 Z400", "G1 A80 F600", "G1 X0 Y0 Z20 A0"})
    w.line(text);
  return w.take();
}

QByteArray long_job(int lines) {
  Writer w;
  for (const char* text : {"G21", "G90", "M82", "G92 E0"}) w.line(text);
  constexpr int kPieces = 500, kRings = 4;
  const int layers = lines / (kPieces * kRings) + 1;
  for (int layer = 0; layer < layers; ++layer)
    for (int k = 0; k < kRings; ++k)
      ring(w, 2.0 * layer / layers, 0.2 * (layer + 1), 0.45 * k, kPieces, 2400 + 600.0 * k);
  return w.take();
}

}  // namespace kinebus::gui
