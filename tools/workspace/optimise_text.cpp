#include "tools/workspace/optimise_text.hpp"

#include <cmath>

namespace kinebus::workspace {
namespace {

constexpr double kBinds = 0.03;

const char* name_of(LegRule rule) {
  switch (rule) {
    case LegRule::kReach:
      return "legs reach";
    case LegRule::kLegAngle:
      return "leg against rail";
    case LegRule::kCondition:
      return "condition number";
    case LegRule::kUnderPlatform:
      return "leg under platform";
    case LegRule::kLegsApart:
      return "leg from leg";
    case LegRule::kBodies:
      return "other bodies";
  }
  return "";
}

std::string value_of(LegRule rule, double value) {
  switch (rule) {
    case LegRule::kReach:
      return value > 0 ? "yes" : "no";
    case LegRule::kLegAngle:
    case LegRule::kUnderPlatform:
      return printed("%.1f deg", value / kRadPerDeg);
    case LegRule::kCondition:
      return printed("%.2f", value);
    case LegRule::kLegsApart:
    case LegRule::kBodies:
      return value > 0 ? printed("%.1f mm", value) : "touch";
  }
  return {};
}

std::string limit_of(const Finding& f) {
  if (f.rule == LegRule::kReach) return "";
  return (f.at_most() ? "<= " : ">= ") + value_of(f.rule, f.limit);
}

std::string place_of(const Pose& pose) {
  // Without "-0".
  const auto whole = [](double v) { return std::round(v) + 0.0; };
  return printed("X %.0f Y %.0f Z %.0f A %.1f", whole(pose[kX]), whole(pose[kY]), whole(pose[kZ]),
                 pose[kA] / kRadPerDeg);
}

bool of_bodies(LegRule rule) {
  return rule == LegRule::kLegsApart || rule == LegRule::kBodies;
}

std::string pair_of(const Finding& f, const bodies::CollisionModel& model) {
  if (!of_bodies(f.rule)) return {};
  return std::string(model.name(f.first).c_str()) + " and " + model.name(f.second).c_str();
}

bool looked_at(const Finding& f) {
  return std::isfinite(f.worst);
}

}  // namespace

std::string rules_text(const Judgement& judged, const bodies::CollisionModel& model) {
  std::string text;
  for (const Finding& f : judged.findings) {
    if (!looked_at(f)) {
      text += printed("  %-18s not looked at: legs do not reach\n", name_of(f.rule));
      continue;
    }
    const char* word = !f.keeps() ? "BROKEN" : f.rule != LegRule::kReach && f.spare() < kBinds ? "binds" : "";
    text += printed("  %-18s %9s  %-12s %-7s at %s", name_of(f.rule), value_of(f.rule, f.worst).c_str(),
                    limit_of(f).c_str(), word, place_of(f.pose).c_str());
    if (of_bodies(f.rule)) text += ": " + pair_of(f, model);
    text += "\n";
  }
  text +=
      printed("  carriages use %.0f .. %.0f mm, rails stand on a circle of %.0f mm, legs are %.0f mm long\n",
              judged.travel_mm.min, judged.travel_mm.max, judged.footprint_mm, judged.leg_mm);
  return text;
}

std::string broken_text(const Judgement& judged, const bodies::CollisionModel& model) {
  std::string text;
  for (const Finding& f : judged.findings) {
    if (!looked_at(f) || f.keeps()) continue;
    text += text.empty() ? "" : "; ";
    text += f.rule == LegRule::kReach
                ? printed("legs do not reach %s", place_of(f.pose).c_str())
                : printed("%s %s where it must be %s, at %s", name_of(f.rule),
                          value_of(f.rule, f.worst).c_str(), limit_of(f).c_str(), place_of(f.pose).c_str());
    if (of_bodies(f.rule)) text += " (" + pair_of(f, model) + ")";
  }
  return text;
}

std::string legs_text(const M1Geometry& geometry) {
  std::string text = printed("nozzle at %g mm\n", geometry.nozzle_mm[2]);
  for (std::size_t i = 0; i < geometry.legs.size(); ++i) {
    const M1Leg& leg = geometry.legs[i];
    const Vector3& at = leg.attachment_mm;
    text += printed("leg %zu: rail at %g, %g; attachment %g, %g, %g; ", i + 1, leg.foot_mm[0], leg.foot_mm[1],
                    at[0], at[1], at[2]);
    text += printed("length %g; connector %g; travel %g .. %g\n", leg.length_mm, leg.connector_mm,
                    leg.travel_mm.min, leg.travel_mm.max);
  }
  return text;
}

}  // namespace kinebus::workspace
