#include "tools/simulation/job_generator.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace kinebus {
namespace {

constexpr double kPi = std::numbers::pi;
// 0.45 mm wide, 0.2 mm high lines of 1.75 mm filament.
constexpr double kFilamentPerMm = 0.45 * 0.2 / (kPi * 0.875 * 0.875);

/// Collects text and passes it on in large pieces; keeps the slicer's state (E, retraction).
class Writer {
 public:
  explicit Writer(const TextSink& sink) : sink_(sink) { text_.reserve(1 << 17); }
  ~Writer() { sink_(text_); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  template <typename... Args>
  void put(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
    ++lines_;
    if (text_.size() > (1 << 16)) {
      sink_(text_);
      text_.clear();
    }
  }
  std::uint32_t lines() const { return lines_; }

  void header(const char* what) {
    put("; {}", what);
    put("G21");
    put("G90");
    put("M82");
    put("G92 E0");
  }
  void travel(double x, double y) {
    put("G1 E{:.5f} F2400", e_ - 0.8);
    put("G1 X{:.3f} Y{:.3f} F12000", x, y);
    put("G1 E{:.5f} F2400", e_);
    at_ = {x, y};
  }
  /// Prints to a point; `feed` in mm/min is written when it is not 0.
  void extrude(double x, double y, double feed = 0) {
    e_ += kFilamentPerMm * std::abs(std::complex(x, y) - at_);
    at_ = {x, y};
    if (feed != 0)
      put("G1 X{:.3f} Y{:.3f} E{:.5f} F{:.0f}", x, y, e_, feed);
    else
      put("G1 X{:.3f} Y{:.3f} E{:.5f}", x, y, e_);
  }
  std::complex<double> at() const { return at_; }

 private:
  const TextSink& sink_;
  std::string text_;
  std::uint32_t lines_ = 0;
  std::complex<double> at_{};
  double e_ = 0;
};

/// Two turning vectors: smooth everywhere, smallest radius of curvature about 11 mm.
std::complex<double> rosette(double t) {
  return std::polar(50.0, t) + std::polar(12.0, 2.618 * t);
}

/// The parameter whose curve point is `distance` from the present one.
template <typename Curve>
double advance_by(const Curve& curve, double t, double distance) {
  const auto from = curve(t);
  double step = 1e-4;
  for (int i = 0; i < 6; ++i) step *= distance / std::max(curve.distance(from, curve(t + step)), 1e-12);
  return t + step;
}

struct PlaneCurve {
  std::complex<double> operator()(double t) const { return rosette(t); }
  static double distance(std::complex<double> a, std::complex<double> b) { return std::abs(b - a); }
};

void write_dense_curve(const TextSink& sink, std::uint32_t lines) {
  Writer out(sink);
  out.header("0.2 mm lines along a smooth curve at 100 mm/s");
  const PlaneCurve curve;
  double t = 0, e = 0;
  out.put("G1 Z0.2 F6000");
  out.put("G1 X{:.3f} Y{:.3f} F12000", curve(t).real(), curve(t).imag());
  out.put("G1 F6000");
  for (std::uint32_t i = 0; i < lines; ++i) {
    t = advance_by(curve, t, 0.2);
    e += 0.2 * kFilamentPerMm;
    out.put("G1 X{:.3f} Y{:.3f} E{:.5f}", curve(t).real(), curve(t).imag(), e);
  }
}

struct SpacePoint {
  std::array<double, 3> x{};
  double a_deg = 0, c_deg = 0;
};

/// A wavy ring on a tilting, turning table.
struct SpaceCurve {
  SpacePoint operator()(double t) const {
    const double radius = 35 + 8 * std::sin(0.31 * t);
    return {
        {radius * std::cos(t), radius * std::sin(t), 25 + 12 * std::sin(0.83 * t) + 6 * std::sin(0.17 * t)},
        15 + 14 * std::sin(0.4 * t),
        40 * std::sin(0.23 * t) - 20 * t};
  }
  static double distance(const SpacePoint& p, const SpacePoint& q) {
    return std::hypot(q.x[0] - p.x[0], q.x[1] - p.x[1], q.x[2] - p.x[2]);
  }
};

void write_five_axis(const TextSink& sink, std::uint32_t lines) {
  Writer out(sink);
  out.header("0.2 mm lines at 100 mm/s, tilt and table turning under tool-centre-point control");
  out.put("G43.4");
  const SpaceCurve curve;
  double t = 0, e = 0;
  const auto put = [&](const SpacePoint& p, const char* end) {
    out.put("G1 X{:.3f} Y{:.3f} Z{:.3f} A{:.4f} C{:.4f}{}", p.x[0], p.x[1], p.x[2], p.a_deg, p.c_deg, end);
  };
  put(curve(t), " F3000");
  out.put("G1 F6000");
  for (std::uint32_t i = 0; i < lines; ++i) {
    t = advance_by(curve, t, 0.2);
    e += 0.2 * kFilamentPerMm;
    put(curve(t), fmt::format(" E{:.5f}", e).c_str());
  }
  out.put("G1 A0 C{:.4f} F1800", curve(t).c_deg);
  out.put("G49");
}

double gear_radius(double angle, double inset) {
  return 34 + 3.5 * std::tanh(4 * std::cos(12 * angle)) - inset;
}

void gear_outline(Writer& out, double inset, double feed) {
  constexpr int kCorners = 180;
  const auto point = [&](int i) {
    return std::polar(gear_radius(2 * kPi * i / kCorners, inset), 2 * kPi * i / kCorners);
  };
  out.travel(point(0).real(), point(0).imag());
  for (int i = 1; i <= kCorners; ++i) out.extrude(point(i).real(), point(i).imag(), i == 1 ? feed : 0);
}

/// Lines at 45 degrees (turning by 90 from layer to layer), joined by short moves along the rim.
void gear_infill(Writer& out, int layer, double feed) {
  const std::complex<double> turn = std::polar(1.0, kPi / 4 + (layer % 2) * kPi / 2);
  constexpr double kRadius = 28.5, kPitch = 0.9;
  constexpr int kLines = static_cast<int>(2 * kRadius / kPitch);
  bool first = true, back = false;
  for (int line = 1; line <= kLines; ++line, back = !back) {
    const double y = -kRadius + kPitch * line;
    const double x = std::sqrt(kRadius * kRadius - y * y);
    const auto a = turn * std::complex(back ? x : -x, y), b = turn * std::complex(back ? -x : x, y);
    if (first)
      out.travel(a.real(), a.imag());
    else
      out.extrude(a.real(), a.imag());
    out.extrude(b.real(), b.imag(), first ? feed : 0);
    first = false;
  }
}

void write_print(const TextSink& sink, std::uint32_t lines) {
  Writer out(sink);
  out.header("gear: three perimeters and infill a layer, retraction before every travel");
  for (int layer = 0; out.lines() < lines; ++layer) {
    out.put(";LAYER:{}", layer);
    out.put("G1 Z{:.1f} F12000", 0.2 * (layer % 900 + 1));
    out.put(";TYPE:Perimeter");
    for (const double inset : {0.9, 0.45, 0.0}) gear_outline(out, inset, inset == 0 ? 2400 : 3600);
    out.put(";TYPE:Infill");
    gear_infill(out, layer, 4800);
  }
}

void write_demo(const TextSink& sink, std::uint32_t lines) {
  Writer out(sink);
  out.header("a lobed vase, printed as one spiral on a base of two layers");
  out.put("M104 S205");
  out.put("M109 S205");
  out.put("M106 S255");
  const auto vase = [](double turns) {
    const double height = turns * 0.6, angle = 2 * kPi * turns;
    const double radius = 22 + 7 * std::sin(height / 9) + 3.0 * std::cos(5 * angle + height / 12);
    return std::polar(radius, angle);
  };
  out.put("G1 Z0.2 F6000");
  for (int layer = 0; layer < 2; ++layer) {
    out.put("G1 Z{:.1f} F6000", 0.2 * (layer + 1));
    const std::complex<double> turn = std::polar(1.0, kPi / 4 + layer * kPi / 2);
    bool back = false;
    for (int line = 0; line <= 20; ++line, back = !back) {
      const double y = -18 + 1.8 * line;
      const double x = std::sqrt(20.0 * 20.0 - y * y) * (back ? -1 : 1);
      const auto a = turn * std::complex(-x, y), b = turn * std::complex(x, y);
      if (line == 0)
        out.travel(a.real(), a.imag());
      else
        out.extrude(a.real(), a.imag());
      out.extrude(b.real(), b.imag(), 6000);
    }
  }
  out.put(";TYPE:External perimeter");
  out.travel(vase(0).real(), vase(0).imag());
  constexpr int kCorners = 120;
  const double speed_mm_per_min = 9000;
  double e_line = 0;
  for (std::uint32_t i = 1; i <= lines; ++i) {
    const double turns = static_cast<double>(i) / kCorners;
    const auto p = vase(turns);
    if (i == 1) out.put("G92 E0");
    e_line += kFilamentPerMm * 2.2 * std::abs(p - vase(turns - 1.0 / kCorners));
    out.put("G1 X{:.3f} Y{:.3f} Z{:.3f} E{:.5f}{}", p.real(), p.imag(), 0.4 + turns * 0.6, e_line,
            i == 1 ? fmt::format(" F{:.0f}", speed_mm_per_min) : "");
  }
  out.put("G1 E{:.5f} F2400", e_line - 1);
  out.put("G1 Z{:.3f} F6000", 0.4 + lines * 0.6 / kCorners + 10);
  out.put("M104 S0");
  out.put("M107");
}

}  // namespace

const std::vector<JobKind>& job_kinds() {
  static const std::vector<JobKind> kinds{
      {"dense-curve", "0.2 mm lines along a smooth curve at 100 mm/s", 500'000, write_dense_curve},
      {"five-axis", "0.2 mm lines, X Y Z A C E all moving under G43.4", 100'000, write_five_axis},
      {"print", "a gear with perimeters, infill, retractions", 110'000, write_print},
      {"demo", "a small lobed vase", 5'400, write_demo}};
  return kinds;
}

}  // namespace kinebus
