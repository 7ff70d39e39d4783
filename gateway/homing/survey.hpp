#pragma once
// Many homings: from random poses that the machine can be in, with a part on its table.

#include <array>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "gateway/homing/way.hpp"
#include "gateway/kinematics/geometry.hpp"

namespace kinebus::homing {

/// What of a machine its homing depends on.
struct Machine {
  const Kinematics* kinematics = nullptr;
  /// The same mechanism without the limits of its workspace, its joints' travel wider by what they overrun
  /// their switches: whatever it can stand at, one that was interrupted while homing included.
  const Kinematics* mechanism = nullptr;
  std::vector<Joint> joints;
  std::array<Interval, kMaxJoints> travel{};
  PoseLimits limits{};                                ///< none: the joints' travel alone
  double part_radius_mm = 100, part_height_mm = 200;  ///< the greatest part
  /// The bodies with such a part on the table; nullptr: nobody knows what is solid. `carrier`: the holder
  /// goes on upwards. No part is above a tool's holder, where what carries it is.
  std::function<bodies::Model(double part_radius_mm, double part_height_mm, bool carrier)> bodies;
};

/// Where a homing begins.
struct Start {
  JointVector joints{};
  Pose pose{};  ///< Frame::kMachine
  double part_radius_mm = 0, part_height_mm = 0;
  std::optional<std::size_t> on_switch;  ///< this joint stands on its switch already
  bodies::Model model;                   ///< bodies with that part
};

/// Starts, drawn from a seed: some of them in the workspace (corners of it more often than chance), some
/// between it and the switches, some with one joint on its switch; these as far as the machine can have come
/// there without touching. The part is as high as the tool leaves room for, or lower.
class Starts {
 public:
  Starts(const Machine& machine, std::uint64_t seed, int attempts = 200)
      : machine_(machine), random_(seed), attempts_(attempts) {}
  /// nullopt: found none in so many attempts, the machine can hardly stand anywhere.
  std::optional<Start> next();

  /// Where homings that are not safe are found first: all around, at the lowest and highest tilts, the tool
  /// on the workspace's rim and against the greatest part, which is as high as it can be. No chance is in
  /// them. nullopt: the machine cannot stand at this one.
  std::optional<Start> corner(std::size_t number);
  static std::size_t corner_count();

 private:
  double in(double low, double high);
  double in_or_end(const Interval& range);
  bool draw(Start& start);
  bool draw_in_workspace(Start& start);
  bool draw_towards_switches(Start& start, bool one_on_switch);
  bool put_part(Start& start);
  bool fits(Start& start, double radius_mm, double height_mm) const;

  const Machine& machine_;
  std::mt19937_64 random_;
  int attempts_;
};

struct Failure {
  Start start;
  Way way;
};

struct Survey {
  int starts = 0, corners = 0, on_switch = 0, under_tool = 0;  ///< under_tool: a part reaches up to the tool
  int touching = 0, not_closed = 0;
  std::optional<Failure> failure;  ///< the first one
  bodies::Clearance nearest{};
  Pose nearest_at{};
  double spread_mm = 0, worst_condition = 0;
  bool safe() const { return touching == 0 && not_closed == 0; }
};

/// `corners`: so many of the machine's are looked at before the random ones, and count.
Survey survey(const Machine& machine, const Plan& plan, std::uint64_t seed, int starts,
              Walker::Density density = {}, int attempts = 200, std::size_t corners = 0);

}  // namespace kinebus::homing
