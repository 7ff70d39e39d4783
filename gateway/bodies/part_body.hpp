#pragma once
// The printed part as the machine's other bodies meet it: legs, carriages, rails, a platform that carries the
// tool, fixed bodies, the floor. What does not come near to a cylinder around it (on a bed that neither tilts
// nor turns: a box) costs no more than that comparison; what does is looked for cell by cell.
//
// Bodies keep the clearance from it as from each other, less what a cell is coarse: what keeps the clearance,
// and at least 1.4 mm, is never refused; what comes 1.8 mm nearer than that, or 0.4 mm deep into it, always
// is.

#include <cstddef>
#include <cstdint>
#include <optional>

#include "gateway/bodies/collision_model.hpp"
#include "gateway/bodies/printed_part.hpp"

namespace kinebus::bodies {

class PartBody {
 public:
  /// Both must outlive this.
  PartBody(const CollisionModel& model, const PrintedPart& part);

  /// Where it stands.
  std::size_t table() const { return table_; }
  /// It can come nearer to that body, or that body to it; tool and holder are PrintWatch's.
  bool meets(std::size_t body) const;

  /// How far it may reach beyond what it was when this was asked last, mm. 0: as it was.
  double grow();
  /// No point of it is farther from the table's witnesses; 0: the table stands.
  double lever_mm() const { return lever_mm_; }

  /// Distance of a body at a pose in the clearance's terms, or somewhat less: below wanted_mm() it comes too
  /// near. `last`: of this body, from the last call. Allocates nothing.
  double distance(const Scene& scene, const Pose& pose, std::size_t body, Parting& last) const;
  /// By what its distances to other bodies may be less than said: a part of the clearance.
  double coarse_mm() const { return model_.wanted_mm() - near_mm_; }

 private:
  /// Where the table is.
  struct Ground {
    Vec zero{}, y{0, 1, 0}, z{0, 0, 1};
    double c_rad = 0;
  };
  Ground ground(const Scene& scene, const Pose& pose) const;
  Shape around(const Scene& scene) const;
  bool cells_near(const Scene& scene, const Ground& ground, std::size_t body, double near_mm) const;

  const CollisionModel& model_;
  const PrintedPart& part_;
  std::size_t table_ = 0;
  double near_mm_;  ///< a cell's middle that is nearer is too near
  double lever_mm_ = 0;
  std::uint64_t extents_ = 0;                  ///< of the part, when extent_ was read
  std::optional<PrintedPart::Extent> extent_;  ///< nullopt: nothing is printed
};

}  // namespace kinebus::bodies
