#include "gateway/description/load_homing_rules.hpp"

#include <cmath>
#include <cstdio>
#include <span>
#include <utility>

#include "gateway/description/machine_homing.hpp"

namespace kinebus {
namespace {

/// Full steps a second. Slower, a motor's voltage is too low for its load to be seen in it.
constexpr double kSlowestSeen = 100, kSlowest = 200;
/// The driver's own clock, and room for the speed to be seen as one above.
constexpr double kShareOfFast = 0.9;
/// Of the way to full speed: the first half of what the joint goes off by is where no load is believed.
constexpr double kBackOffRamps = 2.5;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

class LoadRules {
 public:
  LoadRules(const JointDescription& joint, const HomingDescription& homing, std::string key,
            std::vector<BrokenRule>& broken)
      : j_(joint), h_(homing), key_(std::move(key)), broken_(broken) {}

  void judge() {
    if (!h_.by_load()) return none();
    threshold();
    speeds();
    way();
    require(!j_.motor, {key_ + "method", "joint." + j_.name + ".motor"},
            say("%1 on a node that drives the motor itself", static_cast<int>(h_.method)),
            say("a stepper driver that tells its load (TMC2209, TMC5160, TMC2130), and no [joint.%1.motor]; "
                "or a switch",
                j_.name));
  }

 private:
  void require(bool holds, std::vector<std::string> keys, Sentence found, Sentence expected) {
    if (!holds) broken_.push_back({std::move(keys), std::move(found), std::move(expected)});
  }
  std::string shown(double value) const { return number(j_.rotary ? value / kRadPerDeg : value); }
  std::string speed_key(const char* name) const {
    return key_ + name + (j_.rotary ? "_deg_per_s" : "_mm_per_s");
  }

  void none() {
    require(!h_.stall_threshold, {key_ + "stall_threshold", key_ + "method"},
            say("a load for a joint that does not home by it"),
            say("method = -3 or -4, or no stall_threshold"));
    require(h_.stall_above_per_s == 0, {speed_key("stall_above"), key_ + "method"},
            say("a load for a joint that does not home by it"), say("method = -3 or -4, or no stall_above"));
  }
  void threshold() {
    const std::uint32_t is = h_.stall_threshold.value_or(0);
    require(is >= 1 && is <= 255, {key_ + "stall_threshold"},
            h_.stall_threshold ? Sentence::verbatim(std::to_string(is)) : say("no stall_threshold"),
            say("1 to 255: the load at which the driver says stop, 255 the lightest"));
  }
  void speeds() {
    const double full_step = std::abs(j_.drive.travel_per_turn) / j_.drive.full_steps_per_turn;
    require(h_.fast_per_s >= kSlowest * full_step, {speed_key("fast")},
            Sentence::verbatim(shown(h_.fast_per_s)),
            say("at least %1, which is %2 full steps a second: slower, a driver does not see the load",
                shown(kSlowest * full_step), number(kSlowest)));
    require(h_.slow_per_s == h_.fast_per_s, {speed_key("slow"), speed_key("fast")},
            Sentence::verbatim(shown(h_.slow_per_s)),
            say("as much as the fast speed, %1: both approaches by load are fast", shown(h_.fast_per_s)));
    require(h_.stall_above_per_s >= kSlowestSeen * full_step &&
                h_.stall_above_per_s <= kShareOfFast * h_.fast_per_s,
            {speed_key("stall_above"), speed_key("fast")}, Sentence::verbatim(shown(h_.stall_above_per_s)),
            say("%1 to %2: from %3 full steps a second to nine tenths of the fast speed",
                shown(kSlowestSeen * full_step), shown(kShareOfFast * h_.fast_per_s), number(kSlowestSeen)));
  }
  void way() {
    const std::string u = j_.rotary ? "deg" : "mm";
    const double ramp = 0.5 * h_.fast_per_s * h_.fast_per_s / h_.accel_per_s2;
    require(h_.back_off >= kBackOffRamps * ramp,
            {key_ + "back_off_" + u, speed_key("fast"), key_ + "accel_" + u + "_per_s2"},
            Sentence::verbatim(shown(h_.back_off)),
            say("at least %1, 2.5 times the way to the fast speed: a load on the first half of it is no stop",
                shown(kBackOffRamps * ramp)));
  }

  const JointDescription& j_;
  const HomingDescription& h_;
  std::string key_;
  std::vector<BrokenRule>& broken_;
};

}  // namespace

void judge_load_keys(const JointDescription& joint, const HomingDescription& homing, const std::string& key,
                     std::vector<BrokenRule>& broken) {
  LoadRules(joint, homing, key, broken).judge();
}

void judge_load_homing(const MachineDescription& description, std::vector<BrokenRule>& broken) {
  const auto kinematics = make_kinematics(description);
  if (!kinematics) return;
  for (const homing::Joint& j : homing_joints(description)) {
    if (!(j.back_off > 0)) continue;
    const homing::Plan alone = homing::make_plan(**kinematics, std::span(&j, 1));
    if (alone.stages.empty() || alone.stages.front().effect != homing::Effect::kParts) continue;
    const JointDescription& joint = description.joints[j.joint];
    broken.push_back({{"joint." + joint.name + ".homing.method"},
                      say("%1, which first goes off the stop and brings tool and table together by that",
                          static_cast<int>(joint.homing->method)),
                      say("a switch (17..22) for a joint whose homing takes tool and table apart")});
  }
}

}  // namespace kinebus
