#include "tools/workspace/scan.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>
#include <numbers>
#include <optional>
#include <thread>
#include <tuple>
#include <utility>

#include "gateway/bodies/sweep.hpp"

namespace kinebus::workspace {

double Scan::angle_rad(int ray) const {
  return 2 * std::numbers::pi * ray / rays;
}

double Scan::tilt_rad(int tilt) const {
  if (tilts == 1) return room.tilt_min_rad;
  return room.tilt_min_rad + (room.tilt_max_rad - room.tilt_min_rad) * tilt / (tilts - 1);
}

int Scan::stride(int radius) const {
  int stride = 1;
  while (stride < 8 && 2 * stride * angle_rad(1) * (radius_mm(radius) + options.step_mm / 2) <=
                           options.ray_step_mm * (1 + 1e-9))
    stride *= 2;
  return stride;
}

double Scan::cell_volume_mm3(int radius) const {
  return 2 * std::numbers::pi / rays * radius_mm(radius) * options.step_mm * options.step_mm;
}

namespace {

constexpr int kConditionEvery = 4;

/// Bodies as one worker looks at them, and what it met.
class Watch {
 public:
  explicit Watch(const bodies::CollisionModel* model) {
    if (model != nullptr) sweep_.emplace(*model);
  }

  bool clear(const Pose& pose) {
    using Step = bodies::Sweep::Step;
    if (!sweep_) return true;
    Step step = sweep_->to(Frame::kPart, pose);
    // The scan is of poses, not of ways between them.
    if (step == Step::kCoarse) {
      sweep_->jump();
      step = sweep_->to(Frame::kPart, pose);
    }
    if (step != Step::kNear) return true;
    meet({.worst = sweep_->nearest(), .pose = pose, .poses = 1});
    return false;
  }

  void meet(const Meeting& met) {
    const auto same = std::find_if(met_.begin(), met_.end(), [&](const Meeting& m) {
      return m.worst.first == met.worst.first && m.worst.second == met.worst.second;
    });
    if (same == met_.end()) return met_.push_back(met);
    same->poses += met.poses;
    // Whichever worker was first: of places as bad, the one that comes first in space.
    if (std::pair(met.worst.mm, met.pose) < std::pair(same->worst.mm, same->pose)) {
      same->worst = met.worst;
      same->pose = met.pose;
    }
  }
  const std::vector<Meeting>& met() const { return met_; }

 private:
  std::optional<bodies::Sweep> sweep_;
  std::vector<Meeting> met_;
};

/// One plane: each worker writes cells of its own planes only, and counts for itself.
void scan_plane(const Kinematics& kinematics, Scan& s, int plane, std::array<std::uint64_t, 8>& refused,
                std::uint64_t& poses, Watch& watch) {
  std::vector<int> stride(static_cast<std::size_t>(s.radii));
  for (int radius = 0; radius < s.radii; ++radius)
    stride[static_cast<std::size_t>(radius)] = s.stride(radius);
  std::vector<std::uint64_t> allowed_at(static_cast<std::size_t>(s.radii));
  for (int ray = 0; ray < s.rays; ++ray) {
    const double c = std::cos(s.angle_rad(ray)), sn = std::sin(s.angle_rad(ray));
    std::fill(allowed_at.begin(), allowed_at.end(), 0);
    for (int tilt = 0; tilt < s.tilts; ++tilt)
      for (int i = 0; i < s.radii; ++i) {
        // To and fro along the ray: each pose is next to the one before, and bodies have hardly moved. A step
        // of the tilt moves the platform's rim by several of the ray's.
        const int radius = tilt % 2 == 0 ? i : s.radii - 1 - i;
        if (ray % stride[static_cast<std::size_t>(radius)] != 0) continue;
        const double r = s.radius_mm(radius);
        const Pose pose{r * c, r * sn, s.z_mm(plane), s.tilt_rad(tilt), 0, 0};
        ++poses;
        if (const auto ok = kinematics.check(Frame::kPart, pose); !ok)
          ++refused[static_cast<std::size_t>(ok.error().kind)];
        else if (watch.clear(pose))
          allowed_at[static_cast<std::size_t>(radius)] |= std::uint64_t{1} << tilt;
      }
    for (int radius = 0; radius < s.radii; ++radius) {
      const double r = s.radius_mm(radius);
      const std::size_t cell = s.cell(plane, ray, radius);
      if (const int shared = ray % stride[static_cast<std::size_t>(radius)]; shared != 0) {
        s.allowed[cell] = s.allowed[s.cell(plane, ray - shared, radius)];
        s.worst_condition[cell] = s.worst_condition[s.cell(plane, ray - shared, radius)];
        continue;
      }
      const std::uint64_t allowed = allowed_at[static_cast<std::size_t>(radius)];
      double worst = 0;
      // Conditioning is dear: at the middle and the outermost of the tilts that are allowed.
      const bool looked_at =
          plane % kConditionEvery == 0 && ray % kConditionEvery == 0 && radius % kConditionEvery == 0;
      if (allowed != 0 && looked_at) {
        int low = 0, high = s.tilts - 1;
        while ((allowed >> low & 1) == 0) ++low;
        while ((allowed >> high & 1) == 0) --high;
        for (const int tilt : {low, (low + high) / 2, high})
          worst = std::max(worst, kinematics.condition(
                                      Frame::kPart, {r * c, r * sn, s.z_mm(plane), s.tilt_rad(tilt), 0, 0}));
      }
      s.allowed[cell] = allowed;
      s.worst_condition[cell] = static_cast<float>(worst);
    }
  }
}

}  // namespace

Scan scan(const Kinematics& kinematics, const Room& room, const ScanOptions& options,
          const bodies::CollisionModel* model, const std::function<void(double share)>& progress) {
  const auto began = std::chrono::steady_clock::now();
  const std::clock_t cpu_began = std::clock();
  Scan s;
  s.room = room;
  s.options = options;
  s.planes = std::max(1, static_cast<int>(std::lround((room.z_max_mm - room.z_min_mm) / options.step_mm)));
  s.radii = std::max(1, static_cast<int>(std::lround(room.radius_mm / options.step_mm)));
  s.rays =
      std::max(12, static_cast<int>(std::ceil(2 * std::numbers::pi * room.radius_mm / options.ray_step_mm)));
  const double tilt_range = room.tilt_max_rad - room.tilt_min_rad;
  s.tilts = std::clamp(1 + static_cast<int>(std::ceil(tilt_range / options.tilt_step_rad - 1e-9)), 1, 64);
  const std::size_t cells = static_cast<std::size_t>(s.planes) * static_cast<std::size_t>(s.rays) *
                            static_cast<std::size_t>(s.radii);
  s.allowed.assign(cells, 0);
  s.worst_condition.assign(cells, 0);

  std::atomic<int> next{0};
  std::vector<std::array<std::uint64_t, 8>> refused(static_cast<std::size_t>(std::max(1, options.threads)));
  std::vector<std::uint64_t> poses(refused.size(), 0);
  std::vector<std::unique_ptr<Watch>> watches;
  for (std::size_t n = 0; n < refused.size(); ++n) watches.push_back(std::make_unique<Watch>(model));
  std::vector<std::thread> workers;
  for (std::size_t n = 0; n < refused.size(); ++n)
    workers.emplace_back([&, n] {
      for (int plane = next++; plane < s.planes; plane = next++) {
        scan_plane(kinematics, s, plane, refused[n], poses[n], *watches[n]);
        if (n == 0 && progress) progress(static_cast<double>(plane + 1) / s.planes);
      }
    });
  for (std::thread& worker : workers) worker.join();
  for (const std::uint64_t own : poses) s.poses += own;
  for (const auto& own : refused)
    for (std::size_t k = 0; k < own.size(); ++k) s.refused[k] += own[k];
  Watch all(nullptr);
  for (const auto& own : watches)
    for (const Meeting& met : own->met()) all.meet(met);
  s.meetings = all.met();
  std::sort(s.meetings.begin(), s.meetings.end(), [](const Meeting& a, const Meeting& b) {
    return std::tie(b.poses, a.worst.mm, a.pose) < std::tie(a.poses, b.worst.mm, b.pose);
  });
  s.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  s.cpu_seconds = static_cast<double>(std::clock() - cpu_began) / CLOCKS_PER_SEC;
  return s;
}

double volume_mm3(const Scan& s, int tilt) {
  double sum = 0;
  const std::uint64_t all = s.tilts == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << s.tilts) - 1;
  for (int plane = 0; plane < s.planes; ++plane)
    for (int ray = 0; ray < s.rays; ++ray)
      for (int radius = 0; radius < s.radii; ++radius) {
        const std::uint64_t allowed = s.allowed[s.cell(plane, ray, radius)];
        if (tilt < 0 ? allowed == all : (allowed >> tilt & 1) != 0) sum += s.cell_volume_mm3(radius);
      }
  return sum;
}

}  // namespace kinebus::workspace
