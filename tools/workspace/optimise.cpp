#include "tools/workspace/optimise.hpp"

#include <nlopt.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <random>
#include <thread>
#include <utility>
#include <vector>

namespace kinebus::workspace {
namespace {

// x of the rails, y of the right and of the left ones; the same of the attachments, and their height; leg
// length. mm.
constexpr std::size_t kUnknowns = 8;
using Unknowns = std::array<double, kUnknowns>;
constexpr Unknowns kLeast{60, 10, 10, 20, 5, 5, -80, 200}, kMost{1200, 1200, 1200, 800, 800, 800, -5, 4000};
/// What a search begins with, about.
constexpr Unknowns kStep{40, 40, 40, 15, 15, 15, 10, 60};

double sign_of(double v) {
  return v < 0 ? -1 : 1;
}

Unknowns unknowns_of(const M1Geometry& g) {
  Unknowns u{std::abs(g.legs[0].foot_mm[0]),       std::abs(g.legs[0].foot_mm[1]),
             std::abs(g.legs[2].foot_mm[1]),       std::abs(g.legs[0].attachment_mm[0]),
             std::abs(g.legs[0].attachment_mm[1]), std::abs(g.legs[2].attachment_mm[1]),
             g.legs[0].attachment_mm[2],           g.legs[0].length_mm};
  for (std::size_t k = 0; k < kUnknowns; ++k) u[k] = std::clamp(u[k], kLeast[k], kMost[k]);
  return u;
}

/// With these numbers, and connectors so that a level table in the middle has its carriages at one height.
M1Geometry with(const M1Geometry& start, const Unknowns& u) {
  M1Geometry g = start;
  std::array<double, 4> upright{};
  for (std::size_t i = 0; i < 4; ++i) {
    M1Leg& leg = g.legs[i];
    const double x = sign_of(leg.foot_mm[0]), y = sign_of(leg.foot_mm[1]);
    leg.foot_mm = {x * u[0], y * (i < 2 ? u[1] : u[2]), 0};
    leg.attachment_mm = {x * u[3], y * (i < 2 ? u[4] : u[5]), u[6]};
    leg.length_mm = u[7];
    leg.rail = {0, 0, 1};
    leg.carriage_above = false;
    const double aside =
        std::hypot(leg.foot_mm[0] - leg.attachment_mm[0], leg.foot_mm[1] - leg.attachment_mm[1]);
    upright[i] = std::sqrt(std::max(0.0, u[7] * u[7] - aside * aside));
  }
  const double most = *std::max_element(upright.begin(), upright.end());
  for (std::size_t i = 0; i < 4; ++i) g.legs[i].connector_mm = std::round(most - upright[i]);
  g.nozzle_mm = {0, 0, std::ceil(u[7])};
  return g;
}

/// What a search of one begin needs; each thread has its own.
struct Trial {
  const M1Geometry& start;
  const BodiesDescription& bodies;
  const Wish& wish;
  const std::vector<Pose>& poses;
  std::atomic<int>& tried;
  const std::function<void()>& tell;
};

/// Price, and dear where rules are broken: one pose a hundredth beyond a rule costs more than a better
/// machine saves.
double cost(const M1Geometry& g, const Judgement& judged) {
  constexpr double kBeyond = 5;
  // Bodies have not been looked at where legs do not reach.
  const double unseen = judged.of(LegRule::kReach).keeps() ? 0 : 1000;
  return judged.price(g) + kBeyond * judged.beyond + unseen;
}

double cost_of(unsigned count, const double* x, double*, void* trial) {
  const auto& t = *static_cast<const Trial*>(trial);
  ++t.tried;
  t.tell();
  Unknowns u{};
  std::copy_n(x, count, u.begin());
  const M1Geometry g = with(t.start, u);
  return cost(g, judge(g, t.bodies, t.wish, t.poses));
}

struct Found {
  Unknowns at{};
  double cost = std::numeric_limits<double>::infinity();
};

/// Subplex: simplices in a few unknowns at a time, which neither needs derivatives nor minds the kinks that
/// the worst pose makes.
Found search(Trial& trial, const Unknowns& from, int most_tries) {
  // The C interface: the one that libnlopt-dev brings.
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> subplex(
      nlopt_create(NLOPT_LN_SBPLX, kUnknowns), nlopt_destroy);
  nlopt_set_min_objective(subplex.get(), cost_of, &trial);
  nlopt_set_lower_bounds(subplex.get(), kLeast.data());
  nlopt_set_upper_bounds(subplex.get(), kMost.data());
  nlopt_set_initial_step(subplex.get(), kStep.data());
  nlopt_set_xtol_abs1(subplex.get(), 0.25);
  std::vector<double> x(from.begin(), from.end());
  Found found{from};
  // A search that has stalled on the ridge of two rules goes on when its steps begin anew.
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    const double before = found.cost;
    nlopt_set_maxeval(subplex.get(), most_tries / kRounds);
    double cost = before;
    // Where steps drown in rounding, x is the best found until then.
    const nlopt_result ended = nlopt_optimize(subplex.get(), x.data(), &cost);
    if (ended < 0 && ended != NLOPT_ROUNDOFF_LIMITED) break;
    if (cost < found.cost) {
      found.cost = cost;
      std::copy(x.begin(), x.end(), found.at.begin());
    }
    if (!(found.cost < 0.995 * before)) break;
  }
  return found;
}

constexpr int kPlaces = 1500;

/// Where searches begin: at the start, and at the best of many places.
std::vector<Unknowns> begins(Trial& trial, std::size_t count) {
  std::mt19937_64 random(1);
  const auto in = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  // Sizes go with what is wanted.
  const Room& room = trial.wish.room;
  const double radius = room.radius_mm;
  const std::vector<Pose> few = poses_of(room, {1, 2, 1, 8});
  std::vector<std::pair<double, Unknowns>> places;
  for (int n = 0; n < kPlaces; ++n) {
    const double length = in(4, 14) * radius;
    Unknowns u{in(1.5, 4.5) * radius, in(0.2, 4) * radius, in(0.2, 4) * radius, in(0.4, 2) * radius,
               in(0.2, 2) * radius,   in(0.2, 2) * radius, in(-40, -3),         length};
    for (std::size_t k = 0; k < kUnknowns; ++k) u[k] = std::clamp(u[k], kLeast[k], kMost[k]);
    const M1Geometry g = with(trial.start, u);
    ++trial.tried;
    trial.tell();
    places.emplace_back(cost(g, judge(g, std::nullopt, trial.wish, few)), u);
  }
  std::sort(places.begin(), places.end());
  std::vector<Unknowns> out{unknowns_of(trial.start)};
  for (std::size_t k = 0; out.size() < count && k < places.size(); ++k) out.push_back(places[k].second);
  return out;
}

/// Whole millimetres, which a drawing has.
Unknowns rounded(Unknowns u) {
  for (double& v : u) v = std::round(v);
  return u;
}

/// Homing goes away from the nozzle, to the lower end of the travel.
void fit_joints(MachineDescription& machine, const M1Geometry& g, const Judgement& judged) {
  for (std::size_t i = 0; i < g.legs.size(); ++i) {
    JointDescription& joint = machine.joints[i];
    joint.travel = g.legs[i].travel_mm;
    if (!joint.homing) continue;
    HomingDescription& h = *joint.homing;
    if (h.method == 18) h.method = 17;
    if (h.method == 19) h.method = 21;
    if (h.method == 20) h.method = 22;
    h.switch_position = joint.travel.min;
    h.max_search = std::max(h.max_search, std::ceil(1.2 * (joint.travel.max - joint.travel.min) / 10) * 10);
  }
  const double used = judged.travel_mm.max - judged.travel_mm.min;
  machine.homing.max_spread_mm = std::max(machine.homing.max_spread_mm, std::ceil(0.55 * used / 10) * 10);
}

}  // namespace

const M1Geometry* four_legs(const MachineDescription& machine) {
  return std::get_if<M1Geometry>(&machine.kinematics);
}

Optimised optimise(const MachineDescription& start, const Wish& wish, SearchEffort effort,
                   const std::function<void(double share)>& progress) {
  const M1Geometry& g0 = *four_legs(start);
  Optimised result;
  result.machine = start;
  BodiesDescription& bodies =
      result.machine.bodies ? *result.machine.bodies : result.machine.bodies.emplace();
  // A part as wide as the room stands on it.
  bodies.table_radius_mm = std::max(bodies.table_radius_mm, wish.room.radius_mm);
  const std::vector<Pose> dense = poses_of(wish.room, Density::fine());
  result.before = judge(g0, bodies, wish, dense);

  const int expected = kPlaces + effort.begins * effort.tries;
  std::atomic<int> tried{0};
  std::mutex telling;
  const std::function<void()> tell = [&] {
    if (!progress || tried % 50 != 0) return;
    const std::lock_guard lock(telling);
    progress(std::min(1.0, static_cast<double>(tried) / expected));
  };
  std::vector<Pose> poses = poses_of(wish.room, {});
  Trial trial{g0, bodies, wish, poses, tried, tell};
  const std::vector<Unknowns> from = begins(trial, static_cast<std::size_t>(effort.begins));
  std::vector<Found> found(from.size());
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> workers;
  for (int n = 0; n < std::max(1, effort.threads); ++n)
    workers.emplace_back([&] {
      for (std::size_t k = next++; k < from.size(); k = next++) {
        Trial own = trial;
        found[k] = search(own, from[k], effort.tries);
      }
    });
  for (std::thread& worker : workers) worker.join();
  Found best = *std::min_element(found.begin(), found.end(),
                                 [](const Found& a, const Found& b) { return a.cost < b.cost; });

  // What a dense look finds between the poses is looked at as well from then on.
  constexpr int kLooks = 4;
  for (int looked = 0;; ++looked) {
    M1Geometry g = with(g0, rounded(best.at));
    result.after = judge(g, bodies, wish, dense);
    if (result.after.holds() || looked == kLooks) {
      g = fitted(g, result.after, wish.room);
      result.after = judge(g, bodies, wish, dense);
      fit_joints(result.machine, g, result.after);
      result.machine.kinematics = g;
      break;
    }
    for (const Finding& f : result.after.findings)
      if (!f.keeps()) poses.push_back(f.pose);
    best = search(trial, best.at, effort.tries);
  }
  result.machine.geometry_calibration.reset();
  result.tried = tried;
  return result;
}

}  // namespace kinebus::workspace
