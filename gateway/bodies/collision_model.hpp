#pragma once
// Where a machine's bodies are at a pose, and how near two of them come.
//
// A machine is a list of bodies; each is one or more convex solids. Two bodies that are joined (a leg and its
// carriage), or that cannot move against each other, are no pair. Tool and table are none either: to touch is
// their work, and the workspace's least Z is their limit.

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/bodies/bodies_description.hpp"
#include "gateway/bodies/shape.hpp"
#include "gateway/kinematics/kinematics.hpp"

namespace kinebus::bodies {

enum class BodyKind : std::uint8_t {
  kLeg,
  kCarriage,
  kRail,
  kPlatform,
  kBeam,
  kTable,
  kPart,
  kTool,
  kHolder,
  kFloor,
  kFixed
};
struct BodyId {
  BodyKind kind = BodyKind::kFloor;
  std::uint8_t number = 0;  ///< from 1, of legs, carriages, rails and fixed bodies
  friend bool operator==(const BodyId&, const BodyId&) = default;
};

struct Clearance {
  double mm = 0;  ///< 0 or less: they touch
  BodyId first{}, second{};
};

/// What may stand on the table.
enum class Occasion : std::uint8_t {
  kMotion,  ///< the tool is at work on the part: only the rest of the machine must keep away from it
  kHoming,  ///< nobody knows where the part is: tool and holder must keep away from it, too
};

inline constexpr std::size_t kMostBodies = 48, kMostShapes = 64, kMostFixed = 16;

/// All bodies at one pose, machine frame. A copy of CollisionModel::at_rest(), placed.
struct Scene {
  std::array<Shape, kMostShapes> shapes;
  /// Two points of each body, and an angle of all that tilts: a body has moved by less than what the farther
  /// of its points has, and the angle's change times the body's lever.
  std::array<std::array<Vec, 2>, kMostBodies> witness;
  double tilt_rad = 0;
};

class CollisionModel {
 public:
  virtual ~CollisionModel() = default;
  CollisionModel(const CollisionModel&) = delete;
  CollisionModel& operator=(const CollisionModel&) = delete;

  /// Puts the bodies where they are at `pose`. False: out of reach. `scene` was a copy of at_rest().
  /// Allocates nothing.
  virtual bool place(Frame frame, const Pose& pose, Scene& scene) const = 0;
  const Scene& at_rest() const { return rest_; }

  /// A pose as a place at which distances bound the bodies' motion: on the way from one place to another no
  /// body moves against another by more than gain() times apart_mm() of the two.
  struct Place {
    Vec point{};          ///< of what carries all that moves
    double turn_mm = 0;   ///< its tilt, times twice the longest lever
    double lever_mm = 0;  ///< that one
  };
  static double apart_mm(const Place& a, const Place& b) {
    return norm(a.point - b.point) + std::abs(a.turn_mm - b.turn_mm);
  }
  /// nullopt: this kind of machine has no such bound.
  virtual std::optional<Place> place_of(Frame, const Pose&) const { return std::nullopt; }
  /// Holds for all places less than `radius_mm` from `place`; infinite where not all of them are in reach.
  virtual double gain(const Place&, double /*radius_mm*/) const {
    return std::numeric_limits<double>::infinity();
  }

  /// Smallest clearance of all pairs at a pose; nullopt: out of reach. Without heap.
  std::optional<Clearance> clearance(Frame frame, const Pose& pose,
                                     Occasion occasion = Occasion::kMotion) const;
  /// Of the pose before, which says nothing wrong of any other: the index in pairs() of the nearest pair,
  /// which is looked at first and mostly is it again, and for each pair a plane that parted both and how far
  /// they were apart at least, less what both have moved since: one of these mostly still says that they are
  /// farther. Empty: nothing is known yet. It belongs to one model.
  struct Memory {
    std::size_t likely = 0;
    std::vector<Vec> planes{};
    std::vector<double> apart_mm{};
    std::vector<std::array<Vec, 2>> witness{};  ///< of the bodies, at that pose
    double tilt_rad = 0;
  };
  /// The same for bodies that are placed already.
  Clearance clearance(const Scene& scene, Occasion occasion = Occasion::kMotion,
                      Memory* before = nullptr) const;

  /// "leg 2", "spindle", or the name of a fixed body's table.
  Sentence name(BodyId body) const;
  /// "leg 2 and table touch", "leg 2 and leg 3 come as near as 1.2 mm, bodies keep 2 mm"
  Sentence words(const Clearance& clearance) const;
  /// That two bodies must keep.
  double wanted_mm() const { return wanted_mm_; }

  static constexpr std::uint8_t kStill = 0;
  struct Body {
    BodyId id;
    std::uint8_t first_shape = 0, shapes = 0;
    std::uint8_t group = 0;  ///< those of one group do not move against each other; kStill: those that stand
    double lever_mm = 0;
    Vec line{};  ///< of length 1: it moves along this alone, and does not turn; 0: it moves otherwise
    bool moves() const { return group != kStill; }
  };
  struct Pair {
    std::uint8_t first = 0, second = 0;
    bool homing_only = false;
  };
  const std::vector<Body>& bodies() const { return bodies_; }
  const std::vector<Pair>& pairs() const { return pairs_; }
  double distance(const Scene& scene, const Pair& pair) const { return part(scene, pair).mm; }
  /// Both move along parallel lines, or one does and the other stands, and they keep wanted_mm() wherever
  /// they are on these. Not for each pose.
  bool always_parted(const Pair& pair) const;
  /// They keep wanted_mm() at every pose of the workspace.
  bool parted_at_work(const Pair& pair) const;
  /// With the axis of the two solids that are nearest. At least `enough_mm` apart: measured no further.
  Parting part(const Scene& scene, const Pair& pair,
               double enough_mm = std::numeric_limits<double>::infinity()) const;
  /// Not more than distance(): what is left between both along `axis`, which has length 1.
  double gap_along(const Scene& scene, const Pair& pair, const Vec& axis) const;
  /// Not more than distance(), and cheap.
  double least_distance(const Scene& scene, const Pair& pair) const;

 protected:
  /// `mill`: its tool is a tool in a spindle, not a nozzle.
  CollisionModel(const BodiesDescription& bodies, bool mill) : wanted_mm_(bodies.clearance_mm), mill_(mill) {}

  /// Returns its index. `lever_mm`: no point of the core is farther from the witnesses.
  std::size_t add(BodyId id, std::uint8_t group, std::span<const Shape> shapes, double lever_mm = 0);
  std::size_t add(BodyId id, std::uint8_t group, const Shape& shape, double lever_mm = 0) {
    return add(id, group, std::span(&shape, 1), lever_mm);
  }
  void add_fixed(const BodiesDescription& bodies);
  /// A plate below everything.
  void add_floor(double z_mm);
  /// The box `body` moves along `line`, of length 1 and along one of its edges, and is at `centre` once.
  void ride(std::size_t body, const Vec& centre, const Vec& line);
  /// They are no pair.
  void join(std::size_t first, std::size_t second) { joined_.push_back({first, second}); }
  /// That much is left between them wherever in the workspace the tool is.
  void part_at_work(std::size_t first, std::size_t second, double least_mm) {
    if (least_mm >= wanted_mm_ + kRounding_mm) parted_at_work_.push_back({first, second});
  }
  /// When all bodies are there.
  void pair_up();
  std::size_t shape_of(std::size_t body) const { return bodies_[body].first_shape; }

 private:
  static constexpr double kRounding_mm = 0.01;
  using Two = std::array<std::size_t, 2>;
  static bool among(const std::vector<Two>& list, std::size_t a, std::size_t b);
  /// Takes from what pairs were apart what their bodies have moved.
  void carry_on(Memory& memory, const Scene& scene) const;

  Scene rest_{};
  std::size_t shapes_ = 0;
  std::vector<Body> bodies_;
  std::vector<Pair> pairs_;
  std::vector<Two> joined_, parted_at_work_;
  std::vector<std::string> fixed_names_;
  double wanted_mm_;
  bool mill_;
};

using Model = std::unique_ptr<const CollisionModel>;
/// `geometry` must be one that its kinematics accept. At most kMostFixed fixed bodies.
Model make_model(const M1Geometry& geometry, const BodiesDescription& bodies);
Model make_model(const M5Geometry& geometry, const BodiesDescription& bodies);
Model make_model(const M4Geometry& geometry, const BodiesDescription& bodies);
Model make_model(const LinearDeltaGeometry& geometry, const BodiesDescription& bodies);
/// Seen from the table's foot: the tool moves. (Which of its axes move the table does not matter to the two.)
Model make_model(const CartesianGeometry& geometry, const BodiesDescription& bodies);
Model make_model(const CoreXyGeometry& geometry, const BodiesDescription& bodies);

}  // namespace kinebus::bodies
