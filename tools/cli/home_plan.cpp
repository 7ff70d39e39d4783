#include "tools/cli/home_plan.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "gateway/description/bodies_rules.hpp"
#include "gateway/description/machine_homing.hpp"
#include "tools/cli/offline.hpp"

namespace kinebus {
namespace {

using nlohmann::json;

std::string why(const homing::Stage& stage) {
  switch (stage.effect) {
    case homing::Effect::kParts:
      return fmt::format("the tool leaves the table at {:.1f} mm/s", stage.parting_mm_per_s);
    case homing::Effect::kKeeps:
      return "the tool keeps its distance from the table";
    case homing::Effect::kNears:
      return fmt::format("the tool comes nearer to the table at {:.1f} mm/s", -stage.parting_mm_per_s);
  }
  return {};
}

std::string joint_words(const MachineDescription& machine, const homing::Joint& j) {
  const JointDescription& joint = machine.joints[j.joint];
  if (!j.moves) return joint.name + " (where it is)";
  const double unit = joint.rotary ? kRadPerDeg : 1;
  return fmt::format("{} {} {:.6g} {}/s", joint.name, j.positive ? "+" : "-", j.fast_per_s / unit,
                     joint.rotary ? "deg" : "mm");
}

std::string lift_words(const MachineDescription& machine, const homing::Stage& stage) {
  std::string words;
  for (std::size_t i = 0; i < stage.lift_per_s.size(); ++i) {
    homing::Joint joint = stage.joints[i];
    joint.fast_per_s = stage.lift_per_s[i];
    if (joint.fast_per_s > 0) words += (words.empty() ? "" : ", ") + joint_words(machine, joint);
  }
  return words;
}

json to_json(const MachineDescription& machine, const homing::Plan& plan) {
  json stages = json::array();
  for (const homing::Stage& stage : plan.stages) {
    json joints = json::array();
    for (const homing::Joint& j : stage.joints) {
      const double unit = machine.joints[j.joint].rotary ? kRadPerDeg : 1;
      joints.push_back({{"joint", machine.joints[j.joint].name},
                        {"direction", !j.moves     ? 0
                                      : j.positive ? 1
                                                   : -1},
                        {"fast_per_s", j.fast_per_s / unit},
                        {"switch_position", j.switch_position / unit}});
    }
    json lift = json::array();
    for (std::size_t i = 0; i < stage.lift_per_s.size(); ++i) {
      const JointDescription& joint = machine.joints[stage.joints[i].joint];
      lift.push_back(
          {{"joint", joint.name}, {"per_s", stage.lift_per_s[i] / (joint.rotary ? kRadPerDeg : 1)}});
    }
    stages.push_back({{"joints", joints},
                      {"lift", lift},
                      {"parting_mm_per_s", stage.parting_mm_per_s},
                      {"reason", why(stage)}});
  }
  return {{"machine", machine.name}, {"order_is_stated", plan.stated}, {"stages", stages}};
}

void print_plan(const MachineDescription& machine, const homing::Plan& plan) {
  fmt::print("homing of {}: order {}\n", machine.name,
             plan.stated ? "as its file states it" : "from its kinematics");
  int number = 0;
  for (const homing::Stage& stage : plan.stages) {
    std::string joints;
    for (const homing::Joint& j : stage.joints)
      joints += (joints.empty() ? "" : ", ") + joint_words(machine, j);
    fmt::print("  {}. {}\n     {}\n", ++number, joints, why(stage));
    if (!stage.lift_per_s.empty())
      fmt::print("     first straight up, until one has come to its switch: {}\n",
                 lift_words(machine, stage));
  }
  std::string others;
  for (const JointDescription& joint : machine.joints)
    if (!joint.homing) others += (others.empty() ? "" : ", ") + joint.name;
  if (!others.empty()) fmt::print("  not homed, zero where they stand at power-up: {}\n", others);
}

/// The tallest part that this homing leaves alone, a tenth lower at a time.
class Search {
 public:
  Search(HomingStudy& study, const HomePlanArguments& arguments) : study_(study), arguments_(arguments) {}

  /// `fixed`: only the part that is stated counts.
  homing::Survey run(bool fixed, json& tried) {
    constexpr int kAttempts = 200;
    for (;;) {
      homing::Survey found = homing::survey(study_.machine(), study_.plan(), arguments_.seed,
                                            arguments_.starts, {}, kAttempts, homing::Starts::corner_count());
      tell(found, tried);
      const double height = study_.machine().part_height_mm;
      if (found.safe() || fixed || !touches_part(found) || height < 10) return found;
      study_.set_part(study_.machine().part_radius_mm, 0.9 * height);
    }
  }

 private:
  static bool touches_part(const homing::Survey& found) {
    const bodies::Clearance& c = found.failure->way.nearest;
    return found.failure->way.end == homing::Way::End::kTouches &&
           (c.first.kind == bodies::BodyKind::kPart || c.second.kind == bodies::BodyKind::kPart);
  }

  void tell(const homing::Survey& found, json& tried) const {
    const homing::Machine& m = study_.machine();
    json row = {{"starts", found.starts},
                {"corners", found.corners},
                {"one_on_its_switch", found.on_switch},
                {"part_under_tool", found.under_tool},
                {"contacts", found.touching},
                {"not_closed", found.not_closed},
                {"largest_travel_difference_mm", found.spread_mm},
                {"worst_condition", found.worst_condition}};
    if (m.bodies) {
      row["part_radius_mm"] = m.part_radius_mm;
      row["part_height_mm"] = m.part_height_mm;
      fmt::print("from {} poses (seed {}), parts up to {:.6g} mm high on {:.6g} mm radius:\n", found.starts,
                 arguments_.seed, m.part_height_mm, m.part_radius_mm);
      fmt::print("  a joint stands on its switch in {}, the part right under the tool in {}\n  {} contacts\n",
                 found.on_switch, found.under_tool, found.touching);
    } else {
      fmt::print("from {} poses (seed {}); the file has no [bodies], so nobody knows what is solid:\n",
                 found.starts, arguments_.seed);
    }
    fmt::print("  {} times the mechanism could not follow; worst condition {:.1f}\n", found.not_closed,
               found.worst_condition);
    if (m.bodies && found.starts > 0) {
      const bodies::Model model = m.bodies(m.part_radius_mm, m.part_height_mm, false);
      const std::string pair = model->name(found.nearest.first) + " and " + model->name(found.nearest.second);
      fmt::print("  smallest clearance {:.2f} mm: {} at {}\n", found.nearest.mm, pair,
                 pose_text(found.nearest_at));
      row["smallest_clearance_mm"] = found.nearest.mm;
      row["nearest"] = {model->name(found.nearest.first).c_str(), model->name(found.nearest.second).c_str()};
      row["nearest_at"] = pose_text(found.nearest_at);
    }
    if (found.failure) {
      const auto& [start, way] = *found.failure;
      std::string words = way.end == homing::Way::End::kTouches ? start.model->words(way.nearest).c_str()
                                                                : "the mechanism cannot follow";
      words = fmt::format("begun at {}, at {} {}", pose_text(start.pose), pose_text(way.at), words);
      fmt::print("  first: {}\n", words);
      row["first"] = words;
    }
    tried.push_back(row);
  }

  HomingStudy& study_;
  const HomePlanArguments& arguments_;
};

}  // namespace

int plan_homing(const MachineDescription& machine, const HomePlanArguments& arguments) {
  HomingStudy study(machine);
  const bool stated = machine.bodies && machine.bodies->part_height_mm > 0;
  const bool asked = arguments.part_height_mm > 0;
  if (asked) study.set_part(arguments.part_radius_mm, arguments.part_height_mm);
  print_plan(machine, study.plan());
  json report = to_json(machine, study.plan());
  json tried = json::array();
  const double highest = study.machine().part_height_mm;
  const homing::Survey found = Search(study, arguments).run(stated || asked, tried);
  report["surveys"] = tried;
  if (const double spared = study.machine().part_height_mm; study.machine().bodies && found.safe()) {
    report["spared_part_height_mm"] = spared;
    if (spared < highest)
      fmt::print(
          "  a part higher than {:.6g} mm may be touched: it must be off the table before the machine homes "
          "with "
          "its positions unknown, or the switches must be farther from the work\n",
          spared);
  }
  fmt::print("  largest difference of travels {:.1f} mm (homing.max_spread_mm {:.6g})\n", found.spread_mm,
             machine.homing.max_spread_mm);
  report["max_spread_mm"] = machine.homing.max_spread_mm;
  if (!arguments.json_path.empty()) write_text(arguments.json_path, report.dump(2) + "\n");
  return found.safe() ? 0 : 1;
}

}  // namespace kinebus
