#pragma once
// Bodies along a path, pose after pose. A pair that was far apart is not measured again until both bodies
// have moved so far that they could have met: most poses cost little more than the bodies' places.

#include <array>
#include <optional>

#include "gateway/bodies/collision_model.hpp"

namespace kinebus::bodies {

class Sweep {
 public:
  enum class Step : std::uint8_t {
    kClear,   ///< every pair keeps the clearance here, and none has touched since the last pose
    kNear,    ///< nearest() does not keep it
    kCoarse,  ///< too far from the last pose to know: a pose between both is needed. As if not asked for.
    kOutOfReach,
  };

  /// `model` must outlive this.
  explicit Sweep(const CollisionModel& model, Occasion occasion = Occasion::kMotion);

  /// The machine moves to `pose`, near enough to straight on. Allocates nothing.
  Step to(Frame frame, const Pose& pose);
  /// The next pose follows from none.
  void jump() { placed_ = false; }
  const Clearance& nearest() const { return nearest_; }
  const CollisionModel& model() const { return model_; }

 private:
  void measure_motion();
  float motion_of(const CollisionModel::Pair& pair) const {
    return motion_[pair.first] + motion_[pair.second];
  }

  static constexpr std::size_t kMostPairs = kMostBodies * (kMostBodies - 1) / 2;
  const CollisionModel& model_;
  Occasion occasion_;
  std::array<Scene, 2> scenes_;
  std::size_t now_ = 0;  ///< which of both
  bool placed_ = false;
  std::array<float, kMostBodies> motion_{};  ///< mm since the last pose, at most
  std::vector<CollisionModel::Pair> pairs_;
  std::vector<float> spare_, next_;  ///< of each pair: distance at the last pose, or less
  Clearance nearest_{};
};

}  // namespace kinebus::bodies
