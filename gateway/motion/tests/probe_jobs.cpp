// The jobs that planner tests and benchmarks run.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <numbers>
#include <random>

#include "gateway/motion/tests/trajectory_probe.hpp"

namespace kinebus::probe {
namespace {

double rounded(double x, double unit) {
  return std::round(x / unit) * unit;
}

struct PipeCloser {
  void operator()(std::FILE* file) const { pclose(file); }
};

}  // namespace

Lines dense_curve(int count, double size_mm, double feed_mm_per_s, double tilt_rad, double turn_rad) {
  const auto at = [&](double angle) {
    Pose p{};
    const double radius = size_mm * (1 + 0.25 * std::sin(3 * angle));
    p[kX] = radius * std::cos(angle);
    p[kY] = radius * std::sin(angle);
    p[kZ] = 20 + 2 * std::sin(2 * angle);
    p[kA] = tilt_rad * std::sin(angle);
    p[kC] = turn_rad * std::sin(0.5 * angle);
    return p;
  };
  double angle = 0, filament = 0;
  Job job(at(0));
  job.feed(feed_mm_per_s);
  for (int i = 0; i < count; ++i) {
    const Pose here = at(angle), ahead = at(angle + 1e-4);
    const double rate = std::hypot(ahead[0] - here[0], ahead[1] - here[1], ahead[2] - here[2]) / 1e-4;
    angle += 0.2 / rate;
    filament += 0.2 * 0.033;
    Pose p = at(angle);
    for (const auto axis : {kX, kY, kZ}) p[axis] = rounded(p[axis], 1e-3);
    for (const auto axis : {kA, kC}) p[axis] = rounded(p[axis], 1e-4 * std::numbers::pi / 180);
    p[kE] = rounded(filament, 1e-5);
    job.to(p);
  }
  return job.lines();
}

Lines random_print(std::uint64_t seed, int moves) {
  std::mt19937_64 random(seed);
  const auto pick = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Pose p{};
  p[kZ] = 0.2;
  Job job(p);
  const auto print_to = [&](double x, double y) {
    const double length = std::hypot(x - p[kX], y - p[kY]);
    p[kX] = rounded(x, 1e-3);
    p[kY] = rounded(y, 1e-3);
    p[kE] = rounded(p[kE] + 0.0389 * length, 1e-5);
    job.to(p);
  };
  while (static_cast<int>(job.lines().size()) < moves) {
    p[kE] -= 0.8;
    job.feed(40).to(p);
    p[kX] = rounded(pick(-70, 70), 1e-3);
    p[kY] = rounded(pick(-70, 70), 1e-3);
    if (pick(0, 1) < 0.05) p[kZ] += 0.2;
    job.feed(200).to(p);
    p[kE] += 0.8;
    job.feed(40).to(p);
    job.feed(pick(20, 120));
    const double kind = pick(0, 1);
    if (kind < 0.5) {  // an arc as a slicer writes it
      const double radius = pick(0.5, 25), step = pick(0.1, 1.5) / radius;
      const double cx = p[kX] - radius, cy = p[kY];
      for (double a = step; a < pick(1, 6); a += step)
        print_to(cx + radius * std::cos(a), cy + radius * std::sin(a));
    } else if (kind < 0.8) {  // infill
      double y = p[kY];
      const double width = pick(2, 40), x0 = p[kX];
      for (int i = 0; i < 12; ++i) {
        print_to(i % 2 == 0 ? x0 + width : x0, y);
        print_to(p[kX], y += 0.45);
      }
    } else {  // anything
      for (int i = 0; i < 20; ++i) print_to(p[kX] + pick(-3, 3), p[kY] + pick(-3, 3));
    }
  }
  return job.lines();
}

Lines random_five_axis(std::uint64_t seed, int moves, Frame frame) {
  std::mt19937_64 random(seed);
  const auto pick = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Pose p{0, 0, 40, 0, 0, 0};
  Job job(p, frame);
  while (static_cast<int>(job.lines().size()) < moves) {
    job.feed(std::exp(pick(std::log(2.0), std::log(400.0))));
    const double kind = pick(0, 1);
    const double size = std::exp(pick(std::log(0.02), std::log(30.0)));
    if (kind < 0.08) {
      p[kE] += pick(-1, 1);
      job.to(p);
      continue;
    }
    if (kind < 0.14) {
      p[kC] += pick(-1, 1);
      if (pick(0, 1) < 0.5) p[kA] = std::clamp(p[kA] + pick(-0.3, 0.3), -0.4, 0.4);
      job.feed(pick(0.1, 5)).to(p);
      continue;
    }
    if (kind < 0.24) {  // an arc about Z, or leaning, around a centre at some distance, with a rise
      const double radius = pick(0.3, 15), from = pick(0, 2 * std::numbers::pi), sweep = pick(0.05, 7);
      const std::array<double, 3> centre{p[kX] - radius * std::cos(from), p[kY] - radius * std::sin(from),
                                         p[kZ]};
      const double sign = pick(0, 1) < 0.5 ? 1 : -1;
      p[kX] = centre[0] + radius * std::cos(from + sign * sweep);
      p[kY] = centre[1] + radius * std::sin(from + sign * sweep);
      p[kZ] = std::clamp(p[kZ] + pick(-2, 2), 5.0, 80.0);
      p[kE] += 0.04 * sweep * radius;
      job.arc(p, centre, {0, 0, sign}, sweep);
    } else {
      const int count = kind < 0.5 ? 25 : 1;  // a run of lines that turn and tilt a little each, or one
      double heading = pick(0, 6.28), turn = pick(-0.2, 0.2), dc = pick(-0.05, 0.05), da = pick(-0.02, 0.02);
      if (count == 1 && pick(0, 1) < 0.5) dc = da = 0;
      for (int i = 0; i < count; ++i, heading += turn) {
        const double step = count == 1 ? size : std::min(size, 1.0);
        p[kX] += step * std::cos(heading);
        p[kY] += step * std::sin(heading);
        p[kZ] = std::clamp(p[kZ] + (count == 1 ? pick(-1, 1) : 0.02) * step, 5.0, 80.0);
        p[kC] += dc * step;
        p[kA] = std::clamp(p[kA] + da * step, -0.4, 0.4);
        p[kE] += 0.04 * step;
        if (count == 1 && pick(0, 1) < 0.2) {
          job.rapid(p);
        } else {
          job.to(p);
        }
      }
    }
    if (std::hypot(p[kX], p[kY]) > 60) {
      p[kX] = pick(-20, 20);
      p[kY] = pick(-20, 20);
      job.rapid(p);
    }
  }
  return job.lines();
}

Lines sliced_file(const std::string& path) {
  const bool packed = path.ends_with(".gz");
  const std::string command = (packed ? "zcat '" : "cat '") + path + "' 2>/dev/null";
  const std::unique_ptr<std::FILE, PipeCloser> file(popen(command.c_str(), "r"));
  Lines lines;
  if (!file) return lines;
  lines.push_back({0, canonical::SetPosition{{}, Frame::kPart}});
  Pose at{};
  double feed = 100, offset = 0;
  std::uint32_t number = 0;
  char text[512];
  while (std::fgets(text, sizeof text, file.get()) != nullptr) {
    ++number;
    const bool move = std::strncmp(text, "G1 ", 3) == 0 || std::strncmp(text, "G0 ", 3) == 0;
    const bool set = std::strncmp(text, "G92 ", 4) == 0;
    if (!move && !set) continue;
    Pose target = at;
    for (char* word = std::strchr(text, ' '); word != nullptr; word = std::strchr(word, ' ')) {
      ++word;
      if (*word == ';') break;
      const double value = std::strtod(word + 1, nullptr);
      if (*word == 'X') target[kX] = value;
      if (*word == 'Y') target[kY] = value;
      if (*word == 'Z') target[kZ] = value;
      if (*word == 'F') feed = value / 60;
      if (*word == 'E') {
        if (set) offset = at[kE] - value;
        target[kE] = value + offset;
      }
    }
    if (set || target == at) continue;
    at = target;
    lines.push_back({number, canonical::Feed{target, Frame::kPart, feed, 0}});
  }
  return lines;
}

}  // namespace kinebus::probe
