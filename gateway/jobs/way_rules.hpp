#pragma once
// Whether the machine can go a way: pose after pose within the kinematics' limits, no two bodies nearer than
// they may come, and all of them out of what has been printed. Between two poses bodies are looked at where
// they could have met.

#include <optional>

#include "gateway/bodies/printed_part.hpp"
#include "gateway/bodies/sweep.hpp"
#include "gateway/description/machine_description.hpp"
#include "gateway/kinematics/levelled.hpp"

namespace kinebus {

class WayRules {
 public:
  /// All must outlive this. A description without bodies has none to be checked. `printed`: what stands on
  /// the table; nullptr: nothing does.
  WayRules(const MachineDescription& machine, const Kinematics& kinematics,
           const bodies::PrintedPart* printed = nullptr)
      : kinematics_(kinematics),
        levelled_(dynamic_cast<const LevelledKinematics*>(&kinematics)),
        model_(make_collision_model(machine)),
        printed_(printed) {
    if (!model_) return;
    sweep_.emplace(*model_, bodies::Occasion::kMotion, printed_);
    if (printed_ != nullptr) watch_.emplace(*machine.bodies);
  }

  /// The next way does not begin where the last one ended.
  void jump() {
    if (sweep_) sweep_->jump();
    if (watch_) watch_->jump();
  }

  /// Why the machine cannot stand at `at(to)`, or not come there from `at(from)`, where it stands: at(s) is
  /// the pose at s of the way. nullopt: it can. Allocates only for words.
  template <typename PoseAt>
  std::optional<Sentence> broken(Frame frame, double from, double to, PoseAt&& at) {
    const Pose pose = at(to);
    const auto checked = kinematics_.check(frame, pose);
    met_print_ = false;
    outside_.reset();
    if (!checked) {
      jump();
      outside_ = checked.error();
      return to_string(checked.error());
    }
    return collision(frame, pose, from, to, at);
  }

  /// What the last answer was about: what has been printed.
  bool met_print() const { return met_print_; }

  /// What the last answer of broken() was about: the kinematics' limits, or nothing of them.
  const std::optional<PoseError>& outside() const { return outside_; }

  /// The same for bodies alone: poses outside the workspace are taken as well.
  template <typename PoseAt>
  std::optional<Sentence> collision(Frame frame, double from, double to, PoseAt&& at) {
    return collision(frame, at(to), from, to, at);
  }

 private:
  // Halved so often a way of 1 mm is in parts of 4 um: what can still meet in them is as good as touching at
  // an end.
  static constexpr int kHalvings = 8;

  /// Where bodies are: they know nothing of the bed's mesh.
  Pose over_even_bed(Frame frame, const Pose& pose) const {
    return levelled_ == nullptr ? pose : levelled_->over_even_bed(frame, pose);
  }

  /// `pose`: at(to).
  template <typename PoseAt>
  std::optional<Sentence> collision(Frame frame, const Pose& pose, double from, double to, PoseAt&& at) {
    met_print_ = false;
    if (!sweep_) return std::nullopt;
    if (auto words = collision(frame, pose, from, to, at, kHalvings)) return words;
    if (!watch_) return std::nullopt;
    const auto in_part = watch_->meets(*printed_, frame, pose);
    if (!in_part) return std::nullopt;
    met_print_ = true;
    return model_->words({0, {*in_part}, {bodies::BodyKind::kPart}});
  }

  /// The same of the bodies that the machine has.
  template <typename PoseAt>
  std::optional<Sentence> collision(Frame frame, const Pose& pose, double from, double to, PoseAt&& at,
                                    int halvings) {
    using Step = bodies::Sweep::Step;
    Step step = sweep_->to(frame, over_even_bed(frame, pose));
    if (step == Step::kCoarse && halvings > 0) {
      const double middle = 0.5 * (from + to);
      if (auto words = collision(frame, at(middle), from, middle, at, halvings - 1)) {
        jump();
        return words;
      }
      return collision(frame, pose, middle, to, at, halvings - 1);
    }
    if (step == Step::kCoarse) {
      jump();
      step = sweep_->to(frame, over_even_bed(frame, pose));
    }
    if (step != Step::kNear) return std::nullopt;
    met_print_ = sweep_->met_print();
    return model_->words(sweep_->nearest());
  }

  const Kinematics& kinematics_;
  const LevelledKinematics* levelled_;  ///< nullptr: nothing levels the bed
  bodies::Model model_;
  std::optional<bodies::Sweep> sweep_;
  const bodies::PrintedPart* printed_;
  std::optional<bodies::PrintWatch> watch_;
  bool met_print_ = false;
  std::optional<PoseError> outside_;
};

}  // namespace kinebus
