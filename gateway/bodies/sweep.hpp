#pragma once
// Bodies along a path, pose after pose. A pair that was far apart is not measured again until both bodies
// have moved so far that they could have met; near a pose at which all pairs were clear nothing is looked at
// but how near it is, nor where the path comes back to one.

#include <array>
#include <cstdint>
#include <optional>

#include "gateway/bodies/clear_places.hpp"
#include "gateway/bodies/collision_model.hpp"
#include "gateway/bodies/part_body.hpp"

namespace kinebus::bodies {

class Sweep {
 public:
  enum class Step : std::uint8_t {
    kClear,   ///< every pair keeps the clearance here, and none has touched since the last pose
    kNear,    ///< nearest() does not keep it
    kCoarse,  ///< too far from the last pose to know: a pose between both is needed. As if not asked for.
    kOutOfReach,
  };

  /// `model` must outlive this, as must `printed`, which stands on the table and may grow at the tool's tip;
  /// nullptr: nothing does.
  explicit Sweep(const CollisionModel& model, Occasion occasion = Occasion::kMotion,
                 const PrintedPart* printed = nullptr);

  /// The machine moves to `pose`, near enough to straight on. Allocates nothing.
  Step to(Frame frame, const Pose& pose);
  /// The next pose follows from none.
  void jump();
  const Clearance& nearest() const { return nearest_; }
  /// That is about what has been printed.
  bool met_print() const { return met_print_; }
  const CollisionModel& model() const { return model_; }
  /// At how many poses pairs have been looked at.
  std::uint64_t measured() const { return measured_; }

 private:
  using Place = CollisionModel::Place;
  struct Stand {
    Frame frame{};
    Pose pose{};
    Place place{};
  };
  Step measure(Frame frame, const Pose& pose, const std::optional<Place>& place, bool way_is_clear);
  bool with_print(std::size_t pair) const { return pair >= own_pairs_; }
  void follow_print();
  double look(const Scene& scene, const Pose& pose, std::size_t pair);
  void measure_motion();
  float motion_over(std::size_t pair, float matters_mm) const;
  void carry_on();
  double turns_of(std::size_t pair) const;
  void settle(const Place& place);
  void unsettle();
  void find_room(const Place& place);

  const CollisionModel& model_;
  Occasion occasion_;
  std::array<Scene, 2> scenes_;
  std::size_t now_ = 0;  ///< which of both
  bool placed_ = false;
  std::array<float, kMostBodies> motion_{};                ///< mm since the last pose, at most
  std::array<std::array<Vec, 2>, kMostBodies> displaced_;  ///< of each witness since then
  float turned_rad_ = 0;
  std::vector<CollisionModel::Pair> pairs_;  ///< the model's, then those of what is printed
  std::size_t own_pairs_ = 0;                ///< how many the former are
  std::optional<PartBody> print_;
  std::vector<float> spare_, next_;  ///< of each pair: distance at the last pose measured, or less
  std::vector<Parting> parting_;     ///< of each pair, when its distance was last measured
  /// While the machine works around a place, pairs that cannot meet anywhere around it are left alone: what
  /// they have to spare is what they had there.
  struct Around {
    Place middle{};
    double gain = 1;
  };
  std::optional<Around> around_;
  std::vector<std::size_t> active_;  ///< the other pairs; all of them when there is no such place
  Place at_{};                       ///< of the last pose measured
  ClearPlaces::Room room_;           ///< in which the last pose is
  ClearPlaces known_;
  std::optional<Stand> unmeasured_;  ///< the last pose, if it was clear for that reason
  bool has_places_;
  float enough_mm_;  ///< to spare: a pair that has it is not measured
  Clearance nearest_{};
  bool met_print_ = false;
  std::uint64_t measured_ = 0;
};

}  // namespace kinebus::bodies
